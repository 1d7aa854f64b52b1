// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include <opencv2/core.hpp>

#include "slam/optimize/pose.hpp"

namespace mh {

// What RANSAC needs for any of OpenCV's minimal solvers.

/// Draws N different indices below `count` for one iteration. @pre count >= N
template <std::size_t N>
std::array<std::size_t, N> draw_different(RandomStream stream, int iteration, std::size_t count) {
  std::array<std::size_t, N> drawn{}, taken{};  // `taken` is ordered
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t next = stream.below(static_cast<std::uint64_t>(iteration) * N + k, count - k);
    std::size_t place = 0;
    for (; place < k && next >= taken[place]; ++place) ++next;
    for (std::size_t t = k; t > place; --t) taken[t] = taken[t - 1];
    drawn[k] = taken[place] = next;
  }
  return drawn;
}

/// Observations in the form that OpenCV's solvers take.
struct Correspondences {
  cv::Mat points, pixels;
  cv::Matx33d intrinsics;
};
inline Correspondences correspondences(std::span<const PoseObservation> observations,
                                       std::span<const std::size_t> used, const Camera& camera) {
  const auto rows = static_cast<int>(used.size());
  Correspondences c{
      cv::Mat(rows, 3, CV_64F), cv::Mat(rows, 2, CV_64F),
      cv::Matx33d(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1)};
  for (int row = 0; row < rows; ++row) {
    const PoseObservation& o = observations[used[static_cast<std::size_t>(row)]];
    for (int k = 0; k < 3; ++k) c.points.at<double>(row, k) = o.point_in_world[k];
    c.pixels.at<double>(row, 0) = o.u_px;
    c.pixels.at<double>(row, 1) = o.v_px;
  }
  return c;
}

/// The pose given by OpenCV's rotation and translation vectors; nullopt if they are not finite.
inline std::optional<SE3> finite_pose(const cv::Mat& rotation, const cv::Mat& translation) {
  const Eigen::Vector3d r(rotation.ptr<double>());
  const Eigen::Vector3d t(translation.ptr<double>());
  if (!r.allFinite() || !t.allFinite()) return std::nullopt;
  return SE3(so3_exp(r), t);
}

/// Number of iterations needed to draw three observations without an outlier at least once, with
/// the given confidence (Fischler and Bolles 1981), capped at max_iterations.
/// @param share  of observations that are inliers
inline int iterations_needed(double share, const RansacConfig& config) {
  const double miss = 1.0 - share * share * share;
  if (miss <= 0.0) return 1;
  if (miss >= 1.0) return config.max_iterations;
  const double needed = std::ceil(std::log(1.0 - config.confidence) / std::log(miss));
  return static_cast<int>(std::min<double>(needed, config.max_iterations));
}

}  // namespace mh
