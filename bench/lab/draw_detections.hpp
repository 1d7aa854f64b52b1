// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include "sim/sensors/visible_objects.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/detect/class_names.hpp"
#include "slam/detect/detected.hpp"

namespace mh {

/// A frame with its boxes, each with the detector's own class name and score; beside it, if
/// `labels` has any, the frame's labels in the colors of classes.
cv::Mat draw_detections(const Grid2d<Rgb8>& color, const std::vector<DetectedBox>& boxes,
                        const ClassNames& names, const SemanticImage& labels = {});

/// A frame with the objects that a detector missed, in red, and what it found, in white.
cv::Mat draw_missed(const Grid2d<Rgb8>& color, const std::vector<VisibleObject>& missed,
                    const std::vector<DetectedBox>& found, const ClassNames& names);

}  // namespace mh
