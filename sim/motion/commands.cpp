// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/commands.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "robots/model/wheel_base.hpp"
#include "robots/navigation/floor_grid.hpp"
#include "sim/motion/peaks.hpp"
#include "sim/motion/start.hpp"
#include "slam/core/error.hpp"
#include "slam/core/yaml.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kStepRate_hz = 240.0;  // physics steps per second, at least
constexpr double kReflexCell_m = 0.025;

Vector2d turned(const Vector2d& v, double angle_rad) {
  return {std::cos(angle_rad) * v.x() - std::sin(angle_rad) * v.y(),
          std::sin(angle_rad) * v.x() + std::cos(angle_rad) * v.y()};
}

/// The external-collision reflex: how fast the base may go on in a direction.
class Reflex {
 public:
  Reflex(const Scene& scene, const Robot& robot)
      : grid_(make_floor_grid(scene, {.resolution_m = kReflexCell_m, .top_m = robot.height_m})),
        radius_m_(robot.footprint_radius_m),
        zone_(robot.equipment->reflex),
        limits_(robot.limits) {}

  double allowed_m_per_s(const Vector2d& place_m, const Vector2d& direction,
                         const std::vector<std::pair<Vector2d, double>>& others) const {
    // Speed is shed at half the limit: the jerk limit delays the braking.
    const double brake = 0.5 * limits_.max_acceleration_m_per_s2;
    const double farthest_m =
        zone_.ahead_m + limits_.max_velocity_m_per_s * limits_.max_velocity_m_per_s / (2 * brake);
    double free_m = farthest_m;  // from the shell to the nearest thing ahead
    const auto consider = [&](const Vector2d& p, double size_m) {
      const Vector2d away = p - place_m;
      const double ahead = away.dot(direction);
      const double aside = std::abs(direction.x() * away.y() - direction.y() * away.x());
      if (ahead <= 0 || aside > radius_m_ + zone_.aside_m + size_m) return;
      const double shell_m =
          std::sqrt(std::max(0.0, (radius_m_ + size_m) * (radius_m_ + size_m) - aside * aside));
      free_m = std::min(free_m, ahead - shell_m);
    };
    const double reach_m = radius_m_ + farthest_m;
    const auto span = [&](double middle, double origin, int size) {
      const auto at = [&](double m) {
        return std::clamp(static_cast<int>(std::lround((m - origin) / grid_.resolution_m)), 0,
                          size - 1);
      };
      return std::pair{at(middle - reach_m), at(middle + reach_m)};
    };
    const auto [x0, x1] = span(place_m.x(), grid_.origin_m.x(), grid_.occupant.width());
    const auto [y0, y1] = span(place_m.y(), grid_.origin_m.y(), grid_.occupant.height());
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        if (grid_.occupant(x, y) != 0) consider(grid_.centre_of({x, y}), 0.5 * kReflexCell_m);
    for (const auto& [p, size_m] : others) consider(p, size_m);
    return std::sqrt(2 * brake * std::max(0.0, free_m - zone_.ahead_m));
  }

 private:
  FloorGrid grid_;
  double radius_m_;
  CollisionReflex zone_;
  BaseLimits limits_;
};

/// A joint on its way to where it should be.
struct HeadJoint {
  const Joint* joint = nullptr;
  double now_rad = 0, goal_rad = 0;

  void aim(std::optional<double> goal, const CommandScript& script, int line) {
    if (!goal) return;
    if (*goal < joint->lower || *goal > joint->upper)
      throw InputError(fmt::format("{}:{}: {}: {:.1f} deg is outside {:.1f} to {:.1f}",
                                   script.file.string(), line, joint->name, *goal / kRadPerDeg,
                                   joint->lower / kRadPerDeg, joint->upper / kRadPerDeg));
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
    command.turn_rad_per_s = item.number_or("turn_deg_per_s", 0.0, -720.0, 720.0) * kRadPerDeg;
    if (const auto yaw = item.find("head_yaw_deg"))
      command.head_yaw_rad = yaw->as_double(-360.0, 360.0) * kRadPerDeg;
    if (const auto pitch = item.find("head_pitch_deg"))
      command.head_pitch_rad = pitch->as_double(-360.0, 360.0) * kRadPerDeg;
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
  const int steps_per_frame = static_cast<int>(std::ceil(kStepRate_hz / robot.camera.rate_hz));
  const double step_s = 1.0 / (robot.camera.rate_hz * steps_per_frame);
  PlanarWorld world(scene, robot, script.start_m, script.start_heading_rad, step_s);
  check_start(world, scene, script.start_m, file_and_line(script.file, script.start_line));
  for (const MovingObstacle& other : others) world.add(other);
  std::optional<Reflex> reflex;
  if (script.reflex) reflex.emplace(scene, robot);

  HeadJoint yaw{.joint = &equipment.tree.joint(equipment.head_yaw)};
  HeadJoint pitch{.joint = &equipment.tree.joint(equipment.head_pitch)};
  const SE3 camera_from_base_at_rest =
      equipment.tree.root_from(equipment.depth_camera_link).inverse();
  JerkLimiter limiter(commandable(robot.limits), step_s, &equipment.wheels);
  PeakMeter meter(step_s);
  CommandedDrive result;
  BaseState state = world.state();
  long steps = 0;
  double reflex_m_per_s = robot.limits.max_velocity_m_per_s;

  const auto record = [&] {
    const auto frame = static_cast<double>(result.path.base.size());
    const Stamp stamp_ns = std::llround(frame * 1e9 / robot.camera.rate_hz);
    const SE3 world_from_base(
        Eigen::AngleAxisd(state.heading_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
        {state.position_m.x(), state.position_m.y(), 0.0});
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
    Twist2d twist(command.forward_m_per_s, command.left_m_per_s, command.turn_rad_per_s);
    const double limit = robot.limits.max_velocity_m_per_s;
    if (twist.head<2>().norm() > limit) twist.head<2>() *= limit / twist.head<2>().norm();
    twist.z() =
        std::clamp(twist.z(), -robot.limits.max_turn_rad_per_s, robot.limits.max_turn_rad_per_s);
    Vector2d wanted = turned(twist.head<2>(), state.heading_rad);
    if (reflex && wanted.norm() > 0) {
      if (steps % steps_per_frame == 0) {
        std::vector<std::pair<Vector2d, double>> near;
        for (const MovingObstacle& other : others)
          near.emplace_back(other.path(static_cast<double>(steps) * step_s), other.radius_m);
        reflex_m_per_s = reflex->allowed_m_per_s(state.position_m, wanted.normalized(), near);
      }
      if (wanted.norm() > reflex_m_per_s) {
        wanted *= reflex_m_per_s / wanted.norm();
        result.reflex_time_s += step_s;
      }
    }
    const JerkLimiter::Velocity next =
        limiter.step({.m_per_s = wanted, .turn_rad_per_s = twist.z()});
    const BaseState before = state;
    const Contact contact =
        world.step({.velocity_m_per_s = next.m_per_s, .turn_rad_per_s = next.turn_rad_per_s});
    state = world.state();
    ++steps;
    yaw.step(step_s);
    pitch.step(step_s);

    if (contact.touching && (state.velocity_m_per_s - next.m_per_s).norm() > kPushed_m_per_s) {
      limiter.stopped_at({state.velocity_m_per_s, state.turn_rad_per_s});
      meter.pushed(state);
    } else {
      meter.add(state, &equipment.wheels);
    }
    result.path.length_m += (state.position_m - before.position_m).norm();
    result.path.max_penetration_m = std::max(result.path.max_penetration_m, contact.penetration_m);
    if (contact.touching) result.path.contact_time_s += step_s;
    if (steps % steps_per_frame == 0) record();
  };

  record();
  for (const VelocityCommand& command : script.commands) {
    yaw.aim(command.head_yaw_rad, script, command.line);
    pitch.aim(command.head_pitch_rad, script, command.line);
    const auto count = std::lround(command.duration_s / step_s);
    for (long i = 0; i < count; ++i) step(command);
  }
  while (steps % steps_per_frame != 0) step({});
  result.path.peaks = meter.peaks();
  return result;
}

}  // namespace mh
