// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "slam/optimize/minimal_set.hpp"
#include "slam/optimize/pose.hpp"

namespace mh {
namespace {

using Triple = std::array<std::size_t, 3>;

/// True if the triangle is so thin, in space or in the image, that P3P has no stable solution:
/// height below a thousandth of its base, or an area of less than one square pixel.
bool is_degenerate(std::span<const PoseObservation> observations, const Triple& triple) {
  const PoseObservation& a = observations[triple[0]];
  const PoseObservation& b = observations[triple[1]];
  const PoseObservation& c = observations[triple[2]];
  const Eigen::Vector3d ab = b.point_in_world - a.point_in_world;
  const Eigen::Vector3d ac = c.point_in_world - a.point_in_world;
  const double base2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ab - ac).squaredNorm()});
  if (!(ab.cross(ac).norm() > 1e-3 * base2)) return true;
  const double area2_px =
      (b.u_px - a.u_px) * (c.v_px - a.v_px) - (b.v_px - a.v_px) * (c.u_px - a.u_px);
  return !(std::abs(area2_px) > 2.0);
}

/// Up to four poses that map three points onto their pixels; empty if the solver finds none.
std::vector<SE3> solve_p3p(std::span<const PoseObservation> observations, const Triple& triple,
                           const Camera& camera) {
  const auto [points, pixels, intrinsics] = correspondences(observations, triple, camera);
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  try {
    cv::solveP3P(points, pixels, intrinsics, cv::noArray(), rotations, translations,
                 cv::SOLVEPNP_AP3P);
  } catch (const cv::Exception&) {
    return {};  // one unlucky triple is no reason to abort the query
  }
  std::vector<SE3> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i)
    if (const auto pose = finite_pose(rotations[i], translations[i])) poses.push_back(*pose);
  return poses;
}

std::vector<PoseObservation> select(std::span<const PoseObservation> observations,
                                    std::span<const std::uint8_t> inlier) {
  std::vector<PoseObservation> selected;
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (inlier[i]) selected.push_back(observations[i]);
  return selected;
}

struct Consensus {
  SE3 camera_from_world;
  std::vector<std::uint8_t> inlier;
  int count = 0;
};

/// Among the poses of random triples, the one with which the most observations agree; ties to the
/// first.
Consensus best_consensus(std::span<const PoseObservation> observations, const Camera& camera,
                         const RansacConfig& config, const PoseConfig& gates, RandomStream stream) {
  Consensus best;
  std::vector<std::uint8_t> inlier;
  int limit = config.max_iterations;
  for (int iteration = 0; iteration < limit; ++iteration) {
    const Triple triple = draw_different<3>(stream, iteration, observations.size());
    if (is_degenerate(observations, triple)) continue;
    for (const SE3& pose : solve_p3p(observations, triple, camera)) {
      const int count = find_inliers(observations, pose, camera, gates, inlier);
      if (count <= best.count) continue;
      best.camera_from_world = pose;
      best.inlier.swap(inlier);
      best.count = count;
    }
    const double share = static_cast<double>(best.count) / static_cast<double>(observations.size());
    limit = std::min(limit, iterations_needed(share, config));
  }
  return best;
}

}  // namespace

std::optional<PoseEstimate> solve_pnp_ransac(std::span<const PoseObservation> observations,
                                             const Camera& camera, const RansacConfig& config,
                                             const PoseConfig& pose, RandomStream stream) {
  PoseConfig gates = pose;
  gates.min_inliers = std::max(config.min_inliers, 4);  // any three points agree with their own P3P
  if (static_cast<int>(observations.size()) < gates.min_inliers) return std::nullopt;

  Consensus best = best_consensus(observations, camera, config, gates, stream);
  if (best.count < 4) return std::nullopt;

  // A pose from three noisy points misses inliers that agree with the refined pose. So each of two
  // passes refines the pose on its inliers and then classifies all observations.
  PoseConfig refine = gates;
  refine.min_inliers = 4;
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<PoseObservation> consensus = select(observations, best.inlier);
    const auto refined = estimate_pose(consensus, best.camera_from_world, camera, refine);
    if (!refined) return std::nullopt;
    best.camera_from_world = refined->camera_from_world;
    best.count = find_inliers(observations, best.camera_from_world, camera, gates, best.inlier);
    if (best.count < 4) return std::nullopt;
  }
  if (best.count < gates.min_inliers) return std::nullopt;
  return PoseEstimate{.camera_from_world = best.camera_from_world,
                      .inlier = std::move(best.inlier),
                      .inlier_count = best.count};
}

}  // namespace mh
