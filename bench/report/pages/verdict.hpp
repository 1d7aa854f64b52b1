// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/results/scenes.hpp"

namespace mh {

/// How many pairs (queries, scenes or clusters) would decide a comparison with 80 % power at the 5
/// % level if the true difference is the observed one: the detectable difference shrinks with the
/// square root of the number of pairs. Absent if no difference was observed or nothing can be
/// detected.
std::optional<double> pairs_to_decide(const Comparison& comparison);

/// A comparison with its systems, level and environment.
struct Judged {
  SystemPair systems;
  std::size_t level = 0;
  std::string environment = {};  ///< empty: over all environments
  Comparison comparison;
  bool saturated = false;  ///< both systems do so well that no difference can be detected
};

/// Every comparison of a suite at its first parameter point, over scenes if the suite has several.
/// Comparisons by the suite's measure come first.
std::vector<Judged> judged(const Suite& suite, std::span<const Row> rows);

/// The figures of a comparison as text: the difference with its interval, the number of pairs and,
/// if no difference was shown, how many pairs would decide it.
std::string finding(const Suite& suite, const Judged& judged);

/// The headlines (headlines.hpp), and every comparison, once as a list for charts and once as a
/// table.
nlohmann::ordered_json verdicts_json(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
