// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/commands.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/motion/commanded_base.hpp"
#include "sim/motion/start.hpp"
#include "slam/core/angles.hpp"
#include "slam/core/error.hpp"
#include "slam/core/yaml.hpp"

namespace mh {
namespace {

/// A joint moving toward its target.
struct HeadJoint {
  const Joint* joint = nullptr;
  double now_rad = 0, goal_rad = 0;

  void aim(std::optional<double> goal, const CommandScript& script, int line) {
    if (!goal) return;
    if (*goal < joint->lower || *goal > joint->upper)
      throw InputError(fmt::format("{}:{}: {}: {:.1f} deg is outside {:.1f} to {:.1f}",
                                   script.file.string(), line, joint->name, *goal / kDegree,
                                   joint->lower / kDegree, joint->upper / kDegree));
    goal_rad = *goal;
  }
  void step(double step_s) {
    const double most = joint->velocity * step_s;
    now_rad += std::clamp(goal_rad - now_rad, -most, most);
  }
};

}  // namespace

CommandScript load_commands(const std::filesystem::path& file) {
  YamlReader yaml = YamlReader::load(file);
  CommandScript script;
  script.file = file;
  script.name = yaml.string("name");
  const Start start = read_start(yaml);
  script.start_m = start.place_m;
  script.start_heading_rad = start.heading_rad;
  script.start_line = start.line;
  script.reflex = yaml.boolean("reflex", true);
  YamlReader list = yaml.at("commands");
  for (YamlReader& item : list.items()) {
    VelocityCommand command{.line = item.line()};
    command.duration_s = item.number("for_s", 0.0, 3600.0);
    command.forward_m_per_s = item.number_or("forward_m_per_s", 0.0, -5.0, 5.0);
    command.left_m_per_s = item.number_or("left_m_per_s", 0.0, -5.0, 5.0);
    command.turn_rad_per_s = item.number_or("turn_deg_per_s", 0.0, -720.0, 720.0) * kDegree;
    if (const auto yaw = item.find("head_yaw_deg"))
      command.head_yaw_rad = yaw->as_double(-360.0, 360.0) * kDegree;
    if (const auto pitch = item.find("head_pitch_deg"))
      command.head_pitch_rad = pitch->as_double(-360.0, 360.0) * kDegree;
    item.finish();
    script.commands.push_back(command);
  }
  if (script.commands.empty()) list.fail("a script needs at least one command");
  yaml.finish();
  return script;
}

CommandedDrive drive(const Scene& scene, const Robot& robot, const CommandScript& script,
                     const std::vector<MovingObstacle>& others) {
  if (!robot.equipment || !robot.limits.max_jerk_m_per_s3 || !robot.limits.max_turn_jerk_rad_per_s3)
    throw InputError(
        fmt::format("{}: robot '{}' has no jerk limits or no equipment: its file lacks "
                    "them",
                    script.file.string(), robot.name));
  const Equipment& equipment = *robot.equipment;
  CommandedBase base(scene, robot, script.start_m, script.start_heading_rad, script.reflex);
  for (const MovingObstacle& other : others) base.add(other);
  check_start(base.world(), scene, script.start_m, file_and_line(script.file, script.start_line));

  HeadJoint yaw{.joint = &equipment.tree.joint(equipment.head_yaw)};
  HeadJoint pitch{.joint = &equipment.tree.joint(equipment.head_pitch)};
  const SE3 camera_from_base_at_rest =
      equipment.tree.root_from(equipment.depth_camera_link).inverse();
  CommandedDrive result;

  const auto record = [&] {
    const auto frame = static_cast<double>(result.path.base.size());
    const Stamp stamp_ns = std::llround(frame * 1e9 / robot.camera.rate_hz);
    const SE3 world_from_base = base.world_from_base();
    SE3 base_from_camera = robot.base_from_camera;
    if (yaw.now_rad != 0 || pitch.now_rad != 0)
      base_from_camera = equipment.tree.root_from(equipment.depth_camera_link,
                                                  {{equipment.head_yaw, yaw.now_rad},
                                                   {equipment.head_pitch, pitch.now_rad}}) *
                         camera_from_base_at_rest * robot.base_from_camera;
    result.path.base.push_back({stamp_ns, world_from_base});
    result.path.camera.push_back({stamp_ns, world_from_base * base_from_camera});
    result.path.head.push_back({yaw.now_rad, pitch.now_rad});
  };

  const auto step = [&](const VelocityCommand& command) {
    base.step({command.forward_m_per_s, command.left_m_per_s, command.turn_rad_per_s});
    yaw.step(base.step_s());
    pitch.step(base.step_s());
    if (base.steps() % base.steps_per_frame() == 0) record();
  };

  record();
  for (const VelocityCommand& command : script.commands) {
    yaw.aim(command.head_yaw_rad, script, command.line);
    pitch.aim(command.head_pitch_rad, script, command.line);
    const auto count = std::lround(command.duration_s / base.step_s());
    for (long i = 0; i < count; ++i) step(command);
  }
  while (base.steps() % base.steps_per_frame() != 0) step({});
  result.path.peaks = base.peaks();
  result.path.length_m = base.length_m();
  result.path.max_penetration_m = base.max_penetration_m();
  result.path.contact_time_s = base.contact_time_s();
  result.reflex_time_s = base.reflex_time_s();
  return result;
}

}  // namespace mh
