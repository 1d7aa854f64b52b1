// SPDX-License-Identifier: Apache-2.0
// physics_benchmark SCENE ROBOT [DRIVES]: the robot drives randomly into furniture, colliding with
// the whole mesh of a scene. Prints how much faster than real time the physics ran, the deepest
// penetration, the base's peak motion outside contacts, and whether a second run gave the same
// bits.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "robots/model/wheel_base.hpp"
#include "scenes/floor.hpp"
#include "scenes/load.hpp"
#include "sim/motion/floor_grid.hpp"
#include "sim/motion/motors.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/core/random.hpp"

namespace {

using namespace mh;

constexpr double kDrive_s = 4.0;
constexpr double kStep_s = 1.0 / 240;

struct Outcome {
  double simulated_s = 0, contact_s = 0, deepest_m = 0;
  int with_contact = 0;
  double speed = 0, acceleration = 0, jerk = 0;  // of the base in Bullet, outside contacts
  std::vector<double> ends;                      // where each drive ended
};

Outcome drive_about(PlanarWorld& world, const Robot& robot,
                    const std::vector<Eigen::Vector2d>& starts, int drives) {
  Outcome outcome;
  const RandomStream draw(5);
  for (int d = 0; d < drives; ++d) {
    const auto k = static_cast<std::uint64_t>(d);
    const double heading = draw.uniform(4 * k + 1, -M_PI, M_PI);
    world.place(starts[draw.below(4 * k, starts.size())], heading);
    JerkLimiter limiter(commandable(robot.limits), kStep_s, robot.wheels());
    const Motors motors(robot.differential());
    const JerkLimiter::Velocity command = motors.commanded(
        robot.limits.max_velocity_m_per_s * Eigen::Vector2d(std::cos(heading), std::sin(heading)),
        draw.uniform(4 * k + 2, -1.0, 1.0), heading);
    Eigen::Vector2d v_before = Eigen::Vector2d::Zero(), a_before = v_before;
    bool touched = false;
    for (int i = 0; i < static_cast<int>(kDrive_s / kStep_s); ++i) {
      const JerkLimiter::Velocity next = limiter.step(command);
      const Contact contact =
          world.step(motors.over_floor(next, world.state().heading_rad, kStep_s));
      outcome.deepest_m = std::max(outcome.deepest_m, contact.penetration_m);
      const BaseState state = world.state();
      if (contact.touching) {
        outcome.contact_s += kStep_s;
        touched = true;
        limiter.stopped_at({state.velocity_m_per_s, state.turn_rad_per_s});
      }
      if (!touched) {
        const Eigen::Vector2d a = (state.velocity_m_per_s - v_before) / kStep_s;
        outcome.speed = std::max(outcome.speed, state.velocity_m_per_s.norm());
        outcome.acceleration = std::max(outcome.acceleration, a.norm());
        outcome.jerk = std::max(outcome.jerk, (a - a_before).norm() / kStep_s);
        v_before = state.velocity_m_per_s;
        a_before = a;
      }
    }
    outcome.with_contact += touched;
    outcome.simulated_s += kDrive_s;
    const BaseState end = world.state();
    for (const double v : {end.position_m.x(), end.position_m.y(), end.heading_rad})
      outcome.ends.push_back(v);
  }
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: physics_benchmark SCENE ROBOT [DRIVES]\n");
    return 2;
  }
  const Scene loaded = load_scene(argv[1]);
  const LevelScene level(loaded);
  const Scene& scene = *level;
  const Robot robot = load_robot(argv[2]);
  const int drives = argc > 3 ? std::atoi(argv[3]) : 1000;
  const FloorGrid grid = make_floor_grid(scene, {.top_m = robot.height_m});
  const auto region = largest_region(grid, robot.footprint_radius_m + 0.02);
  std::vector<Eigen::Vector2d> starts;
  for (int y = 0; y < region.height(); ++y)
    for (int x = 0; x < region.width(); ++x)
      if (region(x, y) != 0) starts.push_back(grid.center_of({x, y}));
  if (starts.empty()) {
    fmt::print(stderr, "the robot fits nowhere\n");
    return 2;
  }
  const auto run = [&] {
    PlanarWorld world(scene, robot, starts[0], 0.0, kStep_s);
    const auto start = std::chrono::steady_clock::now();
    Outcome outcome = drive_about(world, robot, starts, drives);
    const double wall_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::pair{std::move(outcome), wall_s};
  };
  const auto [first, wall_s] = run();
  const auto [second, again_s] = run();
  const bool same =
      first.ends.size() == second.ends.size() &&
      std::memcmp(first.ends.data(), second.ends.data(), first.ends.size() * sizeof(double)) == 0;
  fmt::print("{}: {} triangles, {} drives of {} s, {} of them into something ({:.0f} s touching)\n",
             scene.name, scene.triangles.size(), drives, kDrive_s, first.with_contact,
             first.contact_s);
  fmt::print("times real time          {:.0f}, {:.0f}\n", first.simulated_s / wall_s,
             second.simulated_s / again_s);
  fmt::print("deepest penetration      {:.2f} mm\n", 1e3 * first.deepest_m);
  const BaseLimits& l = robot.limits;
  fmt::print("fastest                  {:.4f} of {} m/s\n", first.speed, l.max_velocity_m_per_s);
  fmt::print("hardest acceleration     {:.4f} of {} m/s2\n", first.acceleration,
             l.max_acceleration_m_per_s2);
  if (l.max_jerk_m_per_s3)
    fmt::print("highest jerk             {:.3f} of {} m/s3\n", first.jerk, *l.max_jerk_m_per_s3);
  fmt::print("second run               {}\n", same ? "the same bits" : "DIFFERS");
  return same ? 0 : 1;
}
