// SPDX-License-Identifier: Apache-2.0
#include "slam/features/features.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "slam/features/corners.hpp"
#include "slam/features/describe.hpp"
#include "slam/features/pyramid.hpp"
#include "slam/features/undistort.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

template <class T>
void require_size(const Grid2d<T>& grid, const Camera& camera, const char* name) {
  if (grid.width() == camera.width_px && grid.height() == camera.height_px) return;
  throw InputError(fmt::format("frame: {} is {}x{}, but the camera's images are {}x{}", name,
                               grid.width(), grid.height(), camera.width_px, camera.height_px));
}

void require_sizes(const RgbdFrame& frame, const Camera& camera) {
  require_size(frame.color, camera, "color");
  if (!frame.depth_m.empty()) require_size(frame.depth_m, camera, "depth");
  if (!frame.semantics.index.empty()) require_size(frame.semantics.index, camera, "label image");
}

std::vector<std::vector<Corner>> corners_per_level(const std::vector<PyramidLevel>& pyramid,
                                                   const FeatureConfig& config) {
  std::vector<std::vector<Corner>> found;
  std::vector<int> available;
  for (const PyramidLevel& level : pyramid) {
    found.push_back(find_corners(level.image, kPatchReach_px, config.fast_threshold,
                                 config.fast_threshold_low));
    available.push_back(static_cast<int>(found.back().size()));
  }
  const std::vector<int> share = share_out(config.count, 1.0 / config.scale, available);
  for (std::size_t l = 0; l < found.size(); ++l) found[l] = spread(found[l], share[l]);
  return found;
}

/// Depth of the surface that a corner belongs to; 0 if unknown. A corner on a silhouette belongs to
/// the outline of the object in front, and moves with it, while the pixel itself may show the
/// background: if the 3x3 pixels around it cover two surfaces, the nearer one is used.
float depth_at(const Grid2d<float>& depth_m, int x, int y, double max_depth_m) {
  constexpr float kSameSurface = 1.05F;  // ratio of farthest to nearest depth
  if (depth_m.empty()) return 0.0F;
  const auto known = [max_depth_m](float depth) {
    return depth > 0 && depth <= max_depth_m;  // NaN fails both comparisons
  };
  std::array<float, 9> around{};
  std::size_t count = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, depth_m.height() - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, depth_m.width() - 1); ++u)
      if (const float depth = depth_m(u, v); known(depth)) around[count++] = depth;
  if (count == 0) return 0.0F;
  const auto [nearest, farthest] = std::minmax_element(around.begin(), around.begin() + count);
  if (*farthest < kSameSurface * *nearest) {
    const float depth = depth_m(x, y);
    return known(depth) ? depth : 0.0F;
  }
  const float limit = kSameSurface * *nearest;
  float sum = 0;
  int in_front = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (around[i] < limit) {
      sum += around[i];
      ++in_front;
    }
  return sum / static_cast<float>(in_front);
}

void append(const PyramidLevel& level, int octave, const Corner& corner, const RgbdFrame& frame,
            double max_depth_m, Features& features) {
  const cv::Point2f peak = peak_of(level.image, corner);
  const cv::Point2d raw = level.to_full(
      {static_cast<double>(corner.x) + peak.x, static_cast<double>(corner.y) + peak.y});
  const int x = cvRound(raw.x),
            y = cvRound(raw.y);  // inside the image: corners keep a distance from its border

  Keypoint keypoint;
  keypoint.u_px = static_cast<float>(raw.x);
  keypoint.v_px = static_cast<float>(raw.y);
  keypoint.depth_m = depth_at(frame.depth_m, x, y, max_depth_m);
  keypoint.angle_rad = to_radians(orientation_deg(level.image, corner.x, corner.y));
  keypoint.octave = octave;
  keypoint.label = frame.semantics.at(x, y).most_probable();
  features.keypoints.push_back(keypoint);
  features.descriptors.push_back(describe(level.blurred, corner.x, corner.y, keypoint.angle_rad));
}

void undistort(const Camera& camera, std::vector<Keypoint>& keypoints) {
  if (camera.distortion.none() || keypoints.empty()) return;
  std::vector<Eigen::Vector2d> points;
  for (const Keypoint& k : keypoints) points.emplace_back(k.u_px, k.v_px);
  undistort(camera, points);
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    keypoints[i].u_px = static_cast<float>(points[i].x());
    keypoints[i].v_px = static_cast<float>(points[i].y());
  }
}

}  // namespace

Features extract(const RgbdFrame& frame, const Camera& camera, const FeatureConfig& config) {
  require_sizes(frame, camera);
  const std::vector<PyramidLevel> pyramid =
      make_pyramid(frame.color, config, 2 * kPatchReach_px + 1);
  const std::vector<std::vector<Corner>> corners = corners_per_level(pyramid, config);

  Features features;
  features.keypoints.reserve(static_cast<std::size_t>(config.count));
  features.descriptors.reserve(static_cast<std::size_t>(config.count));
  for (std::size_t l = 0; l < pyramid.size(); ++l)
    for (const Corner& corner : corners[l])
      append(pyramid[l], static_cast<int>(l), corner, frame, config.max_depth_m, features);
  undistort(camera, features.keypoints);
  return features;
}

}  // namespace mh
