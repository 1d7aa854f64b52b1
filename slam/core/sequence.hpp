// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "slam/core/camera.hpp"
#include "slam/core/random.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// What a camera delivered, in the order in which it was taken, wherever it comes from: a
/// recording, a scene that is rendered as it is asked for. The stamps of a faulty recording may go
/// back.
class Sequence {
 public:
  virtual ~Sequence() = default;

  virtual const Camera& camera() const = 0;
  virtual std::size_t size() const = 0;
  virtual Stamp stamp_ns(std::size_t i) const = 0;
  /// Frame i. Equal arguments give equal bits, whenever and in whatever order they are asked for.
  /// @param noise  of the sensors; a recording has noise of its own and ignores it
  /// @throws InputError if this frame cannot be had; others may.
  virtual RgbdFrame frame(std::size_t i, RandomStream noise) const = 0;
  /// Where the cameras really were, ordered by stamp; null where nobody knows. Frames without a
  /// valid pose are absent.
  virtual const Trajectory* truth() const = 0;
};

}  // namespace mh
