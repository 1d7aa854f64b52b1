// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "slam/core/random.hpp"
#include "slam/core/sequence.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {

/// What became of one frame.
struct FrameOutcome {
  Stamp stamp_ns = 0;
  bool skipped = false;  ///< could not be read or did not fit; the report says nothing then
  StepReport report;
};

struct SlamRun {
  std::vector<FrameOutcome> frames;  ///< one for each that was offered
  std::vector<std::string> faults;   ///< why frames were skipped: the first few
  /// Of this run's frames, of a resumed one also those before; the world is the map's.
  Trajectory trajectory;
  int skipped = 0, tracked = 0, lost = 0, relocalized = 0, loops = 0;
  int started_anew = 0;  ///< times that a map of few keyframes was given up

  double completeness() const {
    return frames.empty() ? 0.0 : static_cast<double>(tracked) / static_cast<double>(frames.size());
  }
};

struct SlamRunOptions {
  bool localize = false;  ///< the map is frozen: frames are found in it, never added
  bool resume = false;    ///< frames up to the last one that the state was fed are passed by
  std::size_t first = 0, count = SIZE_MAX;  ///< frames of the sequence to offer
  RandomStream noise = RandomStream();      ///< of the sensors, where the sequence is simulated
  int small_map = 5;  ///< a map of at most so many keyframes is given up when tracking is lost
};

/// Told after each frame: how many are done, of how many, and what has come of them.
using SlamWatch = std::function<void(std::size_t done, std::size_t all, const SlamRun&)>;

/// Feeds a sequence to SLAM. A frame that cannot be read or does not fit the camera is skipped and
/// counted. Frames reported lost are looked for in the whole map, one by one, until one is found;
/// but where tracking is lost within a run whose map has at most options.small_map keyframes, it
/// starts anew with the first lost frame that can begin a map, as the original ORB-SLAM2 does: so
/// little is soon made again, and a place that was seen for a moment may never come back. Frames of
/// the map that was given up count as lost.
/// @param watch  may be empty
/// @throws InputError if no frame at all could be read, or none could start a map.
SlamRun run_slam(SlamState& state, const Sequence& sequence, const SlamRunOptions& options,
                 RandomStream stream, const StepObservers& observers = {},
                 const SlamWatch& watch = {});

/// One line per frame: stamp, status, keypoints, inliers, whether it became a keyframe or closed a
/// loop, and where relocalization ended, if it was tried, with the candidates after each step.
std::string frames_csv(const SlamRun& run);

}  // namespace mh
