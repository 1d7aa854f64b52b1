// SPDX-License-Identifier: Apache-2.0
#include "slam/io/path_watch.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "slam/io/read_record.hpp"

namespace mh {
namespace fs = std::filesystem;

PathWatch::PathWatch(std::span<const fs::path> files)
    : watch_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  constexpr int kMostLinks = 40;  // as many as the kernel follows
  if (watch_ < 0) return;
  std::error_code error;
  for (const fs::path& file : files)
    if (const fs::path whole = fs::absolute(file, error); !error) follow(whole, kMostLinks);
}

PathWatch::~PathWatch() {
  if (watch_ >= 0) close(watch_);
}

void PathWatch::follow(const fs::path& path, int links) {
  fs::path folder = path.root_path();
  for (const fs::path& part : path.relative_path()) {
    if (part.empty() || part == ".") continue;
    constexpr std::uint32_t kMoves =
        IN_MOVED_FROM | IN_MOVED_TO | IN_CREATE | IN_DELETE | IN_ONLYDIR;
    const int number = part == ".." ? -1 : inotify_add_watch(watch_, folder.c_str(), kMoves);
    if (number >= 0) {
      folders_[number].path = folder;
      folders_[number].names.insert(part.string());
    }
    std::error_code error;
    const fs::path next = folder / part;
    if (const fs::path target = fs::read_symlink(next, error); !error && links > 0)
      follow(folder / target, links - 1);
    folder = next;
  }
}

void PathWatch::require_unmoved() {
  alignas(inotify_event) char bytes[16384];
  for (ssize_t size = 0; watch_ >= 0 && (size = read(watch_, bytes, sizeof bytes)) > 0;)
    for (const char* at = bytes; at < bytes + size;) {
      inotify_event event{};
      std::memcpy(&event, at, sizeof event);
      const std::string name = event.len > 0 ? at + sizeof event : "";
      at += sizeof event + event.len;
      const auto folder = folders_.find(event.wd);
      if ((event.mask & IN_Q_OVERFLOW) == 0 &&
          (folder == folders_.end() || !folder->second.names.contains(name)))
        continue;
      const fs::path place =
          folder == folders_.end() ? fs::path("a folder") : folder->second.path / name;
      throw InputChanged(fmt::format("{}: was changed while it was in use: start the command again",
                                     place.string()));
    }
}

}  // namespace mh
