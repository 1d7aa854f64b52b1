// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

/// Contact sheets of the sensor factors, one row each: off, mild, strong, all from the same pose
/// and motion (forward at 0.4 m/s while turning at 1 rad/s), where the scene shows most objects.
/// A factor without a dial for its strength is stronger in a larger room, with larger pixels or
/// from nearer the floor, as its caption says.
struct SensorSheets {
  cv::Mat color, depth, frames, labels;
};
SensorSheets draw_sensor_sheets(const Scene& scene, std::shared_ptr<const Renderer> renderer);

}  // namespace mh
