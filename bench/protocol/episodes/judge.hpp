// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "bench/protocol/episodes/episode.hpp"
#include "sim/motion/commanded_base.hpp"

namespace mh {

/// How far a belief is off.
struct PoseError {
  double away_m = 0, turned_rad = 0;
  /// Whether it is off by more than kFalsePose_m or kFalsePose_deg.
  bool is_false() const;
};
PoseError error_of(const Pose2& belief, const Pose2& truth);

/// How an episode ended.
struct EpisodeEnd {
  NavigatorState state = NavigatorState::kLooking;
  Pose2 truth;
  std::optional<Pose2> belief;
  double length_m = 0;  ///< driven
  std::span<const Bump> bumps;
};

/// Fills in success, SPL, contacts and the reason for a failure, in a score whose start and
/// located_* are already set.
void judge(const EpisodeEnd& end, const EpisodeStart& start, double arrival_m, EpisodeScore& score);

}  // namespace mh
