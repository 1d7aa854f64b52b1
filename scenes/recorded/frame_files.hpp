// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Depth pixels of 16-bit files per meter, as in TUM's sequences.
inline constexpr double kDepthPerMeter = 5000;

/// Value of a 16-bit depth pixel; 0 where nothing came back, 65535 beyond 13.1 m.
inline std::uint16_t depth_units(float depth_m) {
  // Cut after adding a half: what is not negative is rounded so, without a call per pixel.
  const double units = kDepthPerMeter * static_cast<double>(depth_m) + 0.5;
  if (!(units > 0.0)) return 0;  // no number counts as nothing
  return static_cast<std::uint16_t>(units < 65535.0 ? units : 65535.0);
}
/// The class of each pixel: the most probable one of its distribution.
Grid2d<ClassId> class_image(const SemanticImage& semantics);

/// Where show() puts the pictures of one frame.
struct FrameFiles {
  std::filesystem::path color, depth;
  std::filesystem::path labels;  ///< empty where the frame has none
};

/// Writes a frame's pictures as color.ppm (8 bit), depth.pgm (16 bit, kDepthPerMeter) and
/// labels.pgm (8 bit, class ids) into a folder, over those of the frame before: uncompressed, so
/// that it costs a copy. @throws MachineError if that cannot be done.
FrameFiles show(const RgbdFrame& frame, const std::filesystem::path& folder);

/// A calibration in the layout that ORB-SLAM2 and its descendants read: Camera.*, DepthMapFactor,
/// ThDepth, ORBextractor.*, Viewer.*. load_recorded_camera() reads it back.
std::string settings_text(const Camera& camera);

/// The same calibration as ROS' camera_info YAML; load_settings() reads it back.
std::string camera_info_text(const Camera& camera);

}  // namespace mh
