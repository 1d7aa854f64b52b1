// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/cli/motion_option.hpp"
#include "robots/model/robot.hpp"
#include "scenes/scene.hpp"

namespace mh::cli {

/// How the camera of `render` moves: by a motion, or exactly at the poses of a file.
class RenderMotion {
 public:
  void add_to(CLI::App& command);
  /// Reads what can be read without a scene. @throws InputError unless exactly one of a motion and
  /// a file of poses was given.
  void read();

  /// The text that describes the motion in render.json.
  std::string text() const;
  bool is_driven() const { return !has_poses() && mh::is_driven(motion_); }
  /// Whether the file's poses are those of the rendered camera (whichever camera that is) rather
  /// than those of the robot.
  bool is_of_camera() const { return has_poses() && poses_of_ == "camera"; }

  /// @pre read()
  /// @param say  receives messages: how the camera moves, whether poses were changed, and what may
  /// be wrong with them
  DrivenPath path(const Scene& scene, const Robot& robot, const std::vector<MovingObstacle>& others,
                  const SensorConfig& level,
                  const std::function<void(std::string_view)>& say) const;

 private:
  bool has_poses() const { return !file_.empty(); }

  MotionOption option_;
  std::string file_, poses_of_ = "camera";
  std::string motion_;
  Trajectory poses_;
};

}  // namespace mh::cli
