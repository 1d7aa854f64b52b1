// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/registered_depth.hpp"
#include "scenes/recordings/ros/topics.hpp"

namespace mh {

/// The cameras of a recording that consists of messages.
struct RosCameras {
  Camera color;
  std::optional<DepthCamera> depth;  ///< absent: depth is registered to color
  double depth_per_meter = 0;        ///< for integer depth
};

/// Reads the cameras from CameraInfo or, for color, from a settings file. Depth that is not yet
/// registered to color is registered with the transforms from tf, from RealSense's recorder, or
/// from the extrinsics that RealSense's driver publishes.
/// @throws InputError naming file and topic if there is no calibration, if its lens is not
/// supported, or if depth cannot be registered.
RosCameras ros_cameras(const ChosenTopics& chosen, const RosTopics& topics,
                       const RecordingConfig& config, const std::string& file,
                       std::vector<std::string>& notes);

}  // namespace mh
