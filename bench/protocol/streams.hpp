// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace mh {

/// Which part of a run draws: fork names of a run's random stream.
struct RunDraw {
  enum Name : std::uint64_t { kNoise = 1, kSlam = 2, kBlank = 3 };
};

}  // namespace mh
