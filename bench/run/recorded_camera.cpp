// SPDX-License-Identifier: Apache-2.0
#include "bench/run/recorded_camera.hpp"

namespace mh {

RecordedCamera recorded_camera(const Settings& settings) {
  return {settings.camera, settings.depth_per_meter, settings.exchange_red_blue};
}

RecordedCamera load_recorded_camera(const std::filesystem::path& file) {
  return recorded_camera(load_settings(file));
}

}  // namespace mh
