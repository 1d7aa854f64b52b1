// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "scenes/scene.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

// What the page (bench/live/page) is shown, whoever drives: docs/live.md.

/// Meters or radians, to three decimals.
double rounded_for_page(double value);

/// Position (x, y) and heading of a camera, seen from above.
nlohmann::json from_above_for_page(const SE3& world_from_camera);

/// A scene seen from above: `rooms`, `things`, `classes`. @param scene  null: nothing is known
nlohmann::json plan_for_page(const Scene* scene);

/// A frame as JPEG images.
struct PageImages {
  std::string color, depth, labels;
};
PageImages images_for_page(const RgbdFrame& frame);

}  // namespace mh
