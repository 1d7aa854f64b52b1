// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/diagnosis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/protocol/streams.hpp"
#include "bench/protocol/world/world.hpp"
#include "scenes/recordings/nearest_stamp.hpp"
#include "slam/config/slam.hpp"
#include "slam/features/features.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBefore = 2;  // frames before one that count with it
constexpr int kWorst_percent = 30;

double& of(FrameFactors& factors, Factor factor) {
  return factors[static_cast<std::size_t>(factor)];
}

double luma(const Rgb8& c) {
  return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b;
}

void measure_image(const RgbdFrame& frame, FrameFactors& factors) {
  const Grid2d<Rgb8>& color = frame.color;
  double sum = 0, squares = 0, steps = 0;
  for (int y = 0; y < color.height(); ++y)
    for (int x = 0; x < color.width(); ++x) {
      const double here = luma(color(x, y));
      sum += here;
      squares += here * here;
      if (x > 0) steps += std::abs(here - luma(color(x - 1, y)));
    }
  const auto pixels = static_cast<double>(color.size());
  of(factors, Factor::kBrightness) = sum / pixels;
  of(factors, Factor::kContrast) =
      std::sqrt(std::max(0.0, squares / pixels - (sum / pixels) * (sum / pixels)));
  of(factors, Factor::kDetail) = steps / pixels;
  if (frame.depth_m.empty()) return;
  const auto seen = std::ranges::count_if(frame.depth_m, [](float z) { return z > 0; });
  of(factors, Factor::kDepth) =
      100.0 * static_cast<double>(seen) / static_cast<double>(frame.depth_m.size());
}

/// The factors of the frames of a sequence, each made once.
class MeasuredFrames {
 public:
  MeasuredFrames(const Sequence& frames, RandomStream noise)
      : frames_(frames), noise_(noise), known_(stamps_of_truth(frames)) {}

  /// The worst of this frame and those before it.
  FrameFactors at(std::size_t i) {
    FrameFactors worst = alone(i);
    for (std::size_t k = 1; k <= std::min(i, kBefore); ++k) {
      const FrameFactors before = alone(i - k);
      for (std::size_t f = 0; f < kFactors; ++f) {
        const bool more = facts_of(static_cast<Factor>(f)).more_is_worse;
        if (std::isnan(worst[f]) || (more ? before[f] > worst[f] : before[f] < worst[f]))
          worst[f] = before[f];
      }
    }
    return worst;
  }
  FrameFactors alone(std::size_t i) {
    const auto [known, is_new] = made_.try_emplace(i);
    if (is_new) known->second = measure(i);
    return known->second;
  }

 private:
  FrameFactors measure(std::size_t i) const {
    FrameFactors factors;
    factors.fill(kUnknown);
    try {
      const RgbdFrame frame = frames_.frame(i, noise_);
      measure_image(frame, factors);
      of(factors, Factor::kKeypoints) =
          static_cast<double>(extract(frame, frames_.camera(), FeatureConfig()).size());
      measure_motion(i, factors);
    } catch (const InputError&) {  // a damaged frame was shown to nobody
    }
    return factors;
  }

  static std::vector<Stamp> stamps_of_truth(const Sequence& frames) {
    std::vector<Stamp> stamps_ns;
    if (frames.truth() != nullptr)
      for (const TimedPose& pose : *frames.truth()) stamps_ns.push_back(pose.stamp_ns);
    return stamps_ns;
  }
  /// Turn rate and speed since the frame before, where both have a true pose.
  void measure_motion(std::size_t i, FrameFactors& factors) const {
    if (i == 0) return;
    const auto now = known_.nearest(frames_.stamp_ns(i)),
               before = known_.nearest(frames_.stamp_ns(i - 1));
    if (!now || !before) return;
    const TimedPose &here = (*frames_.truth())[*now], &there = (*frames_.truth())[*before];
    if (here.stamp_ns <= there.stamp_ns) return;
    const double dt_s = 1e-9 * static_cast<double>(here.stamp_ns - there.stamp_ns);
    const SE3 moved = there.world_from_camera.inverse() * here.world_from_camera;
    of(factors, Factor::kTurn) =
        Eigen::AngleAxisd(moved.rotation()).angle() * 180 / std::numbers::pi / dt_s;
    of(factors, Factor::kSpeed) = moved.translation().norm() / dt_s;
  }

  const Sequence& frames_;
  RandomStream noise_;
  StampIndex known_;  ///< of the true poses
  std::map<std::size_t, FrameFactors> made_;
};

void judge_mapping(const RunResult& run, MeasuredFrames& frames, std::vector<JudgedFrame>& out) {
  std::map<std::size_t, bool> lost;  // by frame: whether it was the first that was lost
  bool before = true;                // nothing is lost before something was mapped
  for (const MappedFrame& call : run.mapping.calls) {
    const bool now = call.status == TrackStatus::kLost;
    // A frame that follows a loss says nothing: the system is lost whatever it sees.
    if (!now || !before) lost.try_emplace(call.index, now);
    before = now;
  }
  for (const auto& [index, failed] : lost)
    out.push_back({run.spec.name, index, frames.at(index), failed});
}

RelativeRisk risk_beyond(const std::vector<JudgedFrame>& frames, Factor factor, double limit) {
  const bool more = facts_of(factor).more_is_worse;
  RelativeRisk risk{.factor = factor, .limit = limit};
  for (const JudgedFrame& frame : frames) {
    const double value = frame.factors[static_cast<std::size_t>(factor)];
    if (std::isnan(value)) continue;
    const bool beyond = more ? value > limit : value < limit;
    (beyond ? risk.beyond : risk.within) += 1;
    if (frame.failed) (beyond ? risk.failed_beyond : risk.failed_within) += 1;
  }
  // With half a failure more on both sides, so that neither is 0.
  const double a = static_cast<double>(risk.failed_beyond) + 0.5,
               n = static_cast<double>(risk.beyond) + 0.5,
               b = static_cast<double>(risk.failed_within) + 0.5,
               m = static_cast<double>(risk.within) + 0.5;
  const double log_ratio = std::log((a / n) / (b / m));
  const double sigma = std::sqrt(std::max(0.0, 1 / a - 1 / n + 1 / b - 1 / m));
  risk.ratio = std::exp(log_ratio);
  risk.low = std::exp(log_ratio - 1.96 * sigma);
  risk.high = std::exp(log_ratio + 1.96 * sigma);
  return risk;
}

std::string sentence(const RelativeRisk& risk, const char* outcome) {
  const FactorFacts& facts = facts_of(risk.factor);
  return fmt::format(
      "  {} {} {:.{}f} {}: {} {:.1f} times as often ({:.1f} to {:.1f}); {} of {}, "
      "against {} of {}\n",
      facts.name, facts.more_is_worse ? "above" : "below", risk.limit, facts.decimals, facts.unit,
      outcome, risk.ratio, risk.low, risk.high, risk.failed_beyond, risk.beyond, risk.failed_within,
      risk.within);
}

/// "semantic-exact-pepper-0: 12, 40; ...": the first of them.
std::string failed_frames(const std::vector<JudgedFrame>& frames) {
  constexpr std::size_t kMost = 12;
  std::string text, run;
  std::size_t count = 0;
  for (const JudgedFrame& frame : frames) {
    if (!frame.failed || ++count > kMost) continue;
    text += frame.run == run
                ? fmt::format(", {}", frame.frame)
                : fmt::format("{}{}: {}", text.empty() ? "" : "; ", frame.run, frame.frame);
    run = frame.run;
  }
  return text + (count > kMost ? fmt::format("; {} more", count - kMost) : "");
}

nlohmann::ordered_json ranked_json(const std::vector<JudgedFrame>& frames) {
  nlohmann::ordered_json factors = nlohmann::ordered_json::array(),
                         failed = nlohmann::ordered_json::array();
  for (const RelativeRisk& risk : rank_factors(frames)) {
    const FactorFacts& facts = facts_of(risk.factor);
    factors.push_back({{"factor", facts.name},
                       {"unit", facts.unit},
                       {"beyond", facts.more_is_worse ? "above" : "below"},
                       {"limit", risk.limit},
                       {"relative_risk", risk.ratio},
                       {"interval", {risk.low, risk.high}},
                       {"failed_beyond", risk.failed_beyond},
                       {"beyond_count", risk.beyond},
                       {"failed_within", risk.failed_within},
                       {"within_count", risk.within}});
  }
  for (const JudgedFrame& frame : frames)
    if (frame.failed) failed.push_back({{"run", frame.run}, {"frame", frame.frame}});
  return {{"frames", frames.size()}, {"factors", factors}, {"failed", failed}};
}

}  // namespace

const FactorFacts& facts_of(Factor factor) {
  static constexpr std::array<FactorFacts, kFactors> kAll = {
      {{"turn rate", "deg/s", true, 0},
       {"speed", "m/s", true, 2},
       {"keypoints", "", false, 0},
       {"depth seen", "% of the image", false, 0},
       {"brightness", "of 255", false, 1},
       {"contrast", "gray levels", false, 1},
       {"detail", "gray levels from a pixel to the next", false, 2}}};
  return kAll[static_cast<std::size_t>(factor)];
}

std::vector<RelativeRisk> rank_factors(const std::vector<JudgedFrame>& frames) {
  const auto failed = static_cast<std::size_t>(std::ranges::count_if(frames, &JudgedFrame::failed));
  if (failed == 0 || failed == frames.size()) return {};
  std::vector<RelativeRisk> ranked;
  for (std::size_t f = 0; f < kFactors; ++f) {
    const auto factor = static_cast<Factor>(f);
    std::vector<double> values;
    for (const JudgedFrame& frame : frames)
      if (!std::isnan(frame.factors[f])) values.push_back(frame.factors[f]);
    if (values.size() < 10) continue;
    if (facts_of(factor).more_is_worse)
      std::ranges::sort(values, std::greater());
    else
      std::ranges::sort(values);
    std::optional<RelativeRisk> best;
    for (int percent = 1; percent <= kWorst_percent; ++percent) {
      const double share = 0.01 * percent;
      const double limit =
          values[static_cast<std::size_t>(share * static_cast<double>(values.size()))];
      const RelativeRisk risk = risk_beyond(frames, factor, limit);
      if (risk.beyond > 0 && risk.within > 0 && (!best || risk.low > best->low)) best = risk;
    }
    if (best) ranked.push_back(*best);
  }
  std::ranges::stable_sort(ranked, std::greater(), &RelativeRisk::low);
  return ranked;
}

std::vector<Diagnosis> diagnose(const std::vector<RunResult>& runs, const DiagnosisTools& tools) {
  std::vector<Diagnosis> all;
  // Runs of one environment, level and trial were shown the same frames.
  std::map<std::string, std::vector<const RunResult*>> same_frames;
  for (const RunResult& run : runs)
    same_frames[fmt::format("{} {} {}", run.spec.environment.name, level_name(run.spec.level),
                            run.spec.trial)]
        .push_back(&run);
  double done = 0;
  for (const auto& [what, shown] : same_frames) {
    tools.say(what);
    const RunSpec& spec = shown.front()->spec;
    const World world = build_world(spec, 1, tools.cache, tools.say);
    MeasuredFrames mapping(*world.mapping, mapping_noise(mapping_stream(spec), 0));
    for (const RunResult* run : shown) {
      const std::string system =
          fmt::format("{}, level {}", run->spec.system.name, level_name(run->spec.level));
      auto of_system = std::ranges::find(all, system, &Diagnosis::system);
      if (of_system == all.end()) {
        all.push_back({system, {}, {}});
        of_system = std::prev(all.end());
      }
      judge_mapping(*run, mapping, of_system->mapping);
      for (const QueryScore& query : run->points.front().held_out)
        if (is_judged(query))
          of_system->queries.push_back({run->spec.name, query.answer.index,
                                        mapping.alone(query.answer.index), !query.correct});
    }
    tools.progress(++done / static_cast<double>(same_frames.size()));
  }
  return all;
}

std::string diagnosis_text(const std::vector<Diagnosis>& all) {
  std::string text;
  for (const Diagnosis& of_system : all)
    for (const auto& [frames, what, outcome] :
         {std::tuple(&of_system.mapping, "losses", "lost"),
          std::tuple(&of_system.queries, "held-out queries not answered right",
                     "not answered right")}) {
      const auto failed = std::ranges::count_if(*frames, &JudgedFrame::failed);
      text += fmt::format("{}: {} {} among {}\n", of_system.system, failed, what,
                          counted(frames->size(), "frame"));
      bool any = false;
      for (const RelativeRisk& risk : rank_factors(*frames)) {
        if (risk.low <= 1) continue;
        text += sentence(risk, outcome);
        any = true;
      }
      if (failed == 0) continue;
      if (!any) text += "  no factor tells them from the others\n";
      text += fmt::format("  frames: {}\n", failed_frames(*frames));
    }
  return text +
         "Observed, not caused: factors come together. 95 % intervals; a frame counts with the "
         "two before it.\n";
}

nlohmann::ordered_json diagnosis_json(const std::vector<Diagnosis>& all) {
  nlohmann::ordered_json systems = nlohmann::ordered_json::array();
  for (const Diagnosis& of_system : all)
    systems.push_back({{"system", of_system.system},
                       {"losses", ranked_json(of_system.mapping)},
                       {"queries", ranked_json(of_system.queries)}});
  return {{"systems", systems}};
}

}  // namespace mh
