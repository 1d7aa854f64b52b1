// SPDX-License-Identifier: Apache-2.0
#include "slam/config/shared.hpp"

#include "slam/config/slam.hpp"

namespace mh {

SharedSlamConfig::SharedSlamConfig() : SharedSlamConfig(SlamConfig{}) {}

SharedSlamConfig::SharedSlamConfig(const SlamConfig& config)
    : config_(std::make_shared<const SlamConfig>(config)) {}

bool operator==(const SharedSlamConfig& a, const SharedSlamConfig& b) {
  return *a.config_ == *b.config_;
}

}  // namespace mh
