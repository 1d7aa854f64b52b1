// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sim/sensors/sense.hpp"

namespace mh {

/// How a row's view changes to strengthen the effect of a model without a strength setting.
struct Look {
  double baseline = 1;      ///< factor on the sensor's baseline
  double far = 1;           ///< factor on the scene's size
  int pixel = 1;            ///< factor on the pixel width
  double eye_m = 0;         ///< above the floor; 0: the view's own height
  bool over_color = false;  ///< draws edges of the depth over the color image
};

/// One factor with its name and three settings: off, mild, strong.
struct Factor {
  std::string name;
  std::array<std::string, 3> captions;
  std::array<std::function<void(SensorConfig&)>, 3> settings;
  int crop_px = 640;  ///< width of the central part of the image that is shown
  std::array<Look, 3> looks = {};
};

// The rows of the contact sheets (sheets.hpp).
std::vector<Factor> color_factors();
std::vector<Factor> depth_factors();
std::vector<Factor> frame_factors();
std::vector<Factor> label_factors();
/// Three settings: exact boxes, one network, another network. They differ in the seed of their
/// labels; kExactBoxes means no network.
Factor detector_factor();
inline constexpr std::uint64_t kExactBoxes = 100;

/// The configuration that each setting is applied to.
SensorConfig everything_off();

}  // namespace mh
