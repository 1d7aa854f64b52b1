// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/local_mapping.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "slam/config/slam.hpp"
#include "slam/core/random.hpp"

namespace mh {
namespace {

const Camera kCamera;

/// Adds a keyframe at x_m that sees these points without noise.
KeyframeId add_view(Map& map, double x_m, const std::vector<Eigen::Vector3d>& points) {
  Keyframe k;
  k.camera_from_world =
      SE3(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(-x_m, 0, 0));
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = k.camera_from_world * point;
    const Eigen::Vector2d pixel = kCamera.project(p);
    Keypoint keypoint;
    keypoint.u_px = static_cast<float>(pixel.x());
    keypoint.v_px = static_cast<float>(pixel.y());
    keypoint.depth_m = static_cast<float>(p.z());
    k.features.keypoints.push_back(keypoint);
  }
  k.features.descriptors.resize(points.size());
  return map.add(std::move(k));
}

std::vector<Eigen::Vector3d> cloud(std::uint64_t seed) {
  const RandomStream draw(seed);
  std::vector<Eigen::Vector3d> points;
  for (std::uint64_t i = 0; i < 40; ++i)
    points.emplace_back(draw.uniform(3 * i, -0.7, 0.9), draw.uniform(3 * i + 1, -0.6, 0.6),
                        draw.uniform(3 * i + 2, 2.0, 4.0));
  return points;
}

struct TwoViews {
  Map map;
  SlamConfig config;
  MatchCounts counts{};
  SlamContext context() { return {kCamera, config, map, counts}; }

  /// @param shared  whether the second view sees the first one's landmarks, or only its own
  explicit TwoViews(bool shared) {
    const std::vector<Eigen::Vector3d> points = cloud(1), others = cloud(2);
    add_view(map, 0, points);
    add_view(map, 0.2, shared ? points : others);
    const Eigen::Vector3d off(0.004, -0.003, 0.01);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const LandmarkId id = map.add_landmark(points[i] + off, KeyframeId{0}, i);
      if (shared)
        map.add_observation(id, KeyframeId{1}, i);
      else
        map.add_landmark(others[i] + off, KeyframeId{1}, i);
    }
    for (const std::uint32_t k : {0, 1}) map.update_covisibility(KeyframeId{k});
  }
};

// Landmarks are added for all close points, including those at the limit, and for the nearest
// points beyond it up to a total of 100.
TEST(AddLandmarksFromDepth, TakesWhatIsCloseAndElseTheNearestHundred) {
  SlamConfig config;
  config.keyframe.close_depth_m = 3;
  MatchCounts counts{};
  const auto taken = [&](int close, int at_the_limit, int beyond, bool one_known = false) {
    Map map;
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < beyond; ++i) points.emplace_back(0.01 * i, 0, 3.5 + 0.01 * i);
    for (int i = 0; i < close; ++i) points.emplace_back(0.01 * i, 0, 2);
    for (int i = 0; i < at_the_limit; ++i) points.emplace_back(0.01 * i, 0, 3);
    points.emplace_back(0.1, 0.1, 1);
    const KeyframeId id = add_view(map, 0.5, points);
    // The last point has lost its depth.
    Keyframe without = map.at(id);
    without.features.keypoints.back().depth_m = 0;
    Map again;
    again.add(std::move(without));
    if (one_known) again.add_landmark({9, 9, 9}, KeyframeId{0}, 0);
    add_landmarks_from_depth(again, KeyframeId{0}, {kCamera, config, again, counts});
    double farthest = 0;
    for (const Landmark& l : again.landmarks()) {
      const std::uint32_t feature = l.observations.front().feature;
      if (one_known && feature == 0) continue;
      EXPECT_LT((l.position_in_world - points[feature]).norm(), 1e-5);
      farthest = std::max(farthest, points[feature].z());
    }
    return std::pair(again.landmark_count(), farthest);
  };
  EXPECT_EQ(taken(150, 30, 40), (std::pair(180, 3.0)));
  EXPECT_EQ(taken(100, 0, 40), (std::pair(100, 2.0)));
  EXPECT_EQ(taken(90, 20, 40), (std::pair(110, 3.0)));
  EXPECT_EQ(taken(99, 0, 40), (std::pair(100, 3.5)));
  EXPECT_EQ(taken(50, 10, 60).first, 100);
  EXPECT_NEAR(taken(50, 10, 60).second, 3.5 + 0.01 * 39, 1e-9) << "the nearest 40 of 60";
  EXPECT_EQ(taken(10, 0, 20).first, 30) << "all there are";
  EXPECT_EQ(taken(50, 10, 60, true).first, 100) << "what has a landmark counts and keeps it";
}

TEST(AdjustNeighborhood, BringsPointsBackThatAKeyframeOutsideHolds) {
  TwoViews views(true);
  const SE3 first = views.map.at(KeyframeId{0}).camera_from_world;
  adjust_neighborhood(views.map, KeyframeId{1}, views.context());
  const std::vector<Eigen::Vector3d> points = cloud(1);
  for (std::uint32_t i = 0; i < points.size(); ++i)
    EXPECT_LT((views.map.at(LandmarkId{i}).position_in_world - points[i]).norm(), 1e-4) << i;
  EXPECT_EQ(views.map.at(KeyframeId{0}).camera_from_world.translation(), first.translation());
  EXPECT_LT(
      (views.map.at(KeyframeId{1}).camera_from_world.translation() - Eigen::Vector3d(-0.2, 0, 0))
          .norm(),
      1e-4);
}

// A keyframe that no other keyframe holds in place would move wherever its points pull it, so it is
// not moved.
TEST(AdjustNeighborhood, MovesNothingThatNoOtherKeyframeHolds) {
  TwoViews views(false);
  const std::uint64_t digest = views.map.digest();
  adjust_neighborhood(views.map, KeyframeId{1}, views.context());
  EXPECT_EQ(views.map.digest(), digest);
}

TEST(AdjustPiece, OfTheFirstKeyframeAloneMovesNothing) {
  Map map;
  SlamConfig config;
  MatchCounts counts{};
  const std::vector<Eigen::Vector3d> points = cloud(1);
  add_view(map, 0, points);
  for (std::uint32_t i = 0; i < points.size(); ++i)
    map.add_landmark(points[i] + Eigen::Vector3d(0.01, 0, 0), KeyframeId{0}, i);
  const std::uint64_t digest = map.digest();
  adjust_piece(map, KeyframeId{0}, {kCamera, config, map, counts});
  EXPECT_EQ(map.digest(), digest);
}

}  // namespace
}  // namespace mh
