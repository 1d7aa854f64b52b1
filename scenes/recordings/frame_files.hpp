// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Value of a 16-bit depth pixel at one meter, as in TUM's sequences.
inline constexpr double kDepthPerMeter = 5000;

/// Value of a 16-bit depth pixel; 0 if there is no return, 65535 beyond 13.1 m.
inline std::uint16_t depth_units(float depth_m) {
  // Truncation after adding 0.5 rounds non-negative values, without a call per pixel.
  const double units = kDepthPerMeter * static_cast<double>(depth_m) + 0.5;
  if (!(units > 0.0)) return 0;  // NaN is treated as 0
  return static_cast<std::uint16_t>(units < 65535.0 ? units : 65535.0);
}
/// The class of each pixel: the most probable one of its distribution.
Grid2d<ClassId> class_image(const SemanticImage& semantics);
/// The same for a frame; void everywhere if it has no labels.
Grid2d<ClassId> classes_of(const RgbdFrame& frame);

/// One frame's images as contents of files, uncompressed so that they cost no more than a copy.
struct FrameFiles {
  std::string color;   ///< PPM, 8 bit
  std::string depth;   ///< PGM, 16 bit, kDepthPerMeter
  std::string labels;  ///< PGM, 8 bit, class ids; empty if the frame has none
};
FrameFiles image_files(const RgbdFrame& frame);

/// A calibration in the format of ORB-SLAM2 and its descendants: Camera.*, DepthMapFactor, ThDepth,
/// ORBextractor.*, Viewer.*. load_recorded_camera() reads it back.
std::string settings_text(const Camera& camera);

/// ROS's name for a distortion with five or eight coefficients.
const char* distortion_model(const Distortion& distortion);

/// The same calibration as ROS's camera_info YAML; load_settings() reads it back.
std::string camera_info_text(const Camera& camera);

}  // namespace mh
