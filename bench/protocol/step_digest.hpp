// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bench/protocol/system_report.hpp"

namespace mh {

/// Digest of everything that a step reported on its matching and relocalization, except the pose.
std::uint64_t digest_of_matching(const SystemReport& report);

}  // namespace mh
