// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "slam/core/trajectory.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// A moment of a mapping tour: the camera's true pose and the system's final estimate. A
/// recording's truth may have other stamps than its frames, or be unknown.
struct FrameRow {
  std::int64_t frame = 0;
  Stamp stamp_ns = 0;
  std::optional<SE3> truth;
  std::optional<SE3> estimate;
  std::uint32_t map = 0;  ///< that the estimate is in
};

template <MaybeConst<FrameRow> F, class Visit>
void fields(F& row, Visit& v) {
  auto& [frame, stamp_ns, truth, estimate, map] = row;
  v("frame", frame);
  v("stamp_ns", stamp_ns);
  v("truth", truth);
  v("estimate", estimate);
  v("map", map);
}

}  // namespace mh
