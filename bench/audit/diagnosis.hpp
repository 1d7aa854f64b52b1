// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/protocol/run_result.hpp"
#include "bench/suite/cache.hpp"

namespace mh {

// What do frames at which a system lost itself, or answered wrong, have in common? Observed, not
// caused: factors come together (a dark image has few keypoints, too).

/// What can be measured on a frame, whatever the system.
enum class Factor { kTurn, kSpeed, kKeypoints, kDepth, kBrightness, kContrast, kDetail };
inline constexpr std::size_t kFactors = 7;

struct FactorFacts {
  std::string_view name, unit;
  bool more_is_worse = false;
  int decimals = 0;
};
const FactorFacts& facts_of(Factor factor);

using FrameFactors = std::array<double, kFactors>;  ///< NaN where unknown

/// One frame of a run: its factors, the worst of it and the two before, and what came of it.
struct JudgedFrame {
  std::string run;
  std::size_t frame = 0;
  FrameFactors factors{};
  bool failed = false;
};

/// How much more often frames beyond a limit of a factor fail than the others.
struct RelativeRisk {
  Factor factor = Factor::kTurn;
  double limit = 0;
  std::size_t failed_beyond = 0, beyond = 0, failed_within = 0, within = 0;
  double ratio = 1, low = 0, high = 0;  ///< 95 % interval (Katz et al., 1978)
};

/// Each factor at the limit, within the worst 30 % of the frames, that separates best; ordered by
/// the lower end of the interval. Empty if no frame failed or all did.
std::vector<RelativeRisk> rank_factors(const std::vector<JudgedFrame>& frames);

/// What was seen of one system, over all of its runs.
struct Diagnosis {
  std::string system;
  std::vector<JudgedFrame> mapping, queries;  ///< failed: lost; not answered right
};

struct DiagnosisTools {
  Cache cache;
  std::function<void(std::string_view)> say = [](std::string_view) {};
  std::function<void(double)> progress = [](double) {};
};

/// Makes the frames of the runs again and measures them. @throws as build_world()
std::vector<Diagnosis> diagnose(const std::vector<RunResult>& runs, const DiagnosisTools& tools);

/// A sentence for each factor whose interval is above 1, with the frames that show it.
std::string diagnosis_text(const std::vector<Diagnosis>& all);
nlohmann::ordered_json diagnosis_json(const std::vector<Diagnosis>& all);

}  // namespace mh
