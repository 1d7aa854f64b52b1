// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/level.hpp"

#include <fmt/format.h>

namespace mh {

std::string level_name(const Level& level) {
  std::string name = level.file.stem().string();
  for (const Dose& dose : level.doses) name += fmt::format("+{}={:.6g}", dose.dial, dose.value);
  return name;
}

SensorConfig sensors_at(const Level& level) {
  return with_doses(level.is_file() ? load_sensor_config(level.file) : exact_sensors(),
                    level.doses);
}

}  // namespace mh
