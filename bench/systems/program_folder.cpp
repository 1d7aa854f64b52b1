// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/program_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/remove_tree.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// "12 1695378394123456789": size and time of a file itself, not of a link's target.
std::optional<std::string> state_of(const fs::path& file) {
  struct stat s {};
  if (lstat(file.c_str(), &s) != 0) return std::nullopt;
  return fmt::format("{} {}{:09}", s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec);
}

bool is_true_folder(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() == fs::file_type::directory;
}

/// Restores all our permissions on a program's folder: the program may have removed them.
void open_up(const fs::path& folder) {
  std::error_code error;
  fs::permissions(folder, fs::perms::owner_all, fs::perm_options::add, error);
}

/// Lists each file as "SIZE TIME NAME" and each folder as "NAME/", one per line; calls open_up()
/// for the folders. Names that contain a newline, and folders that are too deep, are left out and
/// therefore never removed.
std::string list_of(const fs::path& folder) {
  std::string list;
  std::error_code error;
  constexpr auto kHow = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator it(folder, kHow, error), end; !error && it != end;
       it.increment(error)) {
    const bool is_folder = is_true_folder(it->path());
    if (is_folder) open_up(it->path());
    if (it.depth() >= kDeepestFolder) it.disable_recursion_pending();
    const std::string name = it->path().lexically_relative(folder).string();
    if (name.find('\n') != std::string::npos) continue;
    if (is_folder)
      list += name + "/\n";
    else if (const auto state = state_of(it->path()))
      list += fmt::format("{} {}\n", *state, name);
  }
  return list;
}

/// Moves a folder to an unused name, possibly on another disk. In that case, anything that is not a
/// file, folder or link, or is nested too deep, is left out.
void move_folder(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error) return;
  if (error != std::errc::cross_device_link) throw_unwritable(to, error.value());
  fs::create_directory(to);
  for (fs::recursive_directory_iterator it(from), end; it != end; ++it) {
    const fs::path copy = to / it->path().lexically_relative(from);
    const fs::file_type type = it->symlink_status().type();
    if (it.depth() >= kDeepestFolder) it.disable_recursion_pending();
    if (type == fs::file_type::directory) open_up(it->path());
    if (type == fs::file_type::directory)
      fs::create_directory(copy, error);
    else if (type == fs::file_type::symlink)
      fs::copy_symlink(it->path(), copy, error);
    else if (type == fs::file_type::regular)
      fs::copy_file(it->path(), copy, error);
    if (error) throw_unwritable(copy, error.value());
  }
}

/// Whether a name leads to a place inside the folder, and not through a link.
bool leads_within(const fs::path& folder, const fs::path& name) {
  if (name.empty() || name.is_absolute()) return false;
  fs::path way = folder;
  for (const fs::path& part : name.parent_path()) {
    if (part == "..") return false;
    way /= part;
    if (!is_true_folder(way)) return false;
  }
  return name.filename() != ".." && is_true_folder(folder);
}

/// Removes unchanged files that the folder's list names, then folders that are empty.
void remove_listed(const fs::path& folder) {
  const fs::path file = folder / ProgramFolder::kList;
  std::error_code error;
  if (!is_true_folder(folder) || fs::symlink_status(file, error).type() != fs::file_type::regular)
    return;
  std::istringstream lines(read_file(file));
  fs::remove(file, error);
  std::set<fs::path, std::greater<>> folders;  // inner ones first
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('/')) {
      line.pop_back();
      if (leads_within(folder, line) && is_true_folder(folder / line))
        folders.insert(folder / line);
      continue;
    }
    const std::size_t name = line.find(' ', line.find(' ') + 1);
    if (name == std::string::npos || !leads_within(folder, line.substr(name + 1))) continue;
    const fs::path listed = folder / line.substr(name + 1);
    if (state_of(listed) == line.substr(0, name)) fs::remove(listed, error);
  }
  for (const fs::path& inner : folders) ::rmdir(inner.c_str());  // fails if not empty
  ::rmdir(folder.c_str());
}

std::string identity_of(const fs::path& folder) {
  struct stat s {};
  return lstat(folder.c_str(), &s) == 0 ? fmt::format("{} {}", s.st_dev, s.st_ino) : std::string();
}

fs::path made(const fs::path& folder) {
  fs::create_directory(folder);
  return folder;
}

}  // namespace

fs::path ProgramFolder::place() {
  const fs::path large = "/var/tmp";  // less often in memory than /tmp
  const bool usable = std::getenv("TMPDIR") == nullptr && access(large.c_str(), W_OK | X_OK) == 0;
  return usable ? large : fs::temp_directory_path();
}

ProgramFolder::ProgramFolder(const fs::path& run)
    : run_(fs::absolute(run).lexically_normal()),
      work_(place()),
      path_(made(work_.path() / "run")),
      identity_(identity_of(path_)) {}

ProgramFolder::~ProgramFolder() {
  try {
    move_to_run();
  } catch (const std::exception&) {
    // The run already failed; that reason is the one to report.
  }
}

void ProgramFolder::move_to_run() {
  if (!is_true_folder(path_) || identity_of(path_) != identity_) return;
  open_up(path_);
  for (int number = 1;; ++number) {
    const fs::path place = run_ / (number == 1 ? "outside" : fmt::format("outside.{}", number));
    remove_listed(place);
    std::error_code error;
    if (fs::exists(fs::symlink_status(place, error))) continue;
    move_folder(path_, place);
    // The list is written last, since copied files have new times. Whatever the program put in its
    // place is removed first.
    remove_tree((place / kList).c_str());
    fs::remove(place / kList, error);
    write_atomically(place / kList, list_of(place));
    return;
  }
}

}  // namespace mh
