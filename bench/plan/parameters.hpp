// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/core/yaml.hpp"
#include "slam/config/semantics.hpp"

namespace mh {

/// Whether a sweep varies the parameters of the queries alone, over one map made at the suite's
/// own, or maps anew for each point. Every table says which.
enum class SweepMap { kFixed, kRebuilt };
std::string_view name(SweepMap map);

/// The points of a sweep over the method's parameters. None: the suite's own settings alone.
struct Sweep {
  SweepMap map = SweepMap::kFixed;
  std::vector<std::string> varied;     ///< of gamma, xi, alpha, beta, in this order
  std::vector<SemanticConfig> points;  ///< whole settings, in the order of the results
};

/// The suite's own settings: the section `slam`.
SemanticConfig read_semantics(YamlReader node);

/// The section `parameters`: `map: fixed | rebuilt`, and either a grid (any of gamma, xi, alpha,
/// beta with a list of values; the last one varies fastest) or
/// `sobol: {points, seed, ranges: {gamma: [low, high], ...}}`.
/// @param base  settings of what is not varied
/// @throws InputError naming file, line, field and value.
Sweep read_sweep(YamlReader node, const SemanticConfig& base);

/// The method's parameter of that name (gamma, xi, alpha, beta).
double& parameter(SemanticConfig& config, std::string_view name);
double parameter(const SemanticConfig& config, std::string_view name);

inline constexpr std::array<std::string_view, 4> kParameters = {"gamma", "xi", "alpha", "beta"};

/// Point `index` of the Sobol sequence in four dimensions (Sobol, 1967; direction numbers of Joe
/// and Kuo, 2008), shifted digitally by the seed: each dyadic interval of each dimension holds its
/// share of every 2^k points. @returns coordinates in [0, 1)
std::array<double, 4> sobol_point(std::uint32_t index, std::uint64_t seed);

}  // namespace mh
