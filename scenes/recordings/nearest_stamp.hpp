// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Color and depth images further apart in time are not paired, as in TUM's associate.py.
inline constexpr Stamp kMaxApart_ns = 20'000'000;

/// Frames per second, from the median time between images in the order given, rounded to 0.01 Hz;
/// 30 for a single image.
double rate_of_hz(const std::vector<Stamp>& stamps_ns);

/// A list of stamps, in any order, for lookup by time.
class StampIndex {
 public:
  explicit StampIndex(const std::vector<Stamp>& stamps_ns);
  /// The index of the stamp nearest in time, or of the first in the list if several are equally
  /// near; nullopt if none is within kMaxApart_ns.
  std::optional<std::size_t> nearest(Stamp stamp_ns) const;

 private:
  std::vector<std::pair<Stamp, std::size_t>> sorted_;  ///< stamp, index
};

}  // namespace mh
