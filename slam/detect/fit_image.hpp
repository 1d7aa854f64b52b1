// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/core/rgbd_frame.hpp"
#include "slam/detect/onnx_input.hpp"
#include "slam/detect/settings.hpp"

namespace cv {
class Mat;
}

namespace mh {

/// How an image is placed in a network's input: input = image * scale + offset, where positions are
/// in pixels and (0, 0) is the upper left corner of the upper left pixel.
struct Placement {
  double scale_x = 1, scale_y = 1;
  int left = 0, top = 0, width = 0, height = 0;  ///< where the scaled image is in the input

  double image_x(double x) const { return (x - left) / scale_x; }
  double image_y(double y) const { return (y - top) / scale_y; }
};

/// @param letterbox  must not be kAuto
Placement place_image(int width, int height, const InputSize& input, Letterbox letterbox);

/// Returns the input of a network: 1 x 3 x height x width, float.
/// @param settings  must not contain kAuto
cv::Mat network_input(const Grid2d<Rgb8>& color, const InputSize& input, const Placement& at,
                      const DetectorSettings& settings);

}  // namespace mh
