// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene_frame.hpp"

#include <fmt/format.h>

namespace mh {

SceneFrame read_scene_frame(YamlReader& yaml) {
  SceneFrame frame;
  if (const auto up = yaml.find("up")) {
    frame.up = value_of(up->as_string(), words(UpAxis{}));
    if (!frame.up) up->fail(fmt::format("'{}' is neither y nor z", up->as_string()));
  }
  if (const auto z = yaml.find("floor_z_m"))
    frame.floor_z_m = z->as_double(-kFarthestFloor_m, kFarthestFloor_m);
  return frame;
}

}  // namespace mh
