// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "bench/protocol/system.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {

/// Modelhouse's own SLAM, semantic or plain depending on the configuration.
/// @param points  settings of its queries, for use_point(); if empty, those of `config`
/// @throws InputError / std::invalid_argument if camera or configuration are out of range.
std::unique_ptr<System> make_builtin_system(const Camera& camera, const SlamConfig& config,
                                            std::shared_ptr<const Vocabulary> vocabulary,
                                            std::vector<SemanticConfig> points = {});

struct BuiltinOptions {
  StepObservers observers = {};
  /// When tracking is lost, a map of at most this many keyframes is discarded at the first lost
  /// frame that can start a new one, as the original ORB-SLAM2 does. Such a small map is soon
  /// rebuilt, whereas waiting to relocalize in it may never end, since the place that it shows may
  /// never be seen again. 0: never discarded.
  int small_map = 0;
  std::vector<SemanticConfig> points = {};  ///< as for make_builtin_system()
};

/// Like the function above, on a state that the caller owns and that outlives the system, such as a
/// map that was loaded or will be saved.
std::unique_ptr<System> make_builtin_system(SlamState& state, const BuiltinOptions& options);

}  // namespace mh
