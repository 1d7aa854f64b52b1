// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "slam/core/digest.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// Outcome of one kidnapping, judged by the ground truth.
struct EpisodeScore {
  std::string variant = {};
  std::size_t start = 0;
  std::string goal = {};
  double start_x_m = 0, start_y_m = 0, start_heading_deg = 0;
  bool success = false;  ///< it reported arrival and was within arrival_m of a goal object
  /// Empty for a success, else: no_map, never_relocalized, false_pose, object_not_in_map, no_path,
  /// stuck, collision_stop, time_out, wrong_arrival.
  std::string reason = {};
  bool said_arrived = false;
  bool wrong_arrival = false;                  ///< reported arrival, but had not arrived
  double time_s = 0;                           ///< until it stopped for good
  std::optional<double> located_s = {};        ///< when it first believed that it knew where it was
  std::optional<double> located_error_m = {};  ///< error of that belief
  std::optional<double> located_error_deg = {};
  std::optional<double> last_error_m = {};  ///< error of its belief at the end
  double length_m = 0, shortest_m = 0;
  double spl = 0;             ///< success * shortest / max(shortest, driven): Anderson et al., 2018
  double end_distance_m = 0;  ///< from the nearest goal object
  int contacts = 0, collisions = 0;  ///< collisions: contacts faster than 0.1 m/s
  double worst_contact_m_per_s = 0;
  int frames = 0;
  std::uint64_t digest = 0;  ///< of everything that was seen, answered and commanded
};

template <MaybeConst<EpisodeScore> S, class Visit>
void fields(S& score, Visit& v) {
  auto& [variant, start, goal, start_x_m, start_y_m, start_heading_deg, success, reason,
         said_arrived, wrong_arrival, time_s, located_s, located_error_m, located_error_deg,
         last_error_m, length_m, shortest_m, spl, end_distance_m, contacts, collisions,
         worst_contact_m_per_s, frames, digest] = score;
  v("variant", variant);
  v("start", start);
  v("goal", goal);
  v("start_x_m", start_x_m);
  v("start_y_m", start_y_m);
  v("start_heading_deg", start_heading_deg);
  v("success", success);
  v("reason", reason);
  v("said_arrived", said_arrived);
  v("wrong_arrival", wrong_arrival);
  v("time_s", time_s);
  v("located_s", located_s);
  v("located_error_m", located_error_m);
  v("located_error_deg", located_error_deg);
  v("last_error_m", last_error_m);
  v("length_m", length_m);
  v("shortest_m", shortest_m);
  v("spl", spl);
  v("end_distance_m", end_distance_m);
  v("contacts", contacts);
  v("collisions", collisions);
  v("worst_contact_m_per_s", worst_contact_m_per_s);
  v("frames", frames);
  v("digest", as_digest(digest));
}

}  // namespace mh
