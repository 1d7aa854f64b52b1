// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/query_replay.hpp"

#include <utility>

#include "bench/protocol/streams.hpp"
#include "bench/protocol/usable_frame.hpp"
#include "slam/pipeline/locate.hpp"

namespace mh {

void QueryReplay::begin(const SemanticConfig& point) {
  set_query_settings(frozen_, point);
  stale_scores_ = mapped_scores_;
}

Presentation QueryReplay::first(QuerySet set, std::size_t index) const {
  return presentation(query_stream(spec_, set), index, /*attempt=*/0, spec_.protocol.attempts);
}

RgbdFrame QueryReplay::frame(QuerySet set, std::size_t index, RandomStream noise) const {
  return usable_frame(*sequence_of(world_, set), index, noise);
}

PreparedFrame QueryReplay::prepared(const RgbdFrame& frame) const {
  return prepare(frame.stamp_ns, extract(frame, frozen_.camera, frozen_.config.features), frozen_,
                 Tracker{});
}

std::vector<KeyframeId> QueryReplay::candidates(PreparedFrame& frame) const {
  const Query query = with_words(frame, frozen_, StepObservers());
  StaleScores stale_scores = stale_scores_;
  std::vector<KeyframeId> chosen;
  for (const auto& candidate :
       choose_candidates(frozen_.map, query, frozen_.config, &stale_scores).candidates)
    chosen.push_back(candidate.keyframe);
  return chosen;
}

AnswerAgain QueryReplay::ask(PreparedFrame& frame, RandomStream draws,
                             const StepObservers& observers) {
  Tracker lost;
  lost.stale_scores = std::move(stale_scores_);
  StepReport report;
  const auto located = locate(frozen_, lost, frame, draws, observers, report);
  stale_scores_ = std::move(lost.stale_scores);
  AnswerAgain answer;
  answer.stage = report.relocalization;
  if (located) answer.world_from_camera = located->tracked.camera_from_world.inverse();
  return answer;
}

void QueryReplay::leave(QuerySet set, const QueryAnswer& answer) {
  if (frozen_.config.relocalize.neighbor_scores != NeighborScores::kAsReleased) return;
  for (int attempt = 1; attempt < answer.attempts; ++attempt) {
    const auto [noise, draws] =
        presentation(query_stream(spec_, set), answer.index, attempt, spec_.protocol.attempts);
    PreparedFrame again = prepared(frame(set, answer.index, noise));
    ask(again, draws, StepObservers());
  }
}

}  // namespace mh
