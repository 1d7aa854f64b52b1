// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/commands.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/motion/commanded_base.hpp"
#include "sim/motion/start.hpp"
#include "slam/core/angles.hpp"
#include "slam/io/error.hpp"
#include "slam/io/yaml.hpp"

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

bool has_reflex(const Robot& robot) {
  return robot.equipment && robot.equipment->reflex;
}

/// @throws InputError if the script needs something that the robot lacks.
void require_obeyed(const CommandScript& script, const Robot& robot) {
  const auto refuse = [&](int line, const std::string& what) {
    throw InputError(
        fmt::format("{}: robot '{}' {}", file_and_line(script.file, line), robot.name, what));
  };
  if (script.reflex == true && !has_reflex(robot))
    refuse(0, "has no reflex to enable (its file: equipment.collision_reflex)");
  for (const VelocityCommand& command : script.commands) {
    if (command.left_m_per_s != 0 && robot.differential() != nullptr)
      refuse(command.line, fmt::format("has a differential drive: it cannot go sideways "
                                       "(left_m_per_s: {:g})",
                                       command.left_m_per_s));
    if ((command.head_yaw_rad || command.head_pitch_rad) &&
        !(robot.equipment && robot.equipment->head))
      refuse(command.line, "has no head to move (its file: equipment.head)");
  }
}

/// How the head's joints move the RGB-D camera, in the base's frame.
SE3 camera_moved_by(const Equipment& e, const HeadJoints& head, double yaw_rad, double pitch_rad) {
  if (e.depth_camera_link.empty()) return SE3();
  return e.base_from(e.depth_camera_link, {{head.yaw, yaw_rad}, {head.pitch, pitch_rad}}) *
         e.base_from(e.depth_camera_link).inverse();
}

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
  if (yaml.has("reflex")) script.reflex = yaml.boolean("reflex", true);
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

std::string commands_text(const CommandScript& script) {
  std::string text =
      fmt::format("name: {}\nstart: {{position: [{}, {}], heading_deg: {}}}\n", script.name,
                  script.start_m.x(), script.start_m.y(), script.start_heading_rad / kDegree);
  if (script.reflex) text += fmt::format("reflex: {}\n", *script.reflex);
  text += "commands:\n";
  for (const VelocityCommand& c : script.commands) {
    text += fmt::format("- {{for_s: {}", c.duration_s);
    const auto add = [&](const char* key, double value) {
      if (value != 0) text += fmt::format(", {}: {}", key, value);
    };
    add("forward_m_per_s", c.forward_m_per_s);
    add("left_m_per_s", c.left_m_per_s);
    add("turn_deg_per_s", c.turn_rad_per_s / kDegree);
    if (c.head_yaw_rad) text += fmt::format(", head_yaw_deg: {}", *c.head_yaw_rad / kDegree);
    if (c.head_pitch_rad) text += fmt::format(", head_pitch_deg: {}", *c.head_pitch_rad / kDegree);
    text += "}\n";
  }
  return text;
}

CommandedDrive drive(const Scene& scene, const Robot& robot, const CommandScript& script,
                     const std::vector<MovingObstacle>& others) {
  const std::optional<HeadJoints> head = robot.equipment ? robot.equipment->head : std::nullopt;
  require_obeyed(script, robot);
  CommandedBase base(scene, robot, script.start_m, script.start_heading_rad,
                     script.reflex.value_or(has_reflex(robot)));
  for (const MovingObstacle& other : others) base.add(other);
  check_start(base.world(), scene, script.start_m, file_and_line(script.file, script.start_line));

  HeadJoint yaw, pitch;
  if (head) {
    yaw.joint = &robot.equipment->tree.joint(head->yaw);
    pitch.joint = &robot.equipment->tree.joint(head->pitch);
  }
  CommandedDrive result;

  const auto record = [&] {
    const auto frame = static_cast<double>(result.path.base.size());
    const Stamp stamp_ns = std::llround(frame * 1e9 / robot.camera.rate_hz);
    const SE3 world_from_base = base.world_from_base();
    SE3 base_from_camera = robot.base_from_camera;
    if (yaw.now_rad != 0 || pitch.now_rad != 0)
      base_from_camera = camera_moved_by(*robot.equipment, *head, yaw.now_rad, pitch.now_rad) *
                         robot.base_from_camera;
    result.path.base.push_back({stamp_ns, world_from_base});
    result.path.camera.push_back({stamp_ns, world_from_base * base_from_camera});
    if (head) result.path.head.push_back({yaw.now_rad, pitch.now_rad});
  };

  const auto step = [&](const VelocityCommand& command) {
    base.step({command.forward_m_per_s, command.left_m_per_s, command.turn_rad_per_s});
    if (head) {
      yaw.step(base.step_s());
      pitch.step(base.step_s());
    }
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
