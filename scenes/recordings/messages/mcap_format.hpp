// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace mh::mcap {

/// The first and last bytes of an MCAP file.
inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

/// Kinds of records: the byte that precedes the content's length (u64).
enum class Opcode : std::uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd,
};

}  // namespace mh::mcap
