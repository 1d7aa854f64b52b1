// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sim/sensors/sensors.hpp"

namespace mh {

/// What is looked at, where a model has no dial for its strength.
struct Look {
  double baseline = 1;      ///< times the sensor's own
  double far = 1;           ///< the scene is so many times as large
  int pixel = 1;            ///< so many times as wide
  double eye_m = 0;         ///< above the floor; 0 = as the view is
  bool over_color = false;  ///< edges of the depth over the color picture
};

/// One factor: what it is called, and what makes it mild and strong.
struct Factor {
  std::string name;
  std::array<std::string, 3> captions;
  std::array<std::function<void(SensorConfig&)>, 3> settings;
  int crop_px = 640;  ///< width of the part that is shown, from the middle
  std::array<Look, 3> looks = {};
};

// The rows of the contact sheets (sheets.hpp).
std::vector<Factor> color_factors();
std::vector<Factor> depth_factors();
std::vector<Factor> frame_factors();
std::vector<Factor> label_factors();
/// Exact boxes, one network and another: told apart by the seed of their labels, of which
/// kExactBoxes stands for no network.
Factor detector_factor();
inline constexpr std::uint64_t kExactBoxes = 100;

/// What each setting begins with.
SensorConfig everything_off();

}  // namespace mh
