// SPDX-License-Identifier: Apache-2.0
#include "slam/track/track.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/config/slam.hpp"
#include "slam/core/random.hpp"
#include "slam/match/expect.hpp"

namespace mh {
namespace {

/// One keyframe at the origin that sees points all over the image, 2 to 4 m away, and the same view
/// again with corner noise of half a pixel and disparity noise from the camera's noise model. The
/// camera has not moved.
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
    // Passing points support the pose, but they do not become landmarks of their features.
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

/// Adds a keyframe that has no landmarks yet, at x_m and rotated by an angle from the z direction.
KeyframeId add_keyframe(Map& map, double x_m, double turn_rad = 0) {
  Keyframe keyframe;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  keyframe.camera_from_world = SE3(turn, Eigen::Vector3d(x_m, 0, 0)).inverse();
  keyframe.features.keypoints.resize(40);
  keyframe.features.descriptors.resize(40);
  return map.add(std::move(keyframe));
}

// No keyframe shares a landmark with the frame, so place and heading decide, both limits included.
// The nearest keyframe comes first; if two are equally near, the earlier one.
TEST(LocalMap, HoldsTheKeyframesThatStandNearAndLookAlike) {
  const Camera camera;
  SlamConfig config;
  config.track.near_distance_m = 1;
  config.track.near_angle_rad = 0.5;
  Map map;
  add_keyframe(map, 0.75);
  add_keyframe(map, -0.5);
  add_keyframe(map, 1);
  add_keyframe(map, 1 + 1e-9);
  add_keyframe(map, 0.25, 0.5 - 1e-6);
  add_keyframe(map, 0.3, 0.5 + 1e-6);
  add_keyframe(map, -0.75);
  map.erase(add_keyframe(map, 0.1));
  MatchCounts counts{};
  const LocalMap local = local_map({SE3(), {}}, KeyframeId{0}, {camera, config, map, counts});
  EXPECT_EQ(local.keyframes, (std::vector{KeyframeId{4}, KeyframeId{1}, KeyframeId{0},
                                          KeyframeId{6}, KeyframeId{2}}));
  EXPECT_TRUE(local.landmarks.empty());
}

// Keyframes that share landmarks with the frame fill at most half of the local map, those that
// share the most first. Keyframes nearby fill it up to three quarters, and neighbors fill the rest.
TEST(LocalMap, HasAQuarterForEachThatDoesNotShareWithTheFrame) {
  const Camera camera;
  SlamConfig config;
  config.track.local_keyframes = 4;
  Map map;
  const KeyframeId near = add_keyframe(map, 0.2), nearer = add_keyframe(map, 0.1);
  const KeyframeId one = add_keyframe(map, 100), three = add_keyframe(map, 101),
                   two = add_keyframe(map, 102), neighbor = add_keyframe(map, 103);
  TrackedPose tracked{SE3(), std::vector<LandmarkId>(10)};
  std::uint32_t feature = 0;
  for (const auto& [keyframe, shared] : {std::pair(one, 1), {three, 3}, {two, 2}})
    for (int i = 0; i < shared; ++i, ++feature)
      tracked.landmarks[feature] = map.add_landmark({0, 0, 2}, keyframe, feature);
  for (std::uint32_t i = 10; i < 26; ++i)
    map.add_observation(map.add_landmark({0, 0, 3}, three, i), neighbor, i);
  map.update_covisibility(three);
  MatchCounts counts{};
  const LocalMap local = local_map(tracked, KeyframeId{0}, {camera, config, map, counts});
  EXPECT_EQ(local.keyframes, (std::vector{three, two, nearer, neighbor}));
  EXPECT_EQ(local.landmarks.size(), 3u + 16u + 2u) << "each once, though two see it";
  config.track.local_keyframes = 100;
  EXPECT_EQ(local_map(tracked, KeyframeId{0}, {camera, config, map, counts}).keyframes,
            (std::vector{three, two, one, nearer, near, neighbor}));
  EXPECT_EQ(reference_of(tracked, map), three);
  EXPECT_FALSE(reference_of({SE3(), {}}, map).valid());
}

TEST(ReferenceOf, OfEqualsIsTheEarliest) {
  Map map;
  const KeyframeId first = add_keyframe(map, 0), second = add_keyframe(map, 1);
  TrackedPose tracked{SE3(), {map.add_landmark({0, 0, 2}, second, 0)}};
  EXPECT_EQ(reference_of(tracked, map), second);
  tracked.landmarks.push_back(map.add_landmark({0, 0, 2}, first, 0));
  EXPECT_EQ(reference_of(tracked, map), first);
}

}  // namespace
}  // namespace mh
