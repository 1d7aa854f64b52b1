// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/handheld_scan.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "scenes/house/house.hpp"
#include "sim/motion/floor_grid.hpp"
#include "slam/io/error.hpp"
#include "source_dir.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

const Scene& office() {
  static const Scene scene = load_house(MH_SOURCE_DIR "/scenes/rooms/office.yaml");
  return scene;
}

double percentile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

struct Speeds {
  std::vector<double> linear_m_per_s, angular_deg_per_s;
};

void add_speeds(Speeds& speeds, const DrivenPath& path, double rate_hz) {
  for (std::size_t i = 1; i < path.camera.size(); ++i) {
    const SE3 &a = path.camera[i - 1].world_from_camera, &b = path.camera[i].world_from_camera;
    speeds.linear_m_per_s.push_back((b.translation() - a.translation()).norm() * rate_hz);
    speeds.angular_deg_per_s.push_back(angle_between_rad(a, b) * rate_hz * 180 / M_PI);
  }
}

TEST(HandheldScan, MovesAsRealCamerasDo) {
  const Camera camera = test::pepper().camera;
  Speeds speeds;
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    add_speeds(speeds, handheld_scan(office(), camera, {.seed = seed, .frames = 1000}),
               camera.rate_hz);
  // redkitchen of 7-Scenes at 30 Hz: 0.035 / 0.133 / 0.222 / 0.303 / 0.423 m/s and 1.8 / 8.1 / 13.4
  // / 18.7 / 26 deg/s. Recordings differ from each other by more than these bounds.
  EXPECT_NEAR(percentile(speeds.linear_m_per_s, 0.25), 0.133, 0.06);
  EXPECT_NEAR(percentile(speeds.linear_m_per_s, 0.5), 0.222, 0.06);
  EXPECT_NEAR(percentile(speeds.linear_m_per_s, 0.75), 0.303, 0.08);
  EXPECT_LT(percentile(speeds.linear_m_per_s, 0.95), 0.55);
  EXPECT_NEAR(percentile(speeds.angular_deg_per_s, 0.25), 8.1, 4);
  EXPECT_NEAR(percentile(speeds.angular_deg_per_s, 0.5), 13.4, 5);
  EXPECT_NEAR(percentile(speeds.angular_deg_per_s, 0.75), 18.7, 8);
  // The camera turns as fast as in TUM's fr1/rpy.
  const double top = percentile(speeds.angular_deg_per_s, 1.0);
  EXPECT_GT(top, 60);
  EXPECT_LT(top, 150);
}

TEST(HandheldScan, KeepsClearAndSeesTheWholeRoom) {
  const Camera camera = test::pepper().camera;
  const FloorGrid grid = make_floor_grid(office(), {.top_m = 1.9});
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const DrivenPath path = handheld_scan(office(), camera, {.seed = seed});
    EXPECT_GE(path.camera.size(), 300U);
    EXPECT_LE(path.camera.size(), 1500U);
    ASSERT_EQ(path.base.size(), path.camera.size());
    std::set<long> quarters;
    for (const TimedPose& pose : path.camera) {
      const Eigen::Vector3d p = pose.world_from_camera.translation();
      EXPECT_GE(grid.clearance_at(p.head<2>()), 0.1) << p.transpose();
      EXPECT_NEAR(p.z(), 1.4, 0.2);
      const Eigen::Vector3d ahead = pose.world_from_camera.rotation().col(2);
      // The left edge, the middle and the right edge of the image.
      const double half_view_rad = std::atan(0.5 * camera.width_px / camera.fx_px);
      for (const double aside_rad : {-half_view_rad, 0.0, half_view_rad})
        quarters.insert(std::lround((std::atan2(ahead.y(), ahead.x()) + aside_rad) / M_PI_2 + 8) %
                        4);
      EXPECT_LT(std::abs(ahead.z()), 0.75);
    }
    EXPECT_EQ(quarters.size(), 4U);
  }
}

// In a bare hall with a table in its center, a camera with random headings would have the table's
// center in view in a sixth of the frames (the field of view is 58 degrees).
TEST(HandheldScan, LooksAtFurnitureRatherThanAtBareWalls) {
  const Camera camera = test::pepper().camera;
  const double half_view_rad = std::atan(0.5 * camera.width_px / camera.fx_px);
  const auto frames_with_the_table = [&](const char* kind) {
    Scene hall = test::empty_room();
    test::add_box(hall, "in the middle", {4.4F, 4.4F, 0}, {5.6F, 5.6F, 0.8F});
    hall.instances.back().class_id = class_by_name(kind).value();
    double seen = 0, tilt_rad = 0, count = 0;
    for (std::uint64_t seed = 0; seed < 4; ++seed)
      for (const TimedPose& pose : handheld_scan(hall, camera, {.seed = seed}).camera) {
        const Eigen::Vector3d ahead = pose.world_from_camera.rotation().col(2);
        const Eigen::Vector3d way = Eigen::Vector3d(5, 5, 0) - pose.world_from_camera.translation();
        const double aside_rad = std::remainder(
            std::atan2(way.y(), way.x()) - std::atan2(ahead.y(), ahead.x()), 2 * M_PI);
        seen += std::abs(aside_rad) < half_view_rad ? 1 : 0;
        tilt_rad -= std::asin(ahead.z());
        ++count;
      }
    EXPECT_GT(tilt_rad / count, 5 * M_PI / 180);
    EXPECT_LT(tilt_rad / count, 35 * M_PI / 180);
    return seen / count;
  };
  const double of_a_table = frames_with_the_table("table");
  EXPECT_GT(of_a_table, 0.22);
  EXPECT_GT(of_a_table, 1.2 * frames_with_the_table("wall"));
}

TEST(HandheldScan, IsAFunctionOfItsSeed) {
  const Camera camera = test::pepper().camera;
  const auto path = [&](std::uint64_t seed) {
    return handheld_scan(office(), camera, {.seed = seed, .frames = 300}).camera;
  };
  const auto a = path(1), b = path(1), c = path(2);
  ASSERT_EQ(a.size(), 300U);
  double apart_m = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].world_from_camera.translation(), b[i].world_from_camera.translation());
    ASSERT_EQ(a[i].world_from_camera.rotation(), b[i].world_from_camera.rotation());
    apart_m += (a[i].world_from_camera.translation() - c[i].world_from_camera.translation()).norm();
  }
  EXPECT_GT(apart_m / 300, 0.5);
}

TEST(HandheldScan, EachPartOfTheMotionHasItsPublishedSize) {
  const Camera camera = test::pepper().camera;
  HandheldConfig still{.frames = 3000};
  still.walking_m_per_s = 0;
  still.wander_rms_rad = still.tremor_rms_rad = still.tremor_rms_m = 0;
  const DrivenPath swaying = handheld_scan(office(), camera, still);
  double mean = 0, square = 0;
  for (const TimedPose& pose : swaying.camera) mean += pose.world_from_camera.translation().x();
  mean /= 3000;
  for (const TimedPose& pose : swaying.camera)
    square += std::pow(pose.world_from_camera.translation().x() - mean, 2);
  EXPECT_NEAR(std::sqrt(square / 3000), 0.005, 0.0005);

  // Tremor only: the root mean square is the configured one.
  still.sway_rms_m = 0;
  still.tremor_rms_m = 0.00025;
  const DrivenPath trembling = handheld_scan(office(), camera, still);
  square = mean = 0;
  for (const TimedPose& pose : trembling.camera) mean += pose.world_from_camera.translation().x();
  mean /= 3000;
  for (const TimedPose& pose : trembling.camera)
    square += std::pow(pose.world_from_camera.translation().x() - mean, 2);
  EXPECT_NEAR(std::sqrt(square / 3000), 0.00025, 0.00003);
}

TEST(HandheldScan, RefusesBadSettingsAndPlacesWithoutRoom) {
  const Camera camera = test::pepper().camera;
  const auto refusal = [&](const Scene& scene, const HandheldConfig& config) -> std::string {
    try {
      handheld_scan(scene, camera, config);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_NE(refusal(office(), {.frames = 3}).find("frames: 3"), std::string::npos);
  EXPECT_NE(refusal(office(), {.height_m = -1}).find("height_m: -1"), std::string::npos);
  Scene full = test::empty_room();
  test::add_box(full, "crate", {0.05F, 0.05F, 0}, {9.95F, 9.95F, 1});
  EXPECT_NE(refusal(full, {}).find("no free floor"), std::string::npos);
  Scene nothing;
  nothing.name = "nothing";
  EXPECT_NE(refusal(nothing, {}).find("no level floor"), std::string::npos);
}

}  // namespace
}  // namespace mh
