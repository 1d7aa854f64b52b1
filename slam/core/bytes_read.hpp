// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace mh {

/// Bytes of all files that this process has read so far, by report_read(): the time and memory that
/// a reader may take are measured by it.
inline std::atomic<std::uint64_t> g_bytes_read{0};

}  // namespace mh
