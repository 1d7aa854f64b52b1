// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/epnp.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/calib3d.hpp>

#include "slam/optimize/minimal_set.hpp"

namespace mh {
namespace {

constexpr std::size_t kMinimal = 4;

std::optional<SE3> solve_epnp(std::span<const PoseObservation> observations,
                              std::span<const std::size_t> used, const Camera& camera) {
  const auto [points, pixels, intrinsics] = correspondences(observations, used, camera);
  cv::Mat rotation, translation;
  try {
    if (!cv::solvePnP(points, pixels, intrinsics, cv::noArray(), rotation, translation, false,
                      cv::SOLVEPNP_EPNP))
      return std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;  // one unlucky choice is no reason to abort the query
  }
  return finite_pose(rotation, translation);
}

}  // namespace

void for_each_epnp_consensus(std::span<const PoseObservation> observations, const Camera& camera,
                             const RansacConfig& config, const PoseConfig& pose,
                             RandomStream stream,
                             const std::function<bool(const PoseEstimate&)>& accept) {
  const auto count = static_cast<int>(observations.size());
  const int needed = std::max({config.min_inliers, count / 2, static_cast<int>(kMinimal)});
  if (count < needed) return;
  const auto judged = [&](const SE3& camera_from_world) {
    PoseEstimate estimate{.camera_from_world = camera_from_world, .inlier = {}};
    estimate.inlier_count =
        find_inliers(observations, camera_from_world, camera, pose, estimate.inlier);
    return estimate;
  };
  PoseEstimate best;
  const double share = std::max(0.5, static_cast<double>(needed) / count);
  const int limit = std::max(1, iterations_needed(share, config));
  for (int iteration = 0; iteration < limit; ++iteration) {
    const auto guess = solve_epnp(
        observations, draw_different<kMinimal>(stream, iteration, observations.size()), camera);
    if (!guess) continue;
    PoseEstimate estimate = judged(*guess);
    if (estimate.inlier_count < needed) continue;
    if (estimate.inlier_count > best.inlier_count) best = std::move(estimate);
    std::vector<std::size_t> inliers;
    for (std::size_t i = 0; i < observations.size(); ++i)
      if (best.inlier[i] != 0) inliers.push_back(i);
    const auto again = solve_epnp(observations, inliers, camera);
    if (!again) continue;
    const PoseEstimate refined = judged(*again);
    if (refined.inlier_count > needed && accept(refined)) return;
  }
  if (best.inlier_count >= needed) accept(best);
}

}  // namespace mh
