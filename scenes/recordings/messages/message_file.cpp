// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/messages/message_file.hpp"

#include <libdeflate.h>

#include <algorithm>

#include <fmt/format.h>

#include "scenes/recordings/messages/decompress.hpp"
#include "slam/io/error.hpp"
#include "slam/io/printable.hpp"

namespace mh {
namespace {

// Chunks of recorders are far smaller; a file that claims more would only exhaust memory.
constexpr std::uint64_t kLargestChunk = 256U << 20;
constexpr std::uint64_t kFreeClaim = 64U << 20;
constexpr std::uint64_t kMostPerStoredByte = 1000;

bool is_plain(const std::string& compression) {
  return compression.empty() || compression == "none";
}

}  // namespace

std::vector<std::string> MessageFile::notes() const {
  std::vector<std::string> lines;
  for (const auto& [kind, left] : left_out_)
    lines.push_back(left.count == 1 ? fmt::format("{}: {}", name_, left.first)
                                    : fmt::format("{}: {} {}, the first: {}", name_, left.count,
                                                  kind, left.first));
  return lines;
}

void MessageFile::leave_out(const std::string& kind, std::uint64_t at, const std::string& why) {
  LeftOut& left = left_out_[kind];
  if (left.count++ == 0) left.first = fmt::format("at byte {}: {}", at, printable(why));
}

std::size_t MessageFile::channel(MessageChannel channel) {
  const auto found = std::ranges::find(channels_, channel);
  if (found != channels_.end()) return static_cast<std::size_t>(found - channels_.begin());
  channels_.push_back(std::move(channel));
  return channels_.size() - 1;
}

std::uint32_t MessageFile::add_chunk(Chunk chunk) {
  const std::uint64_t most = kFreeClaim + kMostPerStoredByte * file_.view.size();
  if (is_plain(chunk.compression)) {
    if (chunk.size != chunk.stored.size())
      throw InputError(
          fmt::format("claims {} bytes in a chunk of {}", chunk.size, chunk.stored.size()));
  } else if (chunk.size > kLargestChunk || chunk.size > most - claimed_) {
    throw InputError(
        fmt::format("claims {} bytes in {} compressed ones", chunk.size, chunk.stored.size()));
  } else {
    claimed_ += chunk.size;
  }
  chunks_.push_back(std::move(chunk));
  checked_.push_back(false);
  return static_cast<std::uint32_t>(chunks_.size() - 1);
}

HeldBytes MessageFile::open_chunk(std::uint32_t number) const {
  const std::scoped_lock lock(mutex_);
  const Chunk& chunk = chunks_[number];
  HeldBytes content;
  if (is_plain(chunk.compression)) {
    content = {file_.owner, chunk.stored};
  } else {
    if (opened_ == number) return opened_bytes_;
    content = hold(decompress(chunk.stored, chunk.compression, chunk.size));
  }
  if (chunk.crc && !checked_[number] &&
      libdeflate_crc32(0, content.view.data(), content.view.size()) != *chunk.crc)
    throw InputError("is damaged: its CRC does not match");
  checked_[number] = true;
  if (!is_plain(chunk.compression)) {
    opened_ = number;
    opened_bytes_ = content;
  }
  return content;
}

HeldBytes MessageFile::read(const MessagePlace& place) const {
  if (place.chunk == MessagePlace::kFile)
    return {file_.owner, file_.view.substr(place.at, place.size)};
  try {
    HeldBytes content = open_chunk(place.chunk);
    content.view = content.view.substr(place.at, place.size);
    return content;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: chunk at byte {} {}", name_, chunks_[place.chunk].at,
                                 printable(error.what())));
  }
}

}  // namespace mh
