// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Depth pixels of 16-bit files per meter, as in TUM's sequences.
inline constexpr double kDepthPerMeter = 5000;

/// Value of a 16-bit depth pixel; 0 without a return, 65535 beyond 13.1 m.
inline std::uint16_t depth_units(float depth_m) {
  // Truncation after adding 0.5 rounds non-negative values, without a call per pixel.
  const double units = kDepthPerMeter * static_cast<double>(depth_m) + 0.5;
  if (!(units > 0.0)) return 0;  // NaN is treated as 0
  return static_cast<std::uint16_t>(units < 65535.0 ? units : 65535.0);
}
/// The class of each pixel: the most probable one of its distribution.
Grid2d<ClassId> class_image(const SemanticImage& semantics);

/// Paths of one frame's images, as written by show().
struct FrameFiles {
  std::filesystem::path color, depth;
  std::filesystem::path labels;  ///< empty if the frame has none
};

/// Writes a frame's images as color.ppm (8 bit), depth.pgm (16 bit, kDepthPerMeter) and labels.pgm
/// (8 bit, class ids) into a folder, overwriting those of the previous frame: uncompressed, so that
/// it costs no more than a copy. @throws MachineError if that fails.
FrameFiles show(const RgbdFrame& frame, const std::filesystem::path& folder);

/// A calibration in the format of ORB-SLAM2 and its descendants: Camera.*, DepthMapFactor, ThDepth,
/// ORBextractor.*, Viewer.*. load_recorded_camera() reads it back.
std::string settings_text(const Camera& camera);

/// ROS' word for a distortion of five or eight coefficients.
const char* distortion_model(const Distortion& distortion);

/// The same calibration as ROS' camera_info YAML; load_settings() reads it back.
std::string camera_info_text(const Camera& camera);

}  // namespace mh
