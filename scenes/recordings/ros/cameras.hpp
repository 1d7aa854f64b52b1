// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/registered_depth.hpp"
#include "scenes/recordings/ros/topics.hpp"

namespace mh {

/// The cameras of a recording in messages.
struct RosCameras {
  Camera color;
  std::optional<DepthCamera> depth;  ///< absent: depth is registered to color
  double depth_per_meter = 0;        ///< of depth in whole numbers
};

/// Reads the cameras from CameraInfo or, for color, from a settings file. Depth that is not
/// registered to color uses the transforms of tf, of RealSense's recorder or of its driver's
/// extrinsics.
/// @throws InputError naming file and topic if there is no calibration, one of a lens that is not
/// supported, or depth that cannot be registered.
RosCameras ros_cameras(const ChosenTopics& chosen, const RosTopics& topics,
                       const RecordingConfig& config, const std::string& file,
                       std::vector<std::string>& notes);

}  // namespace mh
