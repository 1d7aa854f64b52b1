// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/sensors/dose.hpp"
#include "slam/config/shared.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// Whether a sweep varies only the parameters of the queries, on one map built with the suite's own
/// settings, or rebuilds the map for each point. Every table states which of the two applies.
enum class SweepMap { kFixed, kRebuilt };
std::string_view name(SweepMap map);

/// The points of a sweep over SLAM settings. If there are none, only the suite's own settings are
/// used. A sweep over dials of the level multiplies the suite's levels instead.
struct Sweep {
  SweepMap map = SweepMap::kFixed;
  std::vector<std::vector<Dose>> doses;  ///< every combination; empty if no dial is varied
  std::vector<std::string> varied;  ///< full names (slam/config/by_name.hpp), in the suite's order
  std::vector<SharedSlamConfig> points;  ///< complete settings, in the order of the results
};

/// Reads the section `parameters`: `map: fixed | rebuilt`, and either a grid (any settings, each
/// with a list of values: `features.count: [500, 1000]`; the last one varies fastest) or `sobol:
/// {points, seed, ranges: {semantics.gamma: [low, high], ...}}`. On a fixed map, only the section
/// `semantics` can vary. A grid may also vary dials of the level: `level.lens_blur.sigma_px: [0,
/// 1]`.
/// @param base  settings that are not varied
/// @throws InputError naming file, line, field and value.
Sweep read_sweep(YamlReader node, const SlamConfig& base);

/// The name of a setting in tables and images: the paper's symbol if it has one ("gamma"),
/// otherwise its full name.
std::string_view shown_name(std::string_view setting);

/// How much labels weigh in equation 1, given as a factor or as the share of a vector's mass that
/// labels should have. The same factor has a different effect with a different vocabulary, detector
/// or place.
inline constexpr std::string_view kGamma = "semantics.gamma", kLabelMass = "semantics.label_mass";
inline bool weighs_labels(std::string_view setting) {
  return setting == kGamma || setting == kLabelMass;
}

/// The value of a setting in tables and images; numbers are rounded to four digits.
std::string shown_value(const SlamConfig& config, std::string_view setting);

/// The settings that the sweep varies, with their values: "gamma 1, features.count 500".
std::string shown_point(const Sweep& sweep, const SlamConfig& point);

/// The maximum number of settings that a Sobol sequence can vary.
inline constexpr std::size_t kSobolDimensions = 8;

/// Point `index` of the Sobol sequence (Sobol, 1967; direction numbers of Joe and Kuo, 2008),
/// digitally shifted by the seed: each dyadic interval of each dimension contains its share of
/// every 2^k points. @returns coordinates in [0, 1)
std::array<double, kSobolDimensions> sobol_point(std::uint32_t index, std::uint64_t seed);

}  // namespace mh
