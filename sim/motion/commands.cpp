// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/commands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "robots/model/wheel_base.hpp"
#include "scenes/band.hpp"
#include "sim/motion/peaks.hpp"
#include "sim/motion/start.hpp"
#include "sim/physics/outline.hpp"
#include "slam/core/angles.hpp"
#include "slam/core/error.hpp"
#include "slam/core/yaml.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

Vector2d turned(const Vector2d& v, double angle_rad) {
  return {std::cos(angle_rad) * v.x() - std::sin(angle_rad) * v.y(),
          std::sin(angle_rad) * v.x() + std::cos(angle_rad) * v.y()};
}

/// The external-collision reflex: how fast the base may keep moving in a direction.
class Reflex {
 public:
  Reflex(const Scene& scene, const Robot& robot)
      : outline_(floor_outline(scene, static_cast<float>(scene.floor.rough_m),
                               static_cast<float>(robot.height_m))),
        radius_m_(robot.footprint_radius_m),
        zone_(robot.equipment->reflex),
        brake_m_per_s2_(kBraking * robot.limits.max_acceleration_m_per_s2),
        // The distance at which the fastest robot has to slow down.
        reach_m_(radius_m_ + zone_.aside_m + zone_.ahead_m + soft_m() +
                 robot.limits.max_velocity_m_per_s * robot.limits.max_velocity_m_per_s /
                     (2 * brake_m_per_s2_)) {}

  double allowed_m_per_s(const Vector2d& place_m, const Vector2d& direction,
                         const std::vector<std::pair<Vector2d, double>>& others) const {
    const auto ahead_and_aside = [&](const Vector2d& p) {
      const Vector2d away = p - place_m;
      return Vector2d(direction.dot(away), direction.x() * away.y() - direction.y() * away.x());
    };
    double free_m = reach_m_;  // from the shell to the nearest thing ahead
    for (const OutlineEdge& edge : outline_) {
      const Vector2d a = edge.a_m.cast<double>(), b = edge.b_m.cast<double>();
      const Vector2d low = a.cwiseMin(b) - place_m, high = a.cwiseMax(b) - place_m;
      if (low.maxCoeff() > reach_m_ || high.minCoeff() < -reach_m_) continue;
      free_m = std::min(free_m, way_to_edge_m(ahead_and_aside(a), ahead_and_aside(b)));
    }
    for (const auto& [p, size_m] : others)
      free_m = std::min(free_m, way_to_disc_m(ahead_and_aside(p), size_m));
    const double left_m = std::max(0.0, free_m - zone_.ahead_m);
    // Braking at a constant rate would end in a jerk: its end is faded out.
    if (left_m < soft_m()) return kFade_per_s * left_m;
    return std::sqrt(2 * brake_m_per_s2_ * (left_m - 0.5 * soft_m()));
  }

 private:
  // Less than the base is capable of: the jerk limit delays braking.
  static constexpr double kBraking = 0.5;
  static constexpr double kFade_per_s = 2.0;
  static constexpr double kNever_m = std::numeric_limits<double>::infinity();

  /// On the last stretch, speed is kFade_per_s times the remaining distance; here both rules brake
  /// equally.
  double soft_m() const { return brake_m_per_s2_ / (kFade_per_s * kFade_per_s); }

  /// How far the base can move until its shell reaches the point.
  double way_to_point_m(const Vector2d& p, double radius_m) const {
    return p.x() - std::sqrt(std::max(0.0, radius_m * radius_m - p.y() * p.y()));
  }

  double way_to_disc_m(const Vector2d& middle, double size_m) const {
    const double reach_m = radius_m_ + size_m;
    if (middle.x() <= 0 || std::abs(middle.y()) >= reach_m + zone_.aside_m) return kNever_m;
    return way_to_point_m(middle, reach_m);
  }

  /// The same for the part of the edge from a to b that is ahead of the base's center and not too
  /// far to the side. All are meters ahead and to the left of the base's center.
  double way_to_edge_m(const Vector2d& a, const Vector2d& b) const {
    const Vector2d d = b - a;
    double from = 0, to = 1;
    const auto keep_positive = [&](double at_a, double change) {
      if (change == 0 && at_a <= 0) to = -1;
      if (change > 0) from = std::max(from, -at_a / change);
      if (change < 0) to = std::min(to, -at_a / change);
    };
    const double half_m = radius_m_ + zone_.aside_m;
    keep_positive(a.x(), d.x());
    keep_positive(half_m - a.y(), -d.y());
    keep_positive(half_m + a.y(), d.y());
    if (from >= to) return kNever_m;
    const auto way_m = [&](double t) {
      return way_to_point_m(a + std::clamp(t, from, to) * d, radius_m_);
    };
    double nearest_m = std::min(way_m(from), way_m(to));
    if (d.y() == 0) return nearest_m;
    // Where the edge leaves the shell's width, and where it is tangent to the shell.
    const double slant = d.x() / d.y();
    for (const double aside_m :
         {-radius_m_, radius_m_, -radius_m_ * slant / std::sqrt(1 + slant * slant)})
      nearest_m = std::min(nearest_m, way_m((aside_m - a.y()) / d.y()));
    return nearest_m;
  }

  std::vector<OutlineEdge> outline_;
  double radius_m_;
  CollisionReflex zone_;
  double brake_m_per_s2_;
  double reach_m_;
};

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
  const int steps_per_frame = static_cast<int>(std::ceil(kStepRate_hz / robot.camera.rate_hz));
  const double step_s = 1.0 / (robot.camera.rate_hz * steps_per_frame);
  PlanarWorld world(scene, robot, script.start_m, script.start_heading_rad, step_s);
  for (const MovingObstacle& other : others) world.add(other);
  check_start(world, scene, script.start_m, file_and_line(script.file, script.start_line));
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
