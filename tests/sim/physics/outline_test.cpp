// SPDX-License-Identifier: Apache-2.0
#include "sim/physics/outline.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "scenes/band.hpp"
#include "scenes/load.hpp"
#include "sim/motion/floor_grid.hpp"
#include "sim/physics/planar_world.hpp"
#include "slam/core/random.hpp"
#include "source_dir.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

double length_m(const std::vector<OutlineEdge>& outline) {
  double sum = 0;
  for (const OutlineEdge& edge : outline) sum += (edge.b_m - edge.a_m).norm();
  return sum;
}

TEST(Outline, OfABoxIsItsRectangle) {
  Scene scene;
  test::add_box(scene, "box", {1, 2, 0.1F}, {4, 3, 0.5F});
  const auto outline = floor_outline(scene, 0.03F, 1.2F);
  ASSERT_EQ(outline.size(),
            4u);  // no diagonals, and no duplicates although four faces meet at each edge
  EXPECT_FLOAT_EQ(length_m(outline), 8);
  EXPECT_EQ(outline[0].instance, 1);
  EXPECT_TRUE(floor_outline(scene, 0.6F, 1.2F).empty());
}

TEST(Outline, LeavesOutWhatIsBetweenTwoFaces) {
  Scene scene;
  test::add_box(scene, "left", {0, 0, 0.1F}, {1, 1, 1});
  test::add_box(scene, "right", {1, 0, 0.1F}, {2, 1, 1});
  EXPECT_FLOAT_EQ(length_m(floor_outline(scene, 0.03F, 1.2F)),
                  6);  // the outline of both boxes together
}

/// Horizontal distance to the nearest face in the range of heights, found by testing each face.
double distance_m(const Scene& scene, float top_m, const Vector2d& p) {
  double least = 1e9;
  for_each_face_in_band(
      scene, static_cast<float>(scene.floor.rough_m), top_m, [&](std::size_t, auto polygon) {
        bool left = true, right = true;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
          const Vector2d
              a = polygon[i].template head<2>().template cast<double>(),
              b = polygon[(i + 1) % polygon.size()].template head<2>().template cast<double>(),
              u = b - a, v = p - a;
          const double t =
              u.squaredNorm() > 0 ? std::clamp(v.dot(u) / u.squaredNorm(), 0.0, 1.0) : 0.0;
          least = std::min(least, (v - t * u).norm());
          const double side = u.x() * v.y() - u.y() * v.x();
          left = left && side > 0;
          right = right && side < 0;
        }
        if (left || right) least = 0;  // the point is below or above the face
      });
  return least;
}

TEST(PlanarWorld, DrivesIntoFurnitureStayShallow) {
  const Scene house = load_scene(MH_SOURCE_DIR "/scenes/model_house/house.yaml");
  const Robot robot = test::pepper();
  const FloorGrid grid = make_floor_grid(house, {.top_m = robot.height_m});
  const auto region = largest_region(grid, robot.footprint_radius_m + 0.02);
  std::vector<Vector2d> starts;
  for (int y = 0; y < region.height(); ++y)
    for (int x = 0; x < region.width(); ++x)
      if (region(x, y) != 0) starts.push_back(grid.center_of({x, y}));
  ASSERT_FALSE(starts.empty());
  PlanarWorld world(house, robot, starts[0], 0);
  const RandomStream draw(11);
  int hits = 0, checked = 0;
  double deepest_m = 0;
  for (std::uint64_t d = 0; d < 1000; ++d) {
    const double heading = draw.uniform(3 * d, -M_PI, M_PI);
    world.place(starts[draw.below(3 * d + 1, starts.size())], heading);
    Contact contact;
    for (int i = 0; i < 480; ++i) {
      contact =
          world.step({.velocity_m_per_s = 0.55 * Vector2d(std::cos(heading), std::sin(heading)),
                      .turn_rad_per_s = draw.uniform(3 * d + 2, -1, 1)});
      deepest_m = std::max(deepest_m, contact.penetration_m);
    }
    if (!contact.touching) continue;
    ++hits;
    if (hits % 10 != 0) continue;
    ++checked;
    EXPECT_NEAR(distance_m(house, static_cast<float>(robot.height_m), world.state().position_m),
                robot.footprint_radius_m, 2e-3)
        << "drive " << d;
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(checked, 30);
  EXPECT_LE(deepest_m, 5e-3);  // 0.2 mm was measured
}

}  // namespace
}  // namespace mh
