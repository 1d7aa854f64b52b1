// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/depth_trust.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "synthetic.hpp"

namespace mh {
namespace {

constexpr int kSeenPoints = 200;

/// Adds white noise to pixels (with their sigma) and to disparities.
std::vector<PoseObservation> with_white_errors(const SE3& pose, const Camera& camera,
                                               double disparity_sigma_px, RandomStream stream) {
  auto seen = testing::observe(kSeenPoints, pose, camera, stream.fork(0));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const RandomStream s = stream.fork(1).fork(i);
    seen[i].u_px += seen[i].sigma_px * s.normal(0);
    seen[i].v_px += seen[i].sigma_px * s.normal(1);
    if (seen[i].disparity_px >= 0)
      seen[i].disparity_px += disparity_sigma_px * seen[i].sigma_px * s.normal(2);
  }
  return seen;
}

/// Makes disparities wrong by up to `by_px`, depending on the position in the image.
void bend(std::vector<PoseObservation>& seen, const Camera& camera, double by_px) {
  for (PoseObservation& o : seen) {
    if (o.disparity_px < 0) continue;
    const double x = 2 * o.u_px / camera.width_px - 1, y = 2 * o.v_px / camera.height_px - 1;
    o.disparity_px += by_px * (x * x + y * y - 0.5 + 0.5 * x);
  }
}

/// Gates that keep every observation: which ones fit is not tested here.
PoseConfig open_gates() {
  PoseConfig config;
  config.chi2_mono = config.chi2_stereo = 1e9;
  return config;
}

double disagreement_of(const std::vector<PoseObservation>& seen, const SE3& near,
                       const Camera& camera) {
  const auto estimate = estimate_pose(seen, near, camera, open_gates());
  EXPECT_TRUE(estimate);
  return depth_disagreement(seen, estimate->camera_from_world, camera).value();
}

/// The sigma learned from frames whose disparities have independent errors of `disparity_sigma_px`
/// and correlated errors of up to `bent_px`.
double learned_from(int frames, double disparity_sigma_px, double bent_px = 0) {
  Camera camera;
  const SE3 pose = testing::true_pose();
  for (int i = 0; i < frames; ++i) {
    auto seen = with_white_errors(pose, camera, disparity_sigma_px,
                                  RandomStream(7).fork(static_cast<std::uint64_t>(i)));
    bend(seen, camera, bent_px);
    camera.disparity_sigma_px = learned_disparity_sigma_px(camera.disparity_sigma_px, i,
                                                           disagreement_of(seen, pose, camera));
  }
  return camera.disparity_sigma_px;
}

TEST(DepthDisagreement, IsChiSquareOverItsQuartileIfErrorsAreWhite) {
  Camera camera;
  camera.disparity_sigma_px = 0.5;
  const SE3 pose = testing::true_pose();
  int below = 0;
  double sum = 0;
  constexpr int kFrames = 1000;
  for (int i = 0; i < kFrames; ++i) {
    const auto seen =
        with_white_errors(pose, camera, 0.5, RandomStream(3).fork(static_cast<std::uint64_t>(i)));
    const double d = disagreement_of(seen, pose, camera);
    below += d < 1;
    sum += d;
  }
  EXPECT_NEAR(below / double(kFrames), 0.25, 0.04);  // three standard deviations
  EXPECT_NEAR(sum / kFrames * 1.2125, 3, 0.25);      // mean of the chi-square distribution
}

TEST(DepthDisagreement, NeedsDepth) {
  const Camera camera;
  auto seen = testing::observe(60, testing::true_pose(), camera, RandomStream(1));
  EXPECT_TRUE(depth_disagreement(seen, testing::true_pose(), camera));  // 40 have depth
  seen.resize(44);                                                      // 29 have depth
  EXPECT_FALSE(depth_disagreement(seen, testing::true_pose(), camera));
}

TEST(LearnedDisparitySigma, IsThatOfWhiteErrors) {
  for (const double sigma_px : {0.1, 0.5, 2.0})
    EXPECT_NEAR(std::log(learned_from(1000, sigma_px) / sigma_px), 0, 0.15) << sigma_px;
}

// Independent errors of 0.1 px and correlated ones of up to 0.5 px: only 0.3 px in a single
// reading, but the pose suffers from all of the correlated part.
TEST(LearnedDisparitySigma, IsLargerIfErrorsAreAlike) {
  EXPECT_GT(learned_from(400, 0.1, 0.5), 0.8);
}

}  // namespace
}  // namespace mh
