// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "scenes/scene.hpp"
#include "sim/render/renderer.hpp"

namespace mh {

/// Contact sheets of the sensor factors, with one row per factor: off, mild, strong. All use the
/// same motion (forward at 0.4 m/s while turning at 1 rad/s) through the pose where the scene shows
/// the most objects. The effect of a factor without a strength setting is made stronger by a larger
/// room, larger pixels or a lower viewpoint, as its caption states.
struct SensorSheets {
  cv::Mat color, depth, frames, labels;
};
SensorSheets draw_sensor_sheets(const Scene& scene, std::shared_ptr<const Renderer> renderer);

}  // namespace mh
