// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "slam/core/trajectory.hpp"
#include "slam/io/fields.hpp"

namespace mh {

/// `PRAGMA user_version` of a results file; a file with a different one is refused.
inline constexpr int kSchemaVersion = 15;

/// The tables of a results file, as CREATE statements; docs/store.md explains each column. `runs`,
/// `points`, `metrics`, `calls`, `frames`, `queries` and `episodes` depend only on suite, seeds and
/// binary; `times` and `claims` contain everything else. The last column is a digest of the others
/// (row_digest.hpp).
std::string schema();

/// One stamp of a mapping tour: the camera's true pose and the system's final estimate. A
/// recording's truth may have stamps different from its frames', or be unknown.
struct FrameRow {
  std::int64_t frame = 0;
  Stamp stamp_ns = 0;
  std::optional<SE3> truth;
  std::optional<SE3> estimate;
  std::uint32_t map = 0;  ///< the map that the estimate is in
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
