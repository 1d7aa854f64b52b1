// SPDX-License-Identifier: Apache-2.0
#include "slam/track/track.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/config/slam.hpp"
#include "slam/core/random.hpp"
#include "slam/match/expect.hpp"

namespace mh {
namespace {

/// One keyframe at the origin that sees points behind the whole picture, 2 to 4 m away, and the
/// same view again with corners out of place by half a pixel and disparity as far as the camera's
/// noise model says. The camera has not moved.
struct View {
  Camera camera;
  SlamConfig config;
  Map map;
  Features features;
  std::vector<LandmarkId> landmarks;  // per feature

  explicit View(std::uint64_t seed, int count = 400) {
    Keyframe keyframe;
    const RandomStream random(seed);
    for (int i = 0; i < count; ++i) {
      const RandomStream draw = random.fork(static_cast<std::uint64_t>(i));
      Keypoint exact;
      exact.u_px = static_cast<float>(draw.uniform(0, 5, camera.width_px - 5));
      exact.v_px = static_cast<float>(draw.uniform(1, 5, camera.height_px - 5));
      exact.depth_m = static_cast<float>(draw.uniform(2, 2, 4));
      keyframe.features.keypoints.push_back(exact);
      Keypoint noisy = exact;
      noisy.u_px += static_cast<float>(0.5 * draw.normal(3));
      noisy.v_px += static_cast<float>(0.5 * draw.normal(4));
      noisy.depth_m += static_cast<float>(0.002 * exact.depth_m * exact.depth_m * draw.normal(5));
      features.keypoints.push_back(noisy);
    }
    keyframe.features.descriptors.resize(keyframe.features.keypoints.size());
    features.descriptors.resize(features.keypoints.size());
    const Features seen = keyframe.features;
    const KeyframeId id = map.add(std::move(keyframe));
    for (std::uint32_t i = 0; i < seen.size(); ++i)
      landmarks.push_back(map.add_landmark(place(seen.keypoints[i]), id, i));
  }

  SlamContext context() const { return {camera, config, map, counts}; }
  mutable MatchCounts counts{};

  Eigen::Vector3d place(const Keypoint& keypoint) const {
    return unproject(keypoint, camera, SE3());
  }

  /// Landmarks of the features left of a column; the others have none.
  std::vector<LandmarkId> landmarks_left_of(double u_px) const {
    std::vector<LandmarkId> left = landmarks;
    for (std::size_t i = 0; i < left.size(); ++i)
      if (features.keypoints[i].u_px >= u_px) left[i] = {};
    return left;
  }
};

TEST(OptimizeMatches, PassingPointsHoldAPoseThatANarrowStripOfLandmarksLetsSlip) {
  const double kStrip_px = 60;
  double alone_m = 0, together_m = 0;
  constexpr int kViews = 20;
  for (std::uint64_t seed = 0; seed < kViews; ++seed) {
    const View view(seed);
    const FeatureGrid grid(view.features.keypoints, view.camera);
    const WordIndex words;
    const Query query{view.features, grid, words};
    const auto strip = view.landmarks_left_of(kStrip_px);
    std::vector<PassingPoint> passing;
    for (std::uint32_t i = 0; i < view.features.size(); ++i)
      passing.push_back({i, view.map.at(view.landmarks[i]).position_in_world});

    const auto pose_with = [&](std::span<const PassingPoint> points) {
      return optimize_matches(query, strip, points, SE3(), view.context());
    };
    const auto alone = pose_with({}), together = pose_with(passing);
    ASSERT_TRUE(alone && together);
    alone_m += alone->camera_from_world.translation().norm() / kViews;
    together_m += together->camera_from_world.translation().norm() / kViews;
    // They support the pose, but are no landmarks.
    for (std::size_t i = 0; i < strip.size(); ++i)
      if (!strip[i].valid()) {
        EXPECT_FALSE(together->landmarks[i].valid());
      }
    EXPECT_NEAR(together->inliers, alone->inliers, 6);
  }
  EXPECT_LT(together_m, 0.25 * alone_m) << alone_m;
}

TEST(OptimizeMatches, APassingPointGivesWayToTheLandmarkOfItsFeature) {
  const View view(1);
  const FeatureGrid grid(view.features.keypoints, view.camera);
  const WordIndex words;
  const Query query{view.features, grid, words};
  const std::vector<PassingPoint> misplaced = {{0, {100, 100, 1}}};
  const auto without = optimize_matches(query, view.landmarks, {}, SE3(), view.context());
  const auto with = optimize_matches(query, view.landmarks, misplaced, SE3(), view.context());
  ASSERT_TRUE(without && with);
  EXPECT_EQ(with->camera_from_world.translation(), without->camera_from_world.translation());
}

}  // namespace
}  // namespace mh
