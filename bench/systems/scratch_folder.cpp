// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/scratch_folder.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include <fmt/format.h>

#include "slam/io/file_errors.hpp"
#include "slam/io/remove_tree.hpp"

namespace mh {
namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
  std::error_code error;
  const fs::path memory = "/dev/shm";
  const bool there = fs::is_directory(memory, error) && access(memory.c_str(), W_OK) == 0;
  std::string name = ((there ? memory : fs::temp_directory_path()) / "modelhouse-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw MachineError(fmt::format("{}: no temporary folder can be made", name));
  path_ = name;
  folder_ = open(name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder_ >= 0) return;
  rmdir(name.c_str());
  throw MachineError(fmt::format("{}: cannot be opened", name));
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;  // the program may have moved it
  const fs::path now = fs::read_symlink(fmt::format("/proc/self/fd/{}", folder_), error);
  close(folder_);
  if (!error && now != path_) remove_tree(now.c_str());
  remove_tree(path_.c_str());
}

bool ScratchFolder::is_in_place() const {
  struct stat ours {
  }, there{};
  return fstat(folder_, &ours) == 0 && lstat(path_.c_str(), &there) == 0 &&
         ours.st_ino == there.st_ino && ours.st_dev == there.st_dev;
}

std::string ScratchFolder::write(const char* name, std::string_view content) const {
  const auto reason = [&](int error) {
    if (error == ENOSPC || error == EDQUOT) throw_unwritable(path_ / name, error);
    if (error == EISDIR) return fmt::format("replaced its {} with a folder", name);
    if (error == EEXIST) return fmt::format("replaced its {} with another file", name);
    return fmt::format("left its {} unwritable: {}", name, std::generic_category().message(error));
  };
  if (!is_in_place()) return "removed the folder of its images";
  if (unlinkat(folder_, name, 0) != 0 && errno != ENOENT) return reason(errno);
  const int file =
      openat(folder_, name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (file < 0) return reason(errno);
  int error = 0;
  while (!content.empty() && error == 0) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written >= 0)
      content.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      error = errno;
  }
  close(file);
  return error == 0 ? std::string() : reason(error);
}

}  // namespace mh
