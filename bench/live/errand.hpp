// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/protocol/episodes/robot_map.hpp"
#include "sim/simulation/simulation.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// What a robot keeps of what it saw, to make the map that it drives by: scans and frames, without
/// color, wherever it had moved or turned enough. Of 200, every other one is dropped, and it has to
/// move farther from then on.
class KeptViews : public Sequence {
 public:
  explicit KeptViews(const Camera& camera) : camera_(camera) {}

  void see(const RobotObservation& seen, const SE3& world_from_camera);
  void forget() { *this = KeptViews(camera_); }
  const std::vector<std::vector<float>>& lasers_m(std::size_t i) const {
    return views_[i].lasers_m;
  }

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return views_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return views_[i].frame.stamp_ns; }
  RgbdFrame frame(std::size_t i, RandomStream) const override { return views_[i].frame; }
  const Trajectory* truth() const override { return nullptr; }

 private:
  struct View {
    RgbdFrame frame;
    std::vector<std::vector<float>> lasers_m;
    SE3 world_from_camera;
  };
  Camera camera_;
  std::vector<View> views_;
  double apart_m_ = kViewMoved_m, apart_rad_ = kViewTurned_rad;
};

/// A drive to an object of the robot's own map.
class Errand {
 public:
  /// Makes the map, which takes seconds.
  /// @param estimate  SLAM's trajectory now
  /// @throws InputError if there is no map yet, the map has no such object, no path leads there, or
  /// the robot cannot drive on its own
  Errand(const KeptViews& views, const Trajectory& estimate, const Robot& robot,
         const std::string& goal);

  /// The command until the next step.
  /// @param world_from_camera  SLAM's answer to the frame; nullopt: it is lost
  Twist2d step(double time_s, const RobotObservation& seen,
               const std::optional<SE3>& world_from_camera);
  const std::string& goal() const { return goal_; }
  NavigatorState state() const { return navigator_->state(); }
  /// The path that it follows, in SLAM's world; empty while it does not know where it is.
  std::vector<Eigen::Vector3d> path() const;

 private:
  const Robot& robot_;
  std::string goal_;
  std::unique_ptr<const RobotMap> map_;
  std::unique_ptr<Navigator> navigator_;
};

}  // namespace mh
