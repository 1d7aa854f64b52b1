// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "scenes/recorded/scannet_folder.hpp"
#include "scenes/recorded/sequence_writer.hpp"
#include "sim/sensors/shutter.hpp"

namespace mh {

struct RenderSequenceOptions {
  std::size_t frames = SIZE_MAX;  ///< at most so many of the path
  std::size_t every = 1;          ///< every n-th of them only
  LabelMode labels = LabelMode::kExact;
  std::uint64_t seed = 0;  ///< of the sensors' noise
  int threads = 2;         ///< each works on a frame of its own, from rays to files
  bool resume = false;     ///< leaves out frames that are there already
};

/// The camera as the sequence tells of it: with `every`, its rate is that of the frames kept.
Camera recorded_camera(Camera camera, const RenderSequenceOptions& options);

/// Which moments of the shutter's path are asked for and arrive, in order.
std::vector<std::size_t> moments(const Shutter& shutter, const SensorConfig& sensors,
                                 const RenderSequenceOptions& options);

/// The frame of the path's i-th moment, with the truth; its classes are the labels as they arrive:
/// each pixel's most probable one, void where there are none.
ExactFrame exact_frame(const Shutter& shutter, const SensorConfig& sensors,
                       const RenderSequenceOptions& options, std::size_t i);

struct RenderedSequence {
  std::size_t frames = 0;   ///< written by this run
  std::size_t resumed = 0;  ///< that were there
  /// What the stages took, summed over all threads and over the frames written.
  double render_s = 0, encode_s = 0;
};

/// Takes the pictures along the shutter's path and writes them. Rendering and encoding of different
/// frames go on side by side, and no more than one frame is held per thread. The files' bytes do
/// not depend on the number of threads.
/// @param progress  share done in [0, 1]; called by one thread at a time
RenderedSequence render_sequence(const Shutter& shutter, const SensorConfig& sensors,
                                 SequenceWriter& writer, const RenderSequenceOptions& options,
                                 const std::function<void(double)>& progress);

}  // namespace mh
