// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/plan/shipped.hpp"
#include "scenes/scene_frame.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

/// A place to be mapped and asked about, as data: a scene and how it is crossed. `scene` and
/// the tours are files, or made by code: "generated:KIND:SEED" (see is_generated). In a suite a
/// tour may also be `auto[:SEED]` or `handheld[:SEED[:FRAMES]]` (sim/world/travel.hpp); the
/// mapping tour is `auto` where none is given.
struct Environment {
  std::string name;      ///< unique in its suite, fit for a folder
  std::string category;  ///< over which means are taken: "bathroom"
  std::filesystem::path scene, robot, mapping_tour;
  SceneFrame frame = {};                            ///< of the scenes' files
  std::optional<std::filesystem::path> query_tour;  ///< the second tour; none: held-out frames only
  // What a scenario changes.
  std::optional<std::filesystem::path> query_scene = {};  ///< of the second tour; none: the scene
  /// From one frame to the next the robot is put to the start of this tour, and maps on.
  std::optional<std::filesystem::path> kidnapped_tour = {};
  std::optional<std::filesystem::path> sensors = {};     ///< settings in the place of the level's
  std::optional<std::filesystem::path> pedestrian = {};  ///< while the robot maps
};

/// Whether a source names something that code makes ("generated:bathroom:0") instead of a file.
bool is_generated(const std::filesystem::path& source);

/// What a suite's paths are relative to, and whether the files must be there: results are put
/// together and exported where nothing of what made them may be left.
struct SuitePaths {
  std::filesystem::path folder;
  bool must_exist = true;
};

/// Reads the list `environments` of a suite. Each entry is a mapping with the fields of
/// Environment, and one of these more:
/// - `count: N` makes N of it, with {i} = 0 .. N-1 put into name, scene and tours; the name
/// defaults
///   to CATEGORY-{i}.
/// - `files: PATTERN` stands alone: every file that matches (* and ? in the last part of the path),
///   in the order of names, holds one such mapping, its paths relative to its own folder.
/// Names default to the category; `robot` to the one given.
/// @throws InputError naming file, line, field and value: an empty list, two environments of one
/// name, a file that is missing.
std::vector<Environment> read_environments(
    const YamlReader& list, const SuitePaths& paths,
    const std::optional<std::filesystem::path>& default_robot);

/// The file that a suite names; where there is none, what is shipped under that name.
/// @throws InputError at this place if it must exist and does not.
std::filesystem::path named_file(const YamlReader& node, const SuitePaths& paths,
                                 std::optional<Shipped> what = {});

}  // namespace mh
