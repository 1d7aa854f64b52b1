// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/alignment.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <limits>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace mh {
namespace {

/// Index of the pose whose stamp is nearest, the earlier of two equally near.
std::size_t nearest(const Trajectory& trajectory, Stamp stamp_ns) {
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), stamp_ns,
                       [](const TimedPose& pose, Stamp value) { return pose.stamp_ns < value; });
  const auto index = static_cast<std::size_t>(after - trajectory.begin());
  if (index == 0) return 0;
  if (index == trajectory.size()) return index - 1;
  const Stamp before_ns = stamp_ns - trajectory[index - 1].stamp_ns;
  const Stamp after_ns = trajectory[index].stamp_ns - stamp_ns;
  return before_ns <= after_ns ? index - 1 : index;
}

struct IndexPair {
  std::size_t shorter = 0;
  std::size_t longer = 0;
  Stamp difference_ns = 0;
};

std::vector<IndexPair> pair_up(const Trajectory& shorter, const Trajectory& longer,
                               Stamp max_difference_ns) {
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const std::size_t j = nearest(longer, shorter[i].stamp_ns);
    const Stamp difference_ns = std::abs(longer[j].stamp_ns - shorter[i].stamp_ns);
    if (difference_ns > max_difference_ns) continue;
    // Stamps increase in both trajectories, so poses that compete for the same pose are
    // consecutive.
    if (pairs.empty() || pairs.back().longer != j)
      pairs.push_back({i, j, difference_ns});
    else if (difference_ns < pairs.back().difference_ns)
      pairs.back() = {i, j, difference_ns};
  }
  return pairs;
}

std::vector<Eigen::Vector3d> positions(const Trajectory& trajectory) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(trajectory.size());
  for (const TimedPose& pose : trajectory) result.push_back(pose.world_from_camera.translation());
  return result;
}

Eigen::Vector3d center_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

MatchedTrajectories match_by_stamp(const Trajectory& truth, const Trajectory& estimate,
                                   Stamp max_difference_ns) {
  MatchedTrajectories matched;
  if (truth.empty() || estimate.empty()) return matched;
  const bool truth_is_shorter = truth.size() < estimate.size();
  const Trajectory& shorter = truth_is_shorter ? truth : estimate;
  const Trajectory& longer = truth_is_shorter ? estimate : truth;
  for (const IndexPair& pair : pair_up(shorter, longer, max_difference_ns)) {
    matched.truth.push_back(truth[truth_is_shorter ? pair.shorter : pair.longer]);
    matched.estimate.push_back(estimate[truth_is_shorter ? pair.longer : pair.shorter]);
  }
  return matched;
}

std::optional<Similarity> umeyama(std::span<const Eigen::Vector3d> source,
                                  std::span<const Eigen::Vector3d> target, bool with_scale) {
  assert(source.size() == target.size());
  if (source.empty()) return std::nullopt;
  const auto count = static_cast<double>(source.size());
  const Eigen::Vector3d source_center = center_of(source);  // (34)
  const Eigen::Vector3d target_center = center_of(target);  // (35)
  double source_variance = 0;                               // (36)
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();     // (38)
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector3d s = source[i] - source_center;
    source_variance += s.squaredNorm() / count;
    covariance += (target[i] - target_center) * s.transpose() / count;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d values = svd.singularValues();
  // Rank 2 suffices (the third axis follows from the other two); a second singular value at
  // rounding level does not count.
  const double rounding = std::numeric_limits<double>::epsilon() * std::max(1.0, 16.0 * values[0]);
  if (!(values[1] > rounding)) return std::nullopt;

  Eigen::Vector3d sign = Eigen::Vector3d::Ones();  // (43)
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
  Similarity result;
  result.rotation = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();          // (40)
  if (with_scale) result.scale = values.dot(sign) / source_variance;                        // (42)
  result.translation_m = target_center - result.scale * (result.rotation * source_center);  // (41)
  return result;
}

std::optional<Similarity> align(const MatchedTrajectories& matched, Alignment alignment) {
  if (matched.size() == 0) return std::nullopt;
  if (alignment == Alignment::kNone) return Similarity{};
  if (alignment == Alignment::kOrigin) {
    const SE3 truth_from_estimate = matched.truth.front().world_from_camera *
                                    matched.estimate.front().world_from_camera.inverse();
    return Similarity{.rotation = truth_from_estimate.rotation(),
                      .translation_m = truth_from_estimate.translation()};
  }
  return umeyama(positions(matched.estimate), positions(matched.truth),
                 alignment == Alignment::kSim3);
}

Trajectory transformed(const Similarity& target_from_source, const Trajectory& trajectory) {
  Trajectory result = trajectory;
  for (TimedPose& pose : result)
    pose.world_from_camera = target_from_source * pose.world_from_camera;
  return result;
}

}  // namespace mh
