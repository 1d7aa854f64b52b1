// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "bench/protocol/system.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {

/// Modelhouse's own SLAM, semantic or plain as the configuration says.
/// @throws InputError / std::invalid_argument if camera or configuration are out of range.
std::unique_ptr<System> make_our_system(const Camera& camera, const SlamConfig& config,
                                        std::shared_ptr<const Vocabulary> vocabulary);

}  // namespace mh
