// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/protocol/query.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/suite/runs.hpp"
#include "slam/pipeline/prepared_frame.hpp"
#include "slam/pipeline/slam.hpp"
#include "slam/relocalize/relocalize.hpp"

namespace mh {

/// What a system said when it was asked again.
struct AnswerAgain {
  std::optional<SE3> world_from_camera;
  RelocalizationStage stage = RelocalizationStage::kNone;
};

/// Asks the queries of a finished run again, on its finished map, so that what the run did not keep
/// can be observed. Under NeighborScores::kAsReleased answers depend on those before: queries are
/// then asked in the order of the run, and leave() repeats the attempts after the first. The
/// references outlive it.
class QueryReplay {
 public:
  QueryReplay(const RunSpec& spec, const World& world, SlamState& frozen)
      : spec_(spec),
        world_(world),
        frozen_(frozen),
        mapped_scores_(frozen.tracker.stale_scores),
        released_(mapped_scores_) {}

  /// From now on under one of the run's parameter points, from its first query on.
  void begin(const SemanticConfig& point);
  /// The streams of the first attempt.
  Presentation first(QuerySet set, std::size_t index) const;
  /// A frame of a set's sequence, and what the system finds in it.
  RgbdFrame frame(QuerySet set, std::size_t index, RandomStream noise) const;
  PreparedFrame prepared(const RgbdFrame& frame) const;
  /// What Algorithm 1 chooses for it, best first. Changes nothing.
  std::vector<KeyframeId> candidates(PreparedFrame& frame) const;
  AnswerAgain ask(PreparedFrame& frame, RandomStream draws, const StepObservers& observers);
  /// The run's further attempts at a query, where they bear on the queries after it.
  void leave(QuerySet set, const QueryAnswer& answer);

 private:
  const RunSpec& spec_;
  const World& world_;
  SlamState& frozen_;
  StaleScores mapped_scores_, released_;
};

}  // namespace mh
