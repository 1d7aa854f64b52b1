// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/frames_read.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace mh {

FramesRead::FramesRead(const std::filesystem::path& folder)
    : events_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  if (events_ >= 0) inotify_add_watch(events_, folder.c_str(), IN_OPEN);
}

FramesRead::~FramesRead() {
  if (events_ >= 0) close(events_);
}

std::size_t FramesRead::count() {
  alignas(inotify_event) std::array<char, 1 << 16> buffer{};
  for (ssize_t size = 0;
       events_ >= 0 && (size = read(events_, buffer.data(), buffer.size())) > 0;) {
    for (std::size_t at = 0; at < static_cast<std::size_t>(size);) {
      inotify_event event{};
      std::memcpy(&event, buffer.data() + at, sizeof(event));
      if (event.len > 0) names_.insert(buffer.data() + at + sizeof(event));
      at += sizeof(event) + event.len;
    }
  }
  return names_.size();
}

}  // namespace mh
