// SPDX-License-Identifier: Apache-2.0
#include "slam/io/temporary_folder.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/remove_tree.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

// Written once the lock is held: a process that reads it and gets the lock knows that the folder is
// not in use.
constexpr std::string_view kMarkerText = "modelhouse works here; it removes this folder\n";

/// Prefix of the names of this host's folders: another host's lock may not be visible here.
std::string name_of_host() {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  return fmt::format(".work.{}.", host);
}

OwnedFolder make_hidden(const fs::path& parent) {
  make_output_folder(parent);
  remove_abandoned_folders(parent);
  for (int count = 0;; ++count)
    if (auto made =
            OwnedFolder::make(parent / fmt::format("{}{}.{}", name_of_host(), getpid(), count)))
      return *std::move(made);
}

}  // namespace

OwnedFolder::OwnedFolder(OwnedFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), marker_(std::exchange(other.marker_, -1)) {}

OwnedFolder::~OwnedFolder() {
  if (marker_ >= 0) close(marker_);
}

std::optional<OwnedFolder> OwnedFolder::make(const fs::path& folder) {
  if (mkdir(folder.c_str(), 0777) != 0) {
    if (errno == EEXIST) return std::nullopt;
    throw_unwritable(folder, errno);
  }
  OwnedFolder made;
  made.path_ = folder;
  made.marker_ = open((folder / kMarker).c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  // On a file system without locks, the marker stays empty, so that the folder is never mistaken
  // for an abandoned one.
  const bool good =
      made.marker_ >= 0 && (flock(made.marker_, LOCK_EX | LOCK_NB) != 0 ||
                            write(made.marker_, kMarkerText.data(), kMarkerText.size()) > 0);
  if (good) return made;
  const int failed = errno;
  made.remove();
  throw_unwritable(folder, failed);
}

std::optional<OwnedFolder> OwnedFolder::take(const fs::path& folder) {
  std::error_code error;
  if (fs::symlink_status(folder, error).type() != fs::file_type::directory) return std::nullopt;
  OwnedFolder found;
  found.path_ = folder;
  found.marker_ = open((folder / kMarker).c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  std::array<char, kMarkerText.size() + 1> text{};
  if (found.marker_ < 0 || flock(found.marker_, LOCK_EX | LOCK_NB) != 0 ||
      read(found.marker_, text.data(), text.size()) != static_cast<ssize_t>(kMarkerText.size()) ||
      std::string_view(text.data()) != kMarkerText)
    return std::nullopt;
  return found;
}

void OwnedFolder::remove() {
  if (path_.empty()) return;
  remove_tree(path_.c_str());
  path_.clear();
}

FolderHold::~FolderHold() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool FolderHold::lock(int how) {
  if (descriptor_ < 0) descriptor_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  return flock(descriptor_, how) == 0 || errno != EWOULDBLOCK;
}

void FolderHold::take() {
  if (!lock(LOCK_EX | LOCK_NB))
    throw InputError(fmt::format(
        "{}: another command is at work in this folder: wait for it, or name another folder",
        folder_.string()));
}

void FolderHold::join(const std::function<void()>& begin, const std::function<bool()>& is_same) {
  constexpr int kPatience_ms = 2000, kPoll_ms = 20;  // another process may be in its begin()
  for (int waited_ms = 0;; waited_ms += kPoll_ms) {
    if (lock(LOCK_EX | LOCK_NB)) {
      begin();
      if (lock(LOCK_SH | LOCK_NB)) return;
    } else if (lock(LOCK_SH | LOCK_NB)) {
      if (is_same()) return;
      break;
    }
    if (waited_ms >= kPatience_ms) break;
    ::poll(nullptr, 0, kPoll_ms);
  }
  throw InputError(
      fmt::format("{}: another command is at work in this folder, on something different: wait for "
                  "it, or name another folder",
                  folder_.string()));
}

void remove_abandoned_folders(const fs::path& parent) {
  const std::string ours = name_of_host();
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(parent, error))
    if (entry.path().filename().string().starts_with(ours))
      if (auto left = OwnedFolder::take(entry.path())) left->remove();
}

TemporaryFolder::TemporaryFolder(const fs::path& parent) : folder_(make_hidden(parent)) {}

}  // namespace mh
