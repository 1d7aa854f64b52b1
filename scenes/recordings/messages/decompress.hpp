// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace mh {

/// Decompresses the content of a chunk. Memory is allocated as bytes are decompressed, not
/// according to the claimed size.
/// @param compression  "lz4" (frames), "zstd" or "bz2"
/// @param size         of the result, as the file claims
/// @throws InputError "is ..." if the compression is unknown, the data is damaged or its size
/// differs.
std::string decompress(std::string_view stored, const std::string& compression, std::uint64_t size);

/// Compresses a chunk: "lz4" (one frame) or "zstd" (level 1).
std::string compress(std::string_view content, const std::string& compression);

}  // namespace mh
