// SPDX-License-Identifier: Apache-2.0
#include "slam/config/slam.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {

void validate(const SlamConfig& config) {
  for_each_setting(config, SettingsCheck("slam settings"));
}

}  // namespace mh
