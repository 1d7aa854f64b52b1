// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "slam/config/features.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// 256-bit rotated BRIEF descriptor (Rublee et al., ICCV 2011), bit i in word i / 64.
using Descriptor = std::array<std::uint64_t, 4>;

inline int hamming(const Descriptor& a, const Descriptor& b) {
  return std::popcount(a[0] ^ b[0]) + std::popcount(a[1] ^ b[1]) + std::popcount(a[2] ^ b[2]) +
         std::popcount(a[3] ^ b[3]);
}

/// Radius of the patches for orientation and descriptor: keypoints keep this distance (px of their
/// level) from the border.
inline constexpr int kPatchReach_px = 19;

struct Keypoint {
  float u_px = 0, v_px = 0;  ///< undistorted, in pixels of the full-resolution image
  float depth_m = 0;         ///< 0 = none
  float angle_rad = 0;       ///< orientation by intensity centroid, [0, 2 pi)
  std::int32_t octave = 0;   ///< pyramid level, 0 = finest
  ClassId label = kVoid;     ///< most probable class at its pixel
};

/// The features of one frame; arrays of equal length.
struct Features {
  std::vector<Keypoint> keypoints;
  std::vector<Descriptor> descriptors;
  std::size_t size() const { return keypoints.size(); }
};

/// ORB (Rublee et al., ICCV 2011): FAST-9 corners on an image pyramid, spread evenly over image and
/// levels, each with its orientation, rotated BRIEF, depth and label. Descriptors equal cv::ORB's
/// bit for bit at the same pixel and angle. Everything else differs: corners have subpixel
/// positions, levels are mapped center to center (cv::ORB is off by up to 1.3 px at scale 3.6),
/// thresholds are lowered where no corner is found. Depth and label are those of the nearest pixel
/// of the original image, before undistortion. Ordered by octave, then strength.
/// @param frame  depth and semantics may be empty. Depth that is NaN, infinite, not positive or
///               beyond config.max_depth_m is treated as missing.
/// @returns config.count keypoints, fewer if the image has fewer corners.
/// @throws InputError if the frame's size is not the camera's.
Features extract(const RgbdFrame& frame, const Camera& camera, const FeatureConfig& config);

}  // namespace mh
