// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "bench/report/pages/verdict.hpp"

namespace mh {

/// The verdict on each compared pair at each level in one plain sentence, with the figures of the
/// comparison that it rests on: who is better, by how much, or that no difference was shown. With a
/// single environment, ATE has no p: the sentence mentions it if one is at least kToldFactor times
/// the other. @param all  from judged()
inline constexpr double kToldFactor = 2;
nlohmann::ordered_json headlines_json(const Suite& suite, std::span<const Row> rows,
                                      std::span<const Judged> all);

/// What each system does, in the most important figures: a row per level and arm with the share of
/// the tour that it mapped, ATE, correct and answered queries of each set, ms per frame.
nlohmann::ordered_json tiles_json(const Suite& suite, std::span<const Row> rows,
                                  std::span<const CategoryRow> categories);

}  // namespace mh
