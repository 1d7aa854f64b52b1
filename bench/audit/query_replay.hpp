// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/protocol/query.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/pipeline/prepared_frame.hpp"
#include "slam/pipeline/slam.hpp"
#include "slam/relocalize/relocalize.hpp"

namespace mh {

/// What a system answered when it was queried again.
struct AnswerAgain {
  std::optional<SE3> world_from_camera;
  RelocalizationStage stage = RelocalizationStage::kNone;
};

/// Repeats the queries of a finished run on its finished map, to observe what the run did not
/// record. Under NeighborScores::kAsReleased, answers depend on earlier ones: queries are then made
/// in the order of the run, and leave() repeats the attempts after the first. The objects given by
/// reference must outlive it.
class QueryReplay {
 public:
  QueryReplay(const RunSpec& spec, const World& world, SlamState& frozen)
      : spec_(spec),
        world_(world),
        frozen_(frozen),
        mapped_scores_(frozen.tracker.stale_scores),
        stale_scores_(mapped_scores_) {}

  /// Switches to one of the run's parameter points, starting at its first query.
  void begin(const SemanticConfig& point);
  /// The streams of the first attempt.
  Presentation first(QuerySet set, std::size_t index) const;
  /// Returns a frame of a set's sequence; prepared() adds the frame's features.
  RgbdFrame frame(QuerySet set, std::size_t index, RandomStream noise) const;
  PreparedFrame prepared(const RgbdFrame& frame) const;
  /// What Algorithm 1 chooses for a frame, best first. Has no side effects.
  std::vector<KeyframeId> candidates(PreparedFrame& frame) const;
  AnswerAgain ask(PreparedFrame& frame, RandomStream draws, const StepObservers& observers);
  /// Repeats the run's further attempts at a query if they affect later queries.
  void leave(QuerySet set, const QueryAnswer& answer);

 private:
  const RunSpec& spec_;
  const World& world_;
  SlamState& frozen_;
  StaleScores mapped_scores_, stale_scores_;
};

}  // namespace mh
