// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/house/plan_file.hpp"
#include "scenes/scene.hpp"

namespace mh {

/// A generated environment by name: "generated:bathroom:3", or a floor of similar rooms:
/// "generated:hotel:0".
struct GeneratedReference {
  std::string category;
  std::uint64_t seed = 0;
};

/// Prefix of the names of generated environments, which are used in place of a file.
inline constexpr std::string_view kGeneratedPrefix = "generated:";
/// @throws InputError if it is not the name of a generated environment, or its category is unknown
GeneratedReference parse_generated(std::string_view source);
std::string to_string(const GeneratedReference& reference);

/// An environment drawn from a category's grammar (scenes/generate/categories/), as a house plan
/// for build_house. The same category and seed give the same text. Nothing overlaps, doors can be
/// opened, and a robot 0.52 m wide can get from every place where it fits to every other.
struct GeneratedPlan {
  std::string name;  ///< "bathroom-3"
  std::string room;  ///< which of the category's rooms: "bathroom", "gym"; for a floor "8 rooms"
  HouseFile house;
  double floor_area_m2 = 0;
  int objects = 0;        ///< pieces, doors and windows
  int fittings = 0;       ///< pieces not counted as objects: switches, radiators, papers on walls
  double free_share = 0;  ///< share of the floor where the robot can stand
  double objects_per_10_m2() const { return 10.0 * objects / floor_area_m2; }
  std::string yaml() const { return to_yaml(house); }  ///< see docs/formats.md, House
};
GeneratedPlan generate_plan(const GeneratedReference& reference);
/// The plan's text with its `detail` chosen so that the mesh has about kLeastTriangles to
/// kMostTriangles. Small rooms thus get finer light.
std::string with_detail(const GeneratedPlan& plan);
inline constexpr std::size_t kLeastTriangles = 120'000, kMostTriangles = 550'000;
Scene generate_scene(const GeneratedReference& reference);

/// Groups by the number of objects per 10 m2 of floor, as in the paper's Figure 3: 0-4, 4-8, 8-16,
/// 16 and more.
inline constexpr int kDensityGroups = 4;
int density_group(double objects_per_10_m2);
std::string_view density_group_name(int group);

}  // namespace mh
