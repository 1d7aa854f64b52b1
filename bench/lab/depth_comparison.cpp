// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/depth_comparison.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "slam/features/undistort.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// Where keypoints, given at undistorted positions, are in the camera's (distorted) image.
std::vector<Eigen::Vector2d> distorted(const Camera& camera,
                                       const std::vector<Keypoint>& keypoints) {
  constexpr int kRounds = 4;  // each round leaves a fraction of the previous error
  std::vector<Eigen::Vector2d> wanted;
  for (const Keypoint& k : keypoints) wanted.emplace_back(k.u_px, k.v_px);
  std::vector<Eigen::Vector2d> at = wanted;
  if (camera.distortion.none()) return at;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Eigen::Vector2d> is = at;
    undistort(camera, is);
    for (std::size_t i = 0; i < at.size(); ++i) at[i] += wanted[i] - is[i];
  }
  return at;
}

/// Whether the wanted depth is found at a pixel or next to it. The neighbors count because a
/// keypoint on an edge may have a neighbor's depth.
bool shows(const Grid2d<float>& depth_m, int x, int y, float wanted_m) {
  constexpr float kSame = 0.05F;  // share of the depth; noise may differ from that in the map
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u)
      if (depth_m.contains(u, v) && std::abs(depth_m(u, v) - wanted_m) <= kSame * wanted_m)
        return true;
  return false;
}

}  // namespace

DepthComparison::DepthComparison(const Map& map, Camera camera) : camera_(std::move(camera)) {
  for (const Keyframe& keyframe : map.keyframes()) keyframes_.emplace(keyframe.stamp_ns, &keyframe);
}

void DepthComparison::add(const RgbdFrame& frame) {
  const auto found = keyframes_.find(frame.stamp_ns);
  if (found == keyframes_.end()) return;
  const std::vector<Keypoint>& keypoints = found->second->features.keypoints;
  const std::vector<Eigen::Vector2d> seen_at = distorted(camera_, keypoints);
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const int x = cvRound(seen_at[i].x()), y = cvRound(seen_at[i].y());
    if (keypoints[i].depth_m <= 0 || !frame.depth_m.contains(x, y)) continue;
    ++compared_;
    same_ += shows(frame.depth_m, x, y, keypoints[i].depth_m) ? 1 : 0;
  }
}

void DepthComparison::require_same(const std::string& map, const std::string& sequence) const {
  constexpr std::size_t kFewest = 100;
  if (compared_ < kFewest || 2 * same_ >= compared_) return;
  throw InputError(fmt::format(
      "{}: is the map of another sequence: of {} depths at its keypoints, {} are as in {}", map,
      compared_, same_, sequence));
}

}  // namespace mh
