// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "bench/report/pages/verdict.hpp"

namespace mh {

/// The verdict on each compared pair at each level in one plain sentence: who is better and by how
/// much, or that no difference was shown. The figures of the comparison behind the verdict are
/// included. In a suite of a single environment, ATE has no p: the sentence mentions it if one
/// system's ATE is at least kToldFactor times the other's.
/// @param all  from judged()
inline constexpr double kToldFactor = 2;
nlohmann::ordered_json headlines_json(const Suite& suite, std::span<const Row> rows,
                                      std::span<const Judged> all);

/// The most important figures of each system: a row per level and arm (system and labels) with the
/// share of the tour that it mapped, ATE, correct and answered queries of each set, and ms per
/// frame.
nlohmann::ordered_json tiles_json(const Suite& suite, std::span<const Row> rows,
                                  std::span<const CategoryRow> categories);

}  // namespace mh
