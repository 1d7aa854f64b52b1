// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace mh {

/// Total bytes of all files that this process has read, counted by report_read(). Readers' time and
/// memory limits scale with it.
inline std::atomic<std::uint64_t> g_bytes_read{0};

}  // namespace mh
