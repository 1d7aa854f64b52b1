// SPDX-License-Identifier: Apache-2.0
#include "slam/io/child_pipe.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace mh {
namespace {

std::int64_t now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void write_to_parent(int descriptor, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(descriptor, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) _exit(1);  // the parent is gone
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

void PipeWriter::bytes(const void* data, std::size_t size) {
  constexpr std::size_t kLarge = 1U << 14;
  if (size >= kLarge) {
    flush();
    write_to_parent(descriptor_, static_cast<const char*>(data), size);
    return;
  }
  waiting_.append(static_cast<const char*>(data), size);
  if (waiting_.size() >= kLarge) flush();
}

void PipeWriter::flush() {
  write_to_parent(descriptor_, waiting_.data(), waiting_.size());
  waiting_.clear();
}

PipeReader::PipeReader(int descriptor, int wall_s)
    : descriptor_(descriptor), deadline_ms_(now_ms() + 1000 * std::int64_t{wall_s}) {}

std::size_t PipeReader::some(char* to, std::size_t size) {
  for (;;) {
    const std::int64_t left_ms = deadline_ms_ - now_ms();
    if (left_ms <= 0) throw TookTooLong();
    pollfd ready{.fd = descriptor_, .events = POLLIN, .revents = 0};
    if (poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left_ms, 60'000))) <= 0) continue;
    const ssize_t got = read(descriptor_, to, size);
    if (got > 0) return static_cast<std::size_t>(got);
    if (got == 0 || errno != EINTR) throw EndedTooSoon();
  }
}

void PipeReader::bytes(void* data, std::size_t size) {
  constexpr std::size_t kBuffer = 1U << 14;
  auto* to = static_cast<char*>(data);
  while (size > 0) {
    if (at_ == waiting_.size() && size >= kBuffer) {  // bypasses the buffer
      const std::size_t got = some(to, size);
      to += got;
      size -= got;
      continue;
    }
    if (at_ == waiting_.size()) {
      waiting_.resize(kBuffer);
      waiting_.resize(some(waiting_.data(), waiting_.size()));
      at_ = 0;
    }
    const std::size_t taken = std::min(size, waiting_.size() - at_);
    std::memcpy(to, waiting_.data() + at_, taken);
    at_ += taken;
    to += taken;
    size -= taken;
  }
}

}  // namespace mh
