// SPDX-License-Identifier: Apache-2.0
#include "slam/optimize/epnp.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/calib3d.hpp>

namespace mh {
namespace {

constexpr std::size_t kMinimal = 4;

/// Indices of observations, different from each other.
std::vector<std::size_t> draw_four(RandomStream stream, int iteration, std::size_t count) {
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < kMinimal; ++k) {
    std::size_t next =
        stream.below(static_cast<std::uint64_t>(iteration) * kMinimal + k, count - k);
    std::vector<std::size_t> taken = drawn;
    std::sort(taken.begin(), taken.end());
    for (const std::size_t t : taken)
      if (next >= t) ++next;
    drawn.push_back(next);
  }
  return drawn;
}

std::optional<SE3> solve_epnp(std::span<const PoseObservation> observations,
                              std::span<const std::size_t> used, const Camera& camera) {
  const auto rows = static_cast<int>(used.size());
  cv::Mat points(rows, 3, CV_64F), pixels(rows, 2, CV_64F);
  for (int row = 0; row < rows; ++row) {
    const PoseObservation& o = observations[used[static_cast<std::size_t>(row)]];
    for (int k = 0; k < 3; ++k) points.at<double>(row, k) = o.point_in_world[k];
    pixels.at<double>(row, 0) = o.u_px;
    pixels.at<double>(row, 1) = o.v_px;
  }
  const cv::Matx33d intrinsics(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0,
                               1);
  cv::Mat rotation, translation;
  try {
    if (!cv::solvePnP(points, pixels, intrinsics, cv::noArray(), rotation, translation, false,
                      cv::SOLVEPNP_EPNP))
      return std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;  // one unlucky choice is no reason to abort the query
  }
  const Eigen::Vector3d r(rotation.ptr<double>());
  const Eigen::Vector3d t(translation.ptr<double>());
  if (!r.allFinite() || !t.allFinite()) return std::nullopt;
  return SE3(so3_exp(r), t);
}

/// As many tries as draw three true observations at once with config.confidence if `needed` of
/// them all are true.
int tries(int needed, std::size_t count, const RansacConfig& config) {
  const double share = std::max(0.5, static_cast<double>(needed) / static_cast<double>(count));
  if (share >= 1) return 1;
  const double wanted =
      std::ceil(std::log(1 - config.confidence) / std::log(1 - share * share * share));
  return static_cast<int>(std::clamp<double>(wanted, 1, config.max_iterations));
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
  const int limit = tries(needed, observations.size(), config);
  for (int iteration = 0; iteration < limit; ++iteration) {
    const auto guess =
        solve_epnp(observations, draw_four(stream, iteration, observations.size()), camera);
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
