// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/hiding.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "slam/io/counted.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMemory = "/dev/shm";

// ---- in the forked processes: only system calls

bool put(const char* file, std::string_view text) {
  const int opened = open(file, O_WRONLY | O_CLOEXEC);
  if (opened < 0) return false;
  const bool good = write(opened, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  close(opened);
  errno = error;
  return good;
}

/// @returns 0, or errno of the call that failed
int enter_namespace(const std::string& user_map, const std::string& group_map) {
  const bool root = geteuid() == 0;  // in a user namespace, root could not read other users' files
  if (unshare(root ? CLONE_NEWNS : CLONE_NEWUSER | CLONE_NEWNS) != 0) return errno;
  const bool mapped =
      root || (put("/proc/self/setgroups", "deny") && put("/proc/self/uid_map", user_map) &&
               put("/proc/self/gid_map", group_map));
  if (!mapped) return errno;
  // Later mounts outside still appear here; mounts here do not appear outside.
  return mount(nullptr, "/", nullptr, MS_REC | MS_SLAVE, nullptr) == 0 ? 0 : errno;
}

/// Gives this process its own shared memory, which contains one folder or nothing.
/// @returns 0, or errno of the call that failed: then nothing has changed
int make_memory_private(const std::string& of_own, const char* options) {
  if (of_own.empty())
    return mount("tmpfs", kMemory, "tmpfs", MS_NOSUID | MS_NODEV, options) == 0 ? 0 : errno;
  const char* const own = of_own.c_str();
  // Opened in this namespace, since a folder of the outer namespace cannot be mounted here.
  const int folder = open(own, O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) return errno;
  if (mount("tmpfs", kMemory, "tmpfs", MS_NOSUID | MS_NODEV, options) != 0) return errno;
  char link[32];
  *fmt::format_to_n(link, sizeof link - 1, "/proc/self/fd/{}", folder).out = 0;
  if (mkdir(own, 0700) == 0 && mount(link, own, nullptr, MS_BIND, nullptr) == 0)
    return close(folder);
  const int error = errno;
  umount2(kMemory, MNT_DETACH);
  return error;
}

int cover(const char* folder) {
  constexpr unsigned long kHow = MS_RDONLY | MS_NOSUID | MS_NODEV | MS_NOEXEC;
  return mount("tmpfs", folder, "tmpfs", kHow, "mode=0755") == 0 ? 0 : errno;
}

/// The errno with which hiding fails here, tried in a process that ends at once; 0 if it works.
int why_not(const std::string& user_map, const std::string& group_map) {
  const pid_t trial = _Fork();
  if (trial < 0) return errno;
  if (trial == 0) {
    const int error = enter_namespace(user_map, group_map);
    _exit(error != 0 ? error : cover("/"));
  }
  int status = 0;
  while (waitpid(trial, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : EPERM;
}

void say(std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts)
    if (write(STDERR_FILENO, part.data(), part.size()) < 0) return;
}

// ---- in the parent process

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

}  // namespace

Hiding::Hiding(std::span<const fs::path> hidden, std::span<const fs::path> needed,
               const fs::path& own, double shared_memory_mb)
    : memory_options_(shared_memory_mb > 0
                          ? fmt::format("mode=1777,size={:.0f}k", 1024 * shared_memory_mb)
                          : "mode=1777"),
      user_map_(fmt::format("{0} {0} 1\n", geteuid())),
      group_map_(fmt::format("{0} {0} 1\n", getegid())) {
  std::error_code error;
  if (lies_in(own, kMemory)) own_ = own.string();
  memory_ =
      fs::is_directory(kMemory, error) && std::ranges::none_of(needed, [&](const fs::path& one) {
        const fs::path real = fs::weakly_canonical(one, error);
        return lies_in(real, kMemory) && !lies_in(real, own);
      });
  std::set<fs::path> all;  // sorted: a folder comes before its contents
  for (const fs::path& path : hidden)
    if (const fs::path real = fs::canonical(path, error); !error) all.insert(real);
  for (const fs::path& path : all) {
    const bool is_needed = std::ranges::any_of(needed, [&](const fs::path& one) {
      return lies_in(fs::weakly_canonical(one, error), path);
    });
    if (is_needed) {
      left_ += (left_.empty() ? "; not hidden, since the program's own files are there: " : ", ") +
               path.string();
    } else if (!folders_.empty() && lies_in(path, folders_.back())) {
      continue;
    } else if (fs::is_directory(path, error)) {
      folders_.push_back(path.string());
    } else if (fs::is_regular_file(path, error)) {
      files_.push_back(path.string());
    }
  }
  constexpr std::size_t kNamed = 4;
  for (std::size_t k = 0; k < std::min(folders_.size(), kNamed); ++k)
    done_ += (k == 0 ? "" : ", ") + folders_[k];
  if (folders_.size() > kNamed)
    done_ += fmt::format(", {} more", counted(folders_.size() - kNamed, "folder"));
  if (!files_.empty())
    done_ +=
        (done_.empty() ? "" : ", ") + counted(files_.size(), "file") + " of the recording or scene";
}

void Hiding::apply() const {
  if (folders_.empty() && files_.empty() && left_.empty() && own_.empty()) return;
  int error = why_not(user_map_, group_map_);
  if (error == 0) error = enter_namespace(user_map_, group_map_);
  if (error != 0) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): strerrordesc_np() allocates nothing
    say({"modelhouse: nothing is hidden from the program: no mount namespace here: ",
         strerrordesc_np(error), "\n"});
    return;
  }
  std::string_view uncovered;
  if (memory_ && make_memory_private(own_, memory_options_.c_str()) != 0) uncovered = kMemory;
  for (const std::string& folder : folders_)
    if (cover(folder.c_str()) != 0) uncovered = folder;
  for (const std::string& file : files_)
    if (mount("/dev/null", file.c_str(), nullptr, MS_BIND, nullptr) != 0) uncovered = file;
  say({"modelhouse: hidden from the program by a mount namespace: ", done_,
       !memory_        ? ""
       : done_.empty() ? "what others have in shared memory"
                       : ", what others have in shared memory",
       left_, uncovered.empty() ? "" : "; could not be hidden: ", uncovered, "\n"});
}

}  // namespace mh
