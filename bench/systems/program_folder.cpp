// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/program_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <functional>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "slam/core/file_errors.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// "12 1695378394123456789": size and time of a file itself, not of what a link names.
std::optional<std::string> state_of(const fs::path& file) {
  struct stat s {};
  if (lstat(file.c_str(), &s) != 0) return std::nullopt;
  return fmt::format("{} {}{:09}", s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec);
}

bool is_true_folder(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() == fs::file_type::directory;
}

/// Lists each file as "SIZE TIME NAME" and each folder as "NAME/", one per line. Names that contain
/// a newline are left out and therefore never removed.
std::string list_of(const fs::path& folder) {
  std::string list;
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().lexically_relative(folder).string();
    if (name.find('\n') != std::string::npos) continue;
    if (is_true_folder(it->path()))
      list += name + "/\n";
    else if (const auto state = state_of(it->path()))
      list += fmt::format("{} {}\n", *state, name);
  }
  return list;
}

/// Whether a name is inside the folder, not through a link.
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

fs::path made(const fs::path& folder) {
  fs::create_directory(folder);
  return folder;
}

}  // namespace

ProgramFolder::ProgramFolder(const fs::path& run)
    : run_(fs::absolute(run).lexically_normal()),
      work_(run_.parent_path()),
      path_(made(work_.path() / "run")) {}

ProgramFolder::~ProgramFolder() {
  try {
    move_to_run();
  } catch (const std::exception&) {
    // The run already failed; that reason is the one to report.
  }
}

void ProgramFolder::move_to_run() {
  if (!is_true_folder(path_)) return;
  write_atomically(path_ / kList, list_of(path_));
  for (int number = 1;; ++number) {
    const fs::path place = run_ / (number == 1 ? "outside" : fmt::format("outside.{}", number));
    remove_listed(place);
    std::error_code error;
    if (fs::exists(fs::symlink_status(place, error))) continue;
    fs::rename(path_, place, error);
    if (error) throw_unwritable(place, error.value());
    return;
  }
}

}  // namespace mh
