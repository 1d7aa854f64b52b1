// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// What a camera delivered, in capture order, whatever the source: a recording, or a scene rendered
/// on demand. The stamps of a faulty recording may go backward.
class Sequence {
 public:
  virtual ~Sequence() = default;

  virtual const Camera& camera() const = 0;
  virtual std::size_t size() const = 0;
  virtual Stamp stamp_ns(std::size_t i) const = 0;
  /// Returns frame i. Equal arguments give equal bits, regardless of when and in what order frames
  /// are requested.
  /// @param noise  of the sensors; ignored by a recording, which contains its own
  /// @throws InputError if this frame is unavailable; others may still work.
  virtual RgbdFrame frame(std::size_t i, RandomStream noise) const = 0;
  /// Ground-truth camera poses, ordered by stamp; null if unknown. Frames without a valid pose are
  /// absent.
  virtual const Trajectory* truth() const = 0;
  /// All that an inertial sensor delivered, in order of stamps; empty if there is none. Frames do
  /// not contain it: which readings belong to a frame depends on the frame that a system was shown
  /// before it.
  virtual std::span<const ImuReading> imu() const { return {}; }
};

/// The stamps of all frames, in order.
inline std::vector<Stamp> stamps_of(const Sequence& sequence) {
  std::vector<Stamp> stamps_ns(sequence.size());
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) stamps_ns[i] = sequence.stamp_ns(i);
  return stamps_ns;
}

}  // namespace mh
