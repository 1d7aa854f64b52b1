// SPDX-License-Identifier: Apache-2.0
#include "slam/io/remove_tree.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string_view>

namespace mh {
namespace {

/// Opens a folder, without following a link, and grants us all permissions; -1 if that fails.
int open_folder(int parent, const char* name) {
  constexpr int kHow = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
  int folder = openat(parent, name, kHow);
  if (folder < 0 && errno == EACCES && fchmodat(parent, name, S_IRWXU, 0) == 0)
    folder = openat(parent, name, kHow);
  if (folder >= 0) fchmod(folder, S_IRWXU);
  return folder;
}

template <class Use>
void for_each_entry(int folder, const Use& use) {
  lseek(folder, 0, SEEK_SET);
  alignas(dirent64) char buffer[8192];
  for (ssize_t size = 0; (size = getdents64(folder, buffer, sizeof buffer)) > 0;)
    for (ssize_t at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const dirent64*>(buffer + at);
      if (const std::string_view name = entry->d_name; name != "." && name != "..")
        use(entry->d_name);
      at += entry->d_reclen;
    }
}

bool remove_one(int folder, const char* name) {
  return unlinkat(folder, name, 0) == 0 || unlinkat(folder, name, AT_REMOVEDIR) == 0;
}

/// Moves a folder into another, under an unused name.
bool move_up(int from, const char* name, int to, unsigned& number) {
  if (const int opened = open_folder(from, name); opened >= 0)
    close(opened);  // gets the permission to move it
  char fresh[16];
  char* at = fresh + sizeof fresh;
  *--at = '\0';
  for (unsigned rest = number++; at > fresh + 1; rest /= 10) {
    *--at = static_cast<char>('0' + rest % 10);
    if (rest < 10) break;
  }
  *--at = '.';
  return renameat(from, name, to, at) == 0;
}

}  // namespace

void remove_tree(const char* folder) {
  const int top = open_folder(AT_FDCWD, folder);
  if (top < 0) {
    unlink(folder);  // another process put something else there
    return;
  }
  unsigned number = 0;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for_each_entry(top, [&](const char* name) {
      if (remove_one(top, name)) {
        goes_on = true;
        return;
      }
      const int inner = open_folder(top, name);
      if (inner < 0) return;
      // Deeper folders are moved up, so that no depth needs longer paths or more open files.
      for_each_entry(inner, [&](const char* below) {
        goes_on = remove_one(inner, below) || move_up(inner, below, top, number) || goes_on;
      });
      close(inner);
    });
  }
  close(top);
  rmdir(folder);
}

}  // namespace mh
