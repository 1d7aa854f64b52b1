// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/episodes/judge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mh {
namespace {

const char* reason_of(const EpisodeEnd& end, bool is_false, bool was_located) {
  if (is_false) return "false_pose";
  switch (end.state) {
    case NavigatorState::kArrived:
      return "wrong_arrival";
    case NavigatorState::kNoPath:
      return "no_path";
    case NavigatorState::kStuck:
      return "stuck";
    case NavigatorState::kCollided:
      return "collision_stop";
    default:
      return was_located ? "time_out" : "never_relocalized";
  }
}

}  // namespace

bool PoseError::is_false() const {
  return away_m > kFalsePose_m || turned_rad > kFalsePose_deg * std::numbers::pi / 180;
}

PoseError error_of(const Pose2& belief, const Pose2& truth) {
  return {(belief.place_m - truth.place_m).norm(),
          std::abs(turn_to(belief.heading_rad, truth.heading_rad))};
}

void judge(const EpisodeEnd& end, const EpisodeStart& start, double arrival_m,
           EpisodeScore& score) {
  score.length_m = end.length_m;
  score.end_distance_m = distance_to(start.boxes, end.truth.place_m);
  score.contacts = static_cast<int>(end.bumps.size());
  for (const Bump& bump : end.bumps) {
    score.worst_contact_m_per_s = std::max(score.worst_contact_m_per_s, bump.speed_m_per_s);
    if (bump.speed_m_per_s > kCollision_m_per_s) ++score.collisions;
  }
  bool is_false = false;
  if (end.belief) {
    const PoseError error = error_of(*end.belief, end.truth);
    score.last_error_m = error.away_m;
    is_false = error.is_false();
  }
  score.said_arrived = end.state == NavigatorState::kArrived;
  score.success = score.said_arrived && is_arrival(start, end.truth.place_m, arrival_m);
  score.wrong_arrival = score.said_arrived && !score.success;
  if (score.success)
    score.spl = score.shortest_m / std::max({score.shortest_m, score.length_m, 1e-9});
  else
    score.reason = reason_of(end, is_false, score.located_s.has_value());
}

}  // namespace mh
