// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "bench/protocol/system.hpp"
#include "tests/slam/core/made_sequence.hpp"

namespace mh {

/// A system that follows a script instead of looking at images: frame i has timestamp i, and the
/// script says whether the n-th showing of frame i (n = 1, 2, ...) is tracked. It also scripts the
/// answers to queries.
class FakeSystem : public System {
 public:
  using Tracks = std::function<bool(Stamp frame, int showing)>;

  explicit FakeSystem(Tracks tracks) : tracks_(std::move(tracks)) {}

  SystemReport track(const RgbdFrame& frame, RandomStream stream) override {
    fed.push_back(frame.stamp_ns);
    streams.push_back(stream.key());
    imu.push_back(frame.imu);
    const bool tracked = tracks_(frame.stamp_ns, ++showings_[frame.stamp_ns]);
    SystemReport report;
    report.status = tracked ? TrackStatus::kTracked : TrackStatus::kLost;
    if (!tracked) return report;
    report.world_from_camera = pose(frame.stamp_ns);
    poses_[frame.stamp_ns] = pose(frame.stamp_ns);
    return report;
  }
  void rewind() override { ++rewinds; }
  void reset() override {
    ++resets;
    poses_.clear();
  }
  void freeze() override { frozen = true; }
  Trajectory trajectory() const override {
    Trajectory t;
    for (const auto& [stamp, p] : poses_) t.push_back({stamp, p});
    return t;
  }
  std::unique_ptr<RelocalizationSession> open_session() const override;

  static SE3 pose(Stamp stamp) {
    return {Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.01 * static_cast<double>(stamp), 0, 0)};
  }

  /// The attempt (1, 2, ...) that answers a query; 0 = none. Default: the first.
  std::function<int(Stamp frame)> answers_at = [](Stamp) { return 1; };
  /// Called with the random stream of every frame shown to a session.
  std::function<void(RandomStream)> on_query = [](RandomStream) {};
  /// Changes the report on the n-th showing of a test frame (n = 1, 2, ...).
  std::function<void(int attempt, SystemReport& report)> on_report = [](int, SystemReport&) {};
  /// Number of blank frames that are still reported as tracked.
  int believes_blanks = 0;

  std::vector<Stamp> fed;
  std::vector<std::uint64_t> streams;
  std::vector<std::vector<ImuReading>> imu;
  int rewinds = 0, resets = 0;
  bool frozen = false;

 private:
  Tracks tracks_;
  std::map<Stamp, int> showings_;
  std::map<Stamp, SE3> poses_;
};

class FakeSession : public RelocalizationSession {
 public:
  explicit FakeSession(const FakeSystem& system) : system_(system) {}
  SystemReport feed(const RgbdFrame& frame, RandomStream stream) override {
    SystemReport report;
    system_.on_query(stream);
    const bool blank = frame.depth_m(0, 0) == 0.0F;
    if (blank) {
      report.status =
          ++blanks_ > system_.believes_blanks ? TrackStatus::kLost : TrackStatus::kTracked;
      return report;
    }
    const bool found = ++attempts_ == system_.answers_at(frame.stamp_ns);
    report.relocalization = found ? RelocalizationStage::kVerified : RelocalizationStage::kMatches;
    report.candidates = {
        .keyframes = 10, .c1 = 9, .c2 = 4, .c3 = 3, .final = 1, .label_mass = {}, .gamma = {}};
    system_.on_report(attempts_, report);
    if (!found) return report;
    report.status = TrackStatus::kRelocalized;
    // A pose that depends only on the random draws: the permutation test needs that.
    const double wobble = 1e-3 * stream.uniform(0);
    report.world_from_camera = SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, wobble, 0)) *
                               FakeSystem::pose(frame.stamp_ns);
    return report;
  }

 private:
  const FakeSystem& system_;
  int blanks_ = 0, attempts_ = 0;
};

inline std::unique_ptr<RelocalizationSession> FakeSystem::open_session() const {
  return std::make_unique<FakeSession>(*this);
}

/// Frames of 2 x 2 pixels whose timestamp is their index; their color encodes the noise stream.
inline RgbdFrame fake_frame(std::size_t index, RandomStream noise) {
  RgbdFrame frame;
  frame.stamp_ns = static_cast<Stamp>(index);
  frame.color = Grid2d<Rgb8>(2, 2, Rgb8{static_cast<std::uint8_t>(noise.below(0, 256)), 0, 0});
  frame.depth_m = Grid2d<float>(2, 2, 1.0F);
  return frame;
}

/// The camera of fake_frame()'s frames.
inline Camera fake_camera() {
  Camera camera;
  camera.width_px = camera.height_px = 2;
  return camera;
}

/// The first `count` frames of fake_frame(), in order.
inline MadeSequence fake_frames(std::size_t count) {
  return {count, fake_frame, fake_camera()};
}

}  // namespace mh
