// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "bench/live/live_server.hpp"
#include "bench/protocol/mapping.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/suite/run_spec.hpp"

namespace mh {

/// Shows a run of the bench on the page of `modelhouse live` while it maps. It only watches: no bit
/// of the result depends on it.
class LiveWatch {
 public:
  /// @throws InputError if the port cannot be used
  LiveWatch(int port, const RunSpec& spec);

  /// Shows a mapped frame if somebody watches, at most some ten times a second.
  void show(const World& world, const MappedFrame& call, const RgbdFrame& frame,
            const SystemReport& report);

 private:
  const RunSpec& spec_;
  std::mutex mutex_;
  std::string hello_;  ///< guarded by mutex_: the plan is known with the first frame
  bool is_known_ = false;
  LiveServer server_;
  std::optional<SE3> world_from_map_;  ///< known from the first frame with a true and a found pose
  int keyframes_ = 0;
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace mh
