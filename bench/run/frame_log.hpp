// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "bench/protocol/mapping.hpp"

namespace mh {

/// Collects, as a MappingObserver, the report on each frame of a sequence: the last attempt counts,
/// and frames of a discarded map are treated as lost.
class FrameLog {
 public:
  void add(const MappedFrame& call, const SystemReport& report);

  int tracked = 0, relocalized = 0, loops = 0;
  int map_resets = 0;
  bool last_was_lost = false;

  /// Returns a line for each frame of the sequence from `first` on: stamp, status, keypoints,
  /// inliers, whether it became a keyframe or closed a loop, and, if relocalization was tried, the
  /// stage it reached and the candidates after each step. The status of frames that were not shown
  /// is `skipped`, that of test frames `held_out`.
  std::string csv(const Sequence& sequence, const ProtocolConfig& config,
                  std::size_t first = 0) const;

 private:
  void count(const SystemReport& report, int by);

  std::map<std::size_t, SystemReport> frames_;  // by index
};

}  // namespace mh
