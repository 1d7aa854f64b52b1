// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "bench/protocol/system_report.hpp"
#include "slam/core/random.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// Answers one query in a frozen map, starting lost. Sessions of one system share no mutable state,
/// so they may run in any order and concurrently. The exception is NeighborScores::kAsReleased,
/// under which answers depend on the order of the sessions.
class RelocalizationSession {
 public:
  virtual ~RelocalizationSession() = default;
  /// Processes one frame. The report contains a pose unless its status is kLost.
  virtual SystemReport feed(const RgbdFrame& frame, RandomStream stream) = 0;
};

/// An opaque cache for one query, shared by sessions that differ only in settings. It saves work
/// and does not change any answer.
class QueryMemo {
 public:
  virtual ~QueryMemo() = default;
};

/// The interface through which the protocol drives a SLAM system under test. The system sees
/// frames and random streams, nothing else.
class System {
 public:
  virtual ~System() = default;

  /// Processes the next frame, mapping included. All random draws come from the stream.
  virtual SystemReport track(const RgbdFrame& frame, RandomStream stream) = 0;
  /// Call when the input jumps back in time: tracking is treated as lost, the map is kept.
  virtual void rewind() = 0;
  /// Forgets everything, including the map.
  virtual void reset() = 0;
  /// Ends mapping. Do not call track(), rewind() or reset() afterward.
  virtual void freeze() = 0;
  /// Ends all processing; only trajectory() may be called afterward.
  virtual void finish() {}
  /// From the next session on, answers queries with the settings of this point of the run's sweep
  /// (RunSpec::points), instead of those used for mapping. Call freeze() first. A system without
  /// such settings ignores the call.
  virtual void use_point(std::size_t /*point*/) {}
  /// Serializes the finished map; a system that restores it gives bit-identical answers. Call
  /// freeze() first. An empty result means that this system cannot be saved.
  virtual std::string save() const { return {}; }
  /// Loads a saved map instead of mapping.
  /// @param saved  from save() of a system with the same settings
  virtual void restore(const std::string&) {}
  /// Returns the pose of each tracked frame once, ordered by stamp, as world_from_camera in the
  /// system's own world.
  virtual Trajectory trajectory() const = 0;
  /// A new session that starts lost. Call freeze() first.
  virtual std::unique_ptr<RelocalizationSession> open_session() const = 0;
  /// Makes an empty memo for one query; null if the system has no use for one.
  virtual std::unique_ptr<QueryMemo> make_memo() const { return nullptr; }
  /// Like open_session(), but reuses what is already known about this query.
  /// @param memo  from make_memo(), for this query alone; outlives the session
  virtual std::unique_ptr<RelocalizationSession> open_session_with(QueryMemo& memo) const;
};

inline std::unique_ptr<RelocalizationSession> System::open_session_with(QueryMemo&) const {
  return open_session();
}

/// Forwards all calls to another system, so that subclasses can observe them.
class SystemView : public System {
 public:
  explicit SystemView(std::unique_ptr<System> inner) : inner_(std::move(inner)) {}
  SystemReport track(const RgbdFrame& frame, RandomStream stream) override {
    return inner_->track(frame, stream);
  }
  void rewind() override { inner_->rewind(); }
  void reset() override { inner_->reset(); }
  void freeze() override { inner_->freeze(); }
  void finish() override { inner_->finish(); }
  void use_point(std::size_t point) override { inner_->use_point(point); }
  std::string save() const override { return inner_->save(); }
  void restore(const std::string& saved) override { inner_->restore(saved); }
  Trajectory trajectory() const override { return inner_->trajectory(); }
  std::unique_ptr<RelocalizationSession> open_session() const override {
    return inner_->open_session();
  }
  std::unique_ptr<QueryMemo> make_memo() const override { return inner_->make_memo(); }
  std::unique_ptr<RelocalizationSession> open_session_with(QueryMemo& memo) const override {
    return inner_->open_session_with(memo);
  }

 private:
  std::unique_ptr<System> inner_;
};

}  // namespace mh
