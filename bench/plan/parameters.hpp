// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/config/shared.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

/// Whether a sweep varies the parameters of the queries alone, over one map made at the suite's
/// own, or maps anew for each point. Every table says which.
enum class SweepMap { kFixed, kRebuilt };
std::string_view name(SweepMap map);

/// The points of a sweep over settings of SLAM. None: the suite's own settings alone.
struct Sweep {
  SweepMap map = SweepMap::kFixed;
  std::vector<std::string>
      varied;  ///< full names (slam/config/by_name.hpp), as the suite orders them
  std::vector<SharedSlamConfig> points;  ///< whole settings, in the order of the results
};

/// The section `parameters`: `map: fixed | rebuilt`, and either a grid (any settings, each with a
/// list of values: `features.count: [500, 1000]`; the last one varies fastest) or
/// `sobol: {points, seed, ranges: {semantics.gamma: [low, high], ...}}`. Over a fixed map only the
/// section `semantics` can vary.
/// @param base  settings of what is not varied
/// @throws InputError naming file, line, field and value.
Sweep read_sweep(YamlReader node, const SlamConfig& base);

/// How tables and images call a setting: the paper's symbols by themselves ("gamma"), others by
/// their full names.
std::string_view shown_name(std::string_view setting);

/// Its value there: numbers to four digits.
std::string shown_value(const SlamConfig& config, std::string_view setting);

/// Most settings that a Sobol sequence can vary.
inline constexpr std::size_t kSobolDimensions = 8;

/// Point `index` of the Sobol sequence (Sobol, 1967; direction numbers of Joe and Kuo, 2008),
/// shifted digitally by the seed: each dyadic interval of each dimension holds its share of every
/// 2^k points. @returns coordinates in [0, 1)
std::array<double, kSobolDimensions> sobol_point(std::uint32_t index, std::uint64_t seed);

}  // namespace mh
