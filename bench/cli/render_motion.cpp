// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/render_motion.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "sim/motion/replay.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

/// Reasons to doubt poses that are rendered exactly as given.
std::vector<std::string> doubts(const Scene& scene, const Trajectory& camera, bool of_camera) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : scene.positions_m) box.extend(p.cast<double>());
  std::size_t outside = 0, upright = 0;
  constexpr double kUp = 0.95;  // within 18 degrees of the vertical
  for (const TimedPose& pose : camera) {
    outside += box.contains(pose.world_from_camera.translation()) ? 0 : 1;
    upright += std::abs(pose.world_from_camera.rotation()(2, 2)) > kUp ? 1 : 0;
  }
  std::vector<std::string> found;
  if (outside > 0)
    found.push_back(fmt::format("{} of {} are outside the scene: are they in its world frame?",
                                outside, counted(camera.size(), "pose")));
  if (of_camera && upright == camera.size())
    found.emplace_back(
        "every camera looks straight up or down: poses of a robot's base need --poses-of robot");
  return found;
}

}  // namespace

void RenderMotion::add_to(CLI::App& command) {
  option_.add_to(command);
  CLI::Option* const poses = command.add_option(
      "--poses", file_,
      "In place of a motion: renders at exactly the poses of this file (TUM, or EuRoC's CSV), in "
      "the scene's world");
  command
      .add_option("--poses-of", poses_of_,
                  "Whose poses: camera (z forward) or robot (its base: x forward, z up)")
      ->needs(poses)
      ->check(one_of_words({"camera", "robot"}));
}

void RenderMotion::read() {
  if (!has_poses()) {
    motion_ = option_.given();
    check_motion(motion_);
    return;
  }
  if (!option_.tour.empty() || !option_.motion.empty())
    throw InputError(fmt::format("--poses {}: takes the place of a motion: give only one", file_));
  poses_ = read_trajectory(file_);
}

std::string RenderMotion::text() const {
  return has_poses() ? fmt::format("poses of the {}: {}", poses_of_, file_) : motion_;
}

DrivenPath RenderMotion::path(const Scene& scene, const Robot& robot,
                              const std::vector<MovingObstacle>& others, const SensorConfig& level,
                              const std::function<void(std::string_view)>& say) const {
  if (has_poses()) {
    say(fmt::format("{} of {}, exactly as they are: of the {}, in the scene's world",
                    counted(poses_.size(), "pose"), file_, poses_of_));
    DrivenPath path = as_given(poses_, is_of_camera() ? PosesOf::kCamera : PosesOf::kRobot,
                               robot.base_from_camera);
    for (const std::string& doubt : doubts(scene, path.camera, is_of_camera()))
      say(fmt::format("warning: {}: {}", file_, doubt));
    return path;
  }
  say(fmt::format("moving along {}", motion_));
  if (const std::string note = note_on(motion_, robot); !note.empty()) say("warning: " + note);
  DrivenPath path =
      hurried(travel(scene, robot, motion_, others), motion_, level, robot.camera.rate_hz);
  if (!path.moved.empty())
    say(fmt::format("warning: {}; --poses renders at a file's poses as they are", path.moved));
  return path;
}

}  // namespace mh::cli
