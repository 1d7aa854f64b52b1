// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "scenes/load.hpp"
#include "sim/motion/motion.hpp"
#include "sim/motion/path.hpp"
#include "source_dir.hpp"
#include "tests/sim/motion/limits_kept.hpp"

namespace mh {
namespace {

const std::string kRoot = MH_SOURCE_DIR "/";

struct Case {
  const char *scene, *tour, *robot;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.tour;
}

constexpr const char* kPepper = "robots/pepper/pepper.yaml";
constexpr const char* kSmall = "bench/scenarios/robot.yaml";
constexpr const char* kFast = "bench/scenarios/robot_fast.yaml";
constexpr const char* kModelHouse = "scenes/model_house/house.yaml";

/// How far from a waypoint the rounded path passes.
double off_corner_m(const Tour& tour, std::size_t i) {
  const Waypoint& here = tour.waypoints[i];
  if (i + 1 == tour.waypoints.size() || here.turn_rad != 0 || here.pause_s > 0) return 0;
  const Eigen::Vector2d in =
      here.position_m - (i == 0 ? tour.start_m : tour.waypoints[i - 1].position_m);
  const Eigen::Vector2d out = tour.waypoints[i + 1].position_m - here.position_m;
  if (in.norm() < 0.01 || out.norm() < 0.01) return 0;
  const double cut_m = std::min({PathConfig{}.cut_m, 0.5 * in.norm(), 0.5 * out.norm()});
  const double half = 0.5 * std::acos(std::clamp(in.normalized().dot(out.normalized()), -1.0, 1.0));
  if (half < 1e-6 || half > 0.5 * 2.1) return 0;
  return cut_m / std::tan(half) * (1 / std::cos(half) - 1);
}

class TourLimits : public testing::TestWithParam<Case> {};

// Checks the base as moved by Bullet, not as planned.
TEST_P(TourLimits, AreKeptPastEveryWaypointAndClearOfEverything) {
  const Robot robot = load_robot(kRoot + GetParam().robot);
  const Tour tour = load_tour(kRoot + GetParam().tour);
  const DrivenPath path = drive(load_scene(kRoot + GetParam().scene), robot, tour);
  test::expect_limits_kept(path.peaks, robot.limits);
  EXPECT_GT(path.peaks.m_per_s3, 0.5 * *robot.limits.max_jerk_m_per_s3);  // the base did move
  EXPECT_EQ(path.contact_time_s, 0.0);
  std::size_t from = 0;  // waypoints are passed in order
  for (std::size_t i = 0; i < tour.waypoints.size(); ++i) {
    const auto distance_m = [&](std::size_t k) {
      return (path.base[k].world_from_camera.translation().head<2>() - tour.waypoints[i].position_m)
          .norm();
    };
    // The distance allows for the rounding of the corner, for the smoothing, and for half the
    // distance between two frames.
    const double enough_m = off_corner_m(tour, i) + 0.025;
    while (from < path.base.size() && distance_m(from) > enough_m) ++from;
    ASSERT_LT(from, path.base.size()) << "waypoint " << i + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Tours, TourLimits,
    testing::Values(
        Case{kModelHouse, "scenes/model_house/tours/mapping.yaml", kPepper},
        Case{kModelHouse, "scenes/model_house/tours/query.yaml", kPepper},
        Case{"bench/scenarios/corridor.yaml", "bench/scenarios/tours/corridor.yaml", kSmall},
        Case{"bench/scenarios/corridor.yaml", "bench/scenarios/tours/corridor_query.yaml", kSmall},
        Case{"bench/scenarios/room.yaml", "bench/scenarios/tours/fast_turn.yaml", kFast},
        Case{"bench/scenarios/ring.yaml", "bench/scenarios/tours/kidnap_before.yaml", kSmall},
        Case{"bench/scenarios/ring.yaml", "bench/scenarios/tours/kidnap_after.yaml", kSmall},
        Case{"bench/scenarios/ring.yaml", "bench/scenarios/tours/ring.yaml", kSmall},
        Case{"bench/scenarios/ring.yaml", "bench/scenarios/tours/ring_query.yaml", kSmall},
        Case{"bench/scenarios/room.yaml", "bench/scenarios/tours/room.yaml", kSmall},
        Case{"bench/scenarios/room.yaml", "bench/scenarios/tours/room_query.yaml", kSmall},
        Case{"bench/scenarios/room.yaml", "bench/scenarios/tours/room_query.yaml", kFast},
        Case{"bench/scenarios/wooden.yaml", "bench/scenarios/tours/wooden.yaml", kSmall},
        Case{"bench/scenarios/wooden.yaml", "bench/scenarios/tours/wooden_query.yaml", kSmall}));

}  // namespace
}  // namespace mh
