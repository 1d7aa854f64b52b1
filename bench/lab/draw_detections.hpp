// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include "sim/sensors/visible_objects.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/detect/class_names.hpp"
#include "slam/detect/detected.hpp"

namespace mh {

/// Draws a frame with its boxes, each with the detector's own class name and score. If `labels` has
/// any, the frame's labels are drawn beside it in class colors.
cv::Mat draw_detections(const Grid2d<Rgb8>& color, const std::vector<DetectedBox>& boxes,
                        const ClassNames& names, const SemanticImage& labels = {});

/// Draws a frame with the objects that a detector missed (in red) and the boxes that it found (in
/// white).
cv::Mat draw_missed(const Grid2d<Rgb8>& color, const std::vector<VisibleObject>& missed,
                    const std::vector<DetectedBox>& found, const ClassNames& names);

}  // namespace mh
