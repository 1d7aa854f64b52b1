// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "bench/protocol/report.hpp"
#include "slam/config/semantics.hpp"
#include "slam/core/random.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// A lost tracker on a frozen map, which answers one query. Sessions of one system share no mutable
/// state, so they may run in any order and concurrently; one exception is
/// NeighborScores::kAsReleased, whose answers depend on the order.
class RelocalizationSession {
 public:
  virtual ~RelocalizationSession() = default;
  /// Shows one frame. A report whose status is not kLost carries a pose.
  virtual SystemReport feed(const RgbdFrame& frame, RandomStream stream) = 0;
};

/// What a system caches of one query between sessions that differ only in settings; opaque. It
/// saves work and changes no answer.
class QueryMemo {
 public:
  virtual ~QueryMemo() = default;
};

/// A SLAM system under test, as the protocol drives it. It sees nothing but frames.
class System {
 public:
  virtual ~System() = default;

  /// Processes the next frame, mapping included. All random draws come from the stream.
  virtual SystemReport track(const RgbdFrame& frame, RandomStream stream) = 0;
  /// The feed goes back in time: tracking is treated as lost, the map stays.
  virtual void rewind() = 0;
  /// Forgets everything, including the map.
  virtual void reset() = 0;
  /// Ends the mapping. track, rewind and reset must not be called afterwards.
  virtual void freeze() = 0;
  /// Ends the work; nothing but trajectory() may be called afterwards.
  virtual void finish() {}
  /// From the next session on, answers queries with other settings of the method than those used
  /// for mapping. Call freeze() first. A system without such settings ignores the call.
  virtual void set_query_settings(const SemanticConfig&) {}
  /// Returns the finished map as bytes, from which restore() makes a system that answers
  /// bit-identically. Call freeze() first. Empty: this system cannot be saved.
  virtual std::string save() const { return {}; }
  /// Replaces all mapping. @param saved  from save() of a system with the same settings
  virtual void restore(const std::string&) {}
  /// Each tracked frame once, ordered by stamp, as world_from_camera in the system's own world.
  virtual Trajectory trajectory() const = 0;
  /// A new session that starts lost. Call freeze() first.
  virtual std::unique_ptr<RelocalizationSession> open_session() const = 0;
  /// Makes an empty memo for one query; null if the system has no use for one.
  virtual std::unique_ptr<QueryMemo> make_memo() const { return nullptr; }
  /// open_session() with what is already known of this query.
  /// @param memo  from make_memo(), for this query alone; outlives the session
  virtual std::unique_ptr<RelocalizationSession> open_session_with(QueryMemo& memo) const;
};

inline std::unique_ptr<RelocalizationSession> System::open_session_with(QueryMemo&) const {
  return open_session();
}

}  // namespace mh
