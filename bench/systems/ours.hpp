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

struct OurSystemOptions {
  StepObservers observers = {};
  /// A map of at most so many keyframes is given up when tracking is lost, with the first lost
  /// frame that can begin another, as the original ORB-SLAM2 does: so little is soon made again,
  /// and a place that was seen for a moment may never come back. 0: no map is.
  int small_map = 0;
};

/// The same over a state of the caller's, which outlives it: a map that was loaded, or that is to
/// be saved.
std::unique_ptr<System> make_our_system(SlamState& state, const OurSystemOptions& options);

}  // namespace mh
