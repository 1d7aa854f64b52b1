// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace mh::bag {

/// The first line of a bag.
inline constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

/// Kinds of records: field `op` of their headers.
enum class Op : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

}  // namespace mh::bag
