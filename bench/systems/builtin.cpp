// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/builtin.hpp"

#include <cassert>
#include <list>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "slam/files/map_file.hpp"
#include "slam/relocalize/candidate_trial.hpp"

namespace mh {
namespace {

/// The numbers of keyframes left by Algorithm 1, and how many scores in its sums are from earlier
/// queries.
Candidates as_candidates(const CandidateCounts& c, double gamma) {
  Candidates candidates{.keyframes = c.keyframes,
                        .c1 = c.c1,
                        .c2 = c.c2,
                        .c3 = c.c3,
                        .final = c.final,
                        .label_mass = c.label_mass,
                        .gamma = gamma};
  const SummedScores& summed = c.summed;
  if (summed.terms == 0) return candidates;
  candidates.unscored = static_cast<double>(summed.unscored) / summed.terms;
  candidates.stale = static_cast<double>(summed.stale) / summed.terms;
  if (summed.weight > 0) candidates.stale_weight = summed.stale_weight / summed.weight;
  if (summed.stale > 0) candidates.stale_age = static_cast<double>(summed.stale_age) / summed.stale;
  return candidates;
}

/// @param state  after the step
SystemReport as_report(const StepReport& step, const SlamState& state) {
  SystemReport report{.status = step.status,
                      .world_from_camera = step.world_from_camera,
                      .map = step.origin.valid() ? step.origin.value : 0,
                      .keypoints = step.keypoints,
                      .inliers = step.inliers,
                      .keyframe_added = step.keyframe_added,
                      .loop = step.loop,
                      .relocalization = step.relocalization,
                      .candidates = {},
                      .matches = step.matches};
  if (step.candidates)
    report.candidates = as_candidates(*step.candidates, state.config.semantics.gamma);
  return report;
}

class BuiltinSession : public RelocalizationSession {
 public:
  /// @param stale_scores  scores left by earlier sessions, to which this session adds its own; may
  /// be null
  BuiltinSession(const SlamState& frozen, const StepObservers& observers,
                 StaleScores* stale_scores = nullptr)
      : frozen_(frozen), observers_(observers), stale_scores_(stale_scores) {
    if (stale_scores_ != nullptr) tracker_.stale_scores = *stale_scores_;
  }
  SystemReport feed(const RgbdFrame& frame, RandomStream stream) override {
    const StepReport report = localize(frozen_, tracker_, frame, stream, observers_);
    if (stale_scores_ != nullptr) *stale_scores_ = tracker_.stale_scores;
    return as_report(report, frozen_);
  }

 private:
  const SlamState& frozen_;  // the system that opened the session outlives it, as do the observers
  const StepObservers& observers_;
  StaleScores* stale_scores_;
  Tracker tracker_;
};

/// Results of the attempts of one query, by stream and by the settings that affect them.
class BuiltinMemo : public QueryMemo {
 public:
  LocalizeMemo& of(RandomStream stream, const SemanticConfig& settings) {
    return known_[{stream.key(), trial_key(settings)}];
  }

 private:
  std::map<std::pair<std::uint64_t, TrialKey>, LocalizeMemo> known_;
};

/// A session that uses a memo while it is lost.
class RememberingSession : public RelocalizationSession {
 public:
  RememberingSession(const SlamState& frozen, BuiltinMemo& memo) : frozen_(frozen), memo_(memo) {}

  SystemReport feed(const RgbdFrame& frame, RandomStream stream) override {
    if (found_) {  // a frame after the one in which it relocalized: rare
      localize(frozen_, tracker_, found_->first, found_->second);
      found_.reset();
    }
    if (tracker_.last) return as_report(localize(frozen_, tracker_, frame, stream), frozen_);
    const StepReport report =
        localize(frozen_, frame, stream, memo_.of(stream, frozen_.config.semantics));
    if (report.status != TrackStatus::kLost) found_.emplace(frame, stream);
    return as_report(report, frozen_);
  }

 private:
  const SlamState& frozen_;
  BuiltinMemo& memo_;
  Tracker tracker_;
  std::optional<std::pair<RgbdFrame, RandomStream>> found_;  ///< not yet in tracker_
};

class BuiltinSystem : public System {
 public:
  BuiltinSystem(SlamState own, std::vector<SemanticConfig> points)
      : own_(std::make_unique<SlamState>(std::move(own))),
        state_(*own_),
        options_{.points = std::move(points)} {}
  BuiltinSystem(SlamState& state, const BuiltinOptions& options)
      : state_(state), options_(options), found_(!state.tracked_frames.empty()) {}

  SystemReport track(const RgbdFrame& frame, RandomStream stream) override {
    assert(!frozen_);
    const StepReport report = step(state_, frame, stream, options_.observers);
    const bool lost = report.status == TrackStatus::kLost;
    if (lost && found_ && state_.map.keyframe_count() <= options_.small_map)
      if (auto first = begin_anew(frame, stream)) return *first;
    found_ = found_ || !lost;
    return as_report(report, state_);
  }
  void rewind() override { mh::rewind(state_); }
  void reset() override { state_ = make_slam(state_.camera, state_.config, state_.vocabulary); }
  void freeze() override { frozen_ = true; }
  void use_point(std::size_t point) override {
    assert(frozen_);
    if (!options_.points.empty()) set_query_settings(state_, options_.points.at(point));
  }
  std::string save() const override {
    assert(frozen_);
    return encode_slam(state_);
  }
  void restore(const std::string& saved) override {
    state_ = decode_slam(saved, "saved map", state_.vocabulary);
  }
  Trajectory trajectory() const override { return mh::trajectory(state_); }
  std::unique_ptr<QueryMemo> make_memo() const override { return std::make_unique<BuiltinMemo>(); }
  std::unique_ptr<RelocalizationSession> open_session() const override {
    assert(frozen_);
    return std::make_unique<BuiltinSession>(state_, options_.observers, stale_scores());
  }
  std::unique_ptr<RelocalizationSession> open_session_with(QueryMemo& memo) const override {
    assert(frozen_);
    if (stale_scores() != nullptr)
      return open_session();  // answers depend on earlier ones: no memo
    return std::make_unique<RememberingSession>(state_, static_cast<BuiltinMemo&>(memo));
  }

 private:
  /// The scores that queries have left so far under these settings; null if the settings do not use
  /// them.
  StaleScores* stale_scores() const {
    if (state_.config.relocalize.neighbor_scores != NeighborScores::kAsReleased) return nullptr;
    const SemanticConfig& settings = state_.config.semantics;
    for (auto& [of, scores] : stale_scores_)
      if (of == settings) return &scores;
    // Initially, the scores are as mapping left them.
    return &stale_scores_.emplace_back(settings, state_.tracker.stale_scores).second;
  }

  /// Starts a new map in place of the present one, if the frame can initialize a map.
  std::optional<SystemReport> begin_anew(const RgbdFrame& frame, RandomStream stream) {
    SlamState anew = make_slam(state_.camera, state_.config, state_.vocabulary);
    const StepReport first = step(anew, frame, stream, options_.observers);
    if (first.status != TrackStatus::kInitialized) return std::nullopt;
    state_ = std::move(anew);
    SystemReport report = as_report(first, state_);
    report.map_reset = true;
    return report;
  }

  std::unique_ptr<SlamState> own_;
  SlamState& state_;
  BuiltinOptions options_;
  /// Under NeighborScores::kAsReleased, sessions with the same query settings share these scores,
  /// so that answers depend on the order of the sessions. Sessions hold pointers into this list.
  mutable std::list<std::pair<SemanticConfig, StaleScores>> stale_scores_;
  bool found_ = false;  ///< a frame was tracked in this map
  bool frozen_ = false;
};

}  // namespace

std::unique_ptr<System> make_builtin_system(const Camera& camera, const SlamConfig& config,
                                            std::shared_ptr<const Vocabulary> vocabulary,
                                            std::vector<SemanticConfig> points) {
  return std::make_unique<BuiltinSystem>(make_slam(camera, config, std::move(vocabulary)),
                                         std::move(points));
}

std::unique_ptr<System> make_builtin_system(SlamState& state, const BuiltinOptions& options) {
  return std::make_unique<BuiltinSystem>(state, options);
}

}  // namespace mh
