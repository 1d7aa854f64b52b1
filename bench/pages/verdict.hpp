// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "bench/results/scenes.hpp"

namespace mh {

/// How many pairs (queries, scenes or clusters) would decide a comparison with 80 % power at the
/// 5 % level if the true difference is the observed one: the detectable difference shrinks with the
/// square root of their number. Absent if no difference was observed or nothing can be detected.
std::optional<double> pairs_to_decide(const Comparison& comparison);

/// A comparison in one sentence with its interval, as a reader of the overview sees it.
std::string verdict_sentence(const Suite& suite, const SystemPair& systems, const Comparison& c);

/// Every comparison of a suite, over scenes where it has several: a table with a sentence each. The
/// sentence that matters most comes first: success in the declared family.
nlohmann::ordered_json verdicts_json(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
