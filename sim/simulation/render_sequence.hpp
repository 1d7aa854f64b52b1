// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "scenes/recordings/scannet_folder.hpp"
#include "scenes/recordings/sequence_writer.hpp"
#include "sim/sensors/shutter.hpp"

namespace mh {

struct RenderSequenceOptions {
  std::size_t frames = SIZE_MAX;  ///< at most this many frames of the path
  std::size_t every = 1;          ///< only every n-th of them
  LabelMode labels = LabelMode::kExact;
  std::uint64_t seed = 0;  ///< seed of the sensors' noise
  bool is_second = false;  ///< second camera of a pair: its own noise, but the same lost frames
  int threads = 2;         ///< each works on its own frame, from rays to files
  bool resume = false;     ///< skips frames that already exist
  /// If set, replaces the labels of the frame at the path's i-th pose. Called by several threads.
  std::function<void(RgbdFrame& frame, std::size_t i)> relabel = nullptr;
};

/// Returns the camera as recorded in the sequence: with `every`, its rate is that of the kept
/// frames.
Camera recorded_camera(Camera camera, const RenderSequenceOptions& options);

/// Returns, in order, the indices of the requested poses of the shutter's path whose frames are
/// delivered.
std::vector<std::size_t> moments(const Shutter& shutter, const SensorConfig& sensors,
                                 const RenderSequenceOptions& options);

/// Returns the frame at the path's i-th pose, with the ground truth; its classes are the delivered
/// labels: each pixel's most probable class, void where there is none.
ExactFrame exact_frame(const Shutter& shutter, const SensorConfig& sensors,
                       const RenderSequenceOptions& options, std::size_t i);

struct RenderedSequence {
  std::size_t frames = 0;   ///< written by this run
  std::size_t resumed = 0;  ///< skipped because they already existed
  /// Time spent in each stage, summed over all threads and written frames.
  double render_s = 0, encode_s = 0;
};

/// Renders the images along the shutter's path and writes them. Different frames are rendered and
/// encoded in parallel, with at most one frame in memory per thread. The files' bytes do not depend
/// on the number of threads.
/// @param progress  share done in [0, 1]; called by one thread at a time
RenderedSequence render_sequence(const Shutter& shutter, const SensorConfig& sensors,
                                 SequenceWriter& writer, const RenderSequenceOptions& options,
                                 const std::function<void(double)>& progress);

}  // namespace mh
