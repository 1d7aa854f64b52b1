// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/camera.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// Reads the camera of another program's calibration: ROS's camera_calibration or OpenCV
/// (`camera_matrix: ...`), a CameraInfo as `rostopic echo` prints it (`K: ...`), or the first
/// camera of Kalibr's camchain (`cam0: ...`). Marks all keys of that program as read; others may be
/// ours.
/// @returns false if the file is none of them
/// @throws InputError "file:line: place: value"
bool read_calibration(YamlReader& yaml, Camera& camera);

/// @param place  of the distortion, for the message
/// @throws InputError if an image of this camera cannot be undistorted
void require_usable(const Camera& camera, const YamlReader& place);

}  // namespace mh
