// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bench/protocol/report.hpp"

namespace mh {

/// Everything that a step said of its matching and relocalizing, the pose apart.
std::uint64_t digest_of_matching(const SystemReport& report);

}  // namespace mh
