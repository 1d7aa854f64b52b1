// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/true_view.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bench/audit/true_map.hpp"
#include "tests/bench/audit/box_room_renderer.hpp"

namespace mh {
namespace {

using testing_support::BoxRoom;
using testing_support::BoxRoomRenderer;

TrueView view_of(const SE3& pose, const Features& features = {}) {
  return look(BoxRoomRenderer(), TrueCamera(BoxRoom::camera()), pose, features);
}

double shared(double heading_rad, double other_rad) {
  return co_visible_share(view_of(BoxRoom::pose(3, 2.5, heading_rad)),
                          view_of(BoxRoom::pose(3, 2.5, other_rad)));
}

TEST(CoVisibleShare, IsOneAtTheSamePose) {
  EXPECT_DOUBLE_EQ(shared(0, 0), 1.0);
  EXPECT_DOUBLE_EQ(shared(0.7, 0.7), 1.0);
}

TEST(CoVisibleShare, IsZeroIfTheOtherIsTurnedAway) {
  EXPECT_DOUBLE_EQ(shared(0, std::numbers::pi), 0.0);
  EXPECT_DOUBLE_EQ(shared(0.3, 0.3 - std::numbers::pi / 2), 0.0) << "the camera sees 58 degrees";
}

// The camera turns about its own center: a column at angle a from the middle of the image is still
// seen if |a + turn| is below half the field of view. Columns are spaced evenly in tan(a).
TEST(CoVisibleShare, OfATurnIsThatOfTheColumnsLeft) {
  const Camera camera = BoxRoom::camera();
  const double turn = 0.25, half = std::atan(159.5 / camera.fx_px);
  const double seen = (std::tan(half) + std::tan(half - turn)) / (2 * std::tan(half));
  // Near the sides, pixels at the top and bottom leave the image, too: they move up or down by a
  // factor of up to 1 / cos(turn).
  EXPECT_NEAR(shared(0, turn), seen, 0.06);
  EXPECT_NEAR(shared(0, -turn), seen, 0.06);
}

// The other view is from the far side of a wall, which hides everything behind it: no point is seen
// in both.
TEST(CoVisibleShare, OfAnotherRoomIsZero) {
  const SE3 pose = BoxRoom::pose(3, 2.5, 0);
  const SE3 beyond(pose.rotation(), pose.translation() + Eigen::Vector3d(100, 0, 0));
  const TrueView there =
      look(BoxRoomRenderer(100), TrueCamera(BoxRoom::camera()), beyond, Features());
  EXPECT_DOUBLE_EQ(co_visible_share(view_of(pose), there), 0.0);
}

TEST(TrueView, AKeypointShowsTheWallBehindIt) {
  Features features;
  features.keypoints.push_back({.u_px = 159.5F, .v_px = 119.5F});
  features.keypoints.push_back({.u_px = 20, .v_px = 30});
  const TrueView view = view_of(BoxRoom::pose(3, 2.5, 0), features);
  ASSERT_TRUE(view.points[0] && view.points[1]);
  EXPECT_NEAR((view.points[0]->in_world - Eigen::Vector3d(6, 2.5, 1.2)).norm(), 0, 0.01);
  EXPECT_NEAR(view.points[0]->depth_m, 3.0, 1e-4);
  EXPECT_NEAR(view.points[1]->in_world.x(), 6.0, 0.02);
}

TEST(SamePlace, IsWithinEightCentimetersOrFourPercentOfDepth) {
  const auto same = [](double depth_m, double apart_m) {
    return same_place({{0, 0, depth_m}, depth_m, false}, {{0, apart_m, depth_m}, 1.0, false});
  };
  EXPECT_TRUE(same(1.0, 0.079));
  EXPECT_FALSE(same(1.0, 0.081));
  EXPECT_TRUE(same(5.0, 0.199));
  EXPECT_FALSE(same(5.0, 0.201));
}

// There is a border between classes every meter along the room: y = 2 is 48 px right of the middle.
TEST(TrueView, FindsBordersOfClasses) {
  Features features;
  for (const float u : {159.5F + 48, 159.5F + 46, 159.5F + 24})
    features.keypoints.push_back({.u_px = u, .v_px = 115});
  const TrueView view = view_of(BoxRoom::pose(3, 2.5, 0), features);
  EXPECT_TRUE(view.points[0]->at_border);
  EXPECT_TRUE(view.points[1]->at_border);
  EXPECT_FALSE(view.points[2]->at_border);
}

TEST(TrueLandmark, IsNotMovedByOneWrongObservation) {
  std::vector<std::optional<TrueView>> views;
  Landmark landmark;
  for (std::uint32_t k = 0; k < 5; ++k) {
    TrueView view = view_of(BoxRoom::pose(3, 2.5, 0));
    const Eigen::Vector3d wrong(0, k == 2 ? 3 : 0, 0);
    view.points = {TruePoint{Eigen::Vector3d(6, 2, 1) + wrong, 3.0, false}};
    views.emplace_back(std::move(view));
    landmark.observations.push_back({KeyframeId{k}, 0});
  }
  EXPECT_TRUE(true_landmark(landmark, views)->in_world.isApprox(Eigen::Vector3d(6, 2, 1)));
  landmark.observations.clear();
  EXPECT_FALSE(true_landmark(landmark, views).has_value());
}

}  // namespace
}  // namespace mh
