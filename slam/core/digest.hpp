// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "slam/core/rgbd_frame.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// xxh3-64 digests of a run's inputs and outputs: equal bits, equal digest. `seed` chains them.
std::uint64_t digest_bytes(const void* data, std::size_t size, std::uint64_t seed = 0);
/// Extends `sum`, the digest of the digests so far, by the next one.
std::uint64_t chained(std::uint64_t sum, std::uint64_t next);
/// Digest of a file's bytes. @throws InputError if it cannot be read.
std::uint64_t digest_file(const std::filesystem::path& file, std::uint64_t seed = 0);
std::uint64_t digest(const RgbdFrame& frame);  ///< stamp, color, depth and labels
std::uint64_t digest(const std::optional<SE3>& pose);
std::uint64_t digest(const Trajectory& trajectory);

/// 16 hexadecimal digits.
std::string hex(std::uint64_t digest);

/// Marks a digest in a list of fields (slam/io/fields.hpp).
template <class T>
struct Digest {
  T& value;
};
inline Digest<std::uint64_t> as_digest(std::uint64_t& value) {
  return {value};
}
inline Digest<const std::uint64_t> as_digest(const std::uint64_t& value) {
  return {value};
}

/// xxh3-128 of a text, in hexadecimal.
std::string text_key(std::string_view text);

}  // namespace mh
