// SPDX-License-Identifier: Apache-2.0
#include "slam/io/files.hpp"

#include <fcntl.h>
#include <fnmatch.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/read_record.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

/// @returns 0, or errno of the call that failed
int write_all(const fs::path& file, std::string_view content) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno;
  int error = 0;
  while (!content.empty() && error == 0) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written >= 0)
      content.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      error = errno;
  }
  if (close(descriptor) != 0 && error == 0) error = errno;
  return error;
}

FileObservation::Kind look_at(const fs::path& path) {
  std::error_code error;
  const auto kind = [&] {
    switch (fs::status(path, error).type()) {
      case fs::file_type::regular:
        return FileObservation::Kind::kFile;
      case fs::file_type::directory:
        return FileObservation::Kind::kFolder;
      case fs::file_type::not_found:
      case fs::file_type::none:
        return FileObservation::Kind::kAbsent;
      default:
        return FileObservation::Kind::kOther;
    }
  }();
  if (kind == FileObservation::Kind::kAbsent)
    report_absent(path);
  else
    ReadScope::report({kind, path});
  return kind;
}

/// Creates a new empty file in a folder under an unused name.
/// @param name  returns a file name for (process, number)
/// @returns nullopt, and sets errno, if it cannot be created
template <class Name>
std::optional<fs::path> new_file(const fs::path& folder, const Name& name) {
  for (int number = 0;; ++number) {
    const fs::path file = folder / name(getpid(), number);
    const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      close(descriptor);
      return file;
    }
    if (errno != EEXIST) return std::nullopt;
  }
}

/// The file that a name refers to: symbolic links are followed, even if their target does not exist
/// yet.
fs::path followed(fs::path file) {
  constexpr int kMostLinks = 40;  // as in Linux
  std::error_code error;
  for (int links = 0; links < kMostLinks && fs::is_symlink(file, error); ++links) {
    const fs::path target = fs::read_symlink(file, error);
    file = target.is_absolute() ? target : file.parent_path() / target;
  }
  return file;
}

}  // namespace

void make_output_folder(const fs::path& folder) {
  if (folder.empty()) throw InputError("the output folder has an empty name");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error == std::errc::no_space_on_device) throw_unwritable(folder, ENOSPC);
  if (error || !fs::is_directory(folder))
    throw InputError(fmt::format("{}: cannot be created as a folder{}", folder.string(),
                                 error ? ": " + error.message() : ""));
  const auto probe = new_file(folder, [](pid_t process, int number) {
    return fmt::format(".probe.{}.{}", process, number);
  });
  const int failed = probe ? write_all(*probe, "x") : errno;
  if (probe) fs::remove(*probe, error);
  if (failed == 0) return;
  if (failed == ENOSPC || failed == EDQUOT) throw_unwritable(folder, failed);
  throw InputError(fmt::format("{}: cannot be written to", folder.string()));
}

void write_atomically(const fs::path& name, const std::function<void(const fs::path&)>& write) {
  // A rename onto a symbolic link would replace the user's link with a file.
  const fs::path file = followed(name);
  std::error_code error;
  // A rename would replace a device such as /dev/stdout with a file.
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
    throw InputError(fmt::format("{}: cannot be written: it is {}", file.string(),
                                 fs::is_directory(file, error) ? "a folder" : "not a file"));
  const auto temporary = new_file(file.parent_path(), [&](pid_t process, int number) {
    return fmt::format(".{}.{}.{}.tmp{}", file.stem().string(), process, number,
                       file.extension().string());
  });
  if (!temporary) throw_unwritable(file, errno);
  try {
    write(*temporary);
    if (!fs::exists(*temporary, error)) throw_unwritable(file, 0);
    fs::rename(*temporary, file, error);
    if (error) throw_unwritable(file, error.value());
  } catch (...) {
    fs::remove(*temporary, error);
    throw;
  }
}

void write_atomically(const fs::path& file, std::string_view content) {
  write_atomically(file, [&](const fs::path& temporary) {
    if (const int error = write_all(temporary, content)) throw_unwritable(file, error);
  });
}

std::string read_file(const fs::path& file) {
  const char* reason = why_unreadable(file);
  const FileState before = ReadScope::is_open() ? state_of(file) : FileState{};
  std::ifstream in;
  if (reason == nullptr) in.open(file, std::ios::binary);
  if (!in.is_open()) {
    report_absent(file);
    throw InputError(fmt::format("{}: cannot be read{}{}", file.string(), reason ? ": " : "",
                                 reason ? reason : ""));
  }
  std::error_code unknown;
  const std::uintmax_t bytes = fs::file_size(file, unknown);
  if (!unknown) require_readable_at_once(file, bytes);
  std::ostringstream stream;
  stream << in.rdbuf();
  std::string text = std::move(stream).str();
  report_read(file, text, before);
  return text;
}

bool is_file(const fs::path& path) {
  return look_at(path) == FileObservation::Kind::kFile;
}

bool is_folder(const fs::path& path) {
  return look_at(path) == FileObservation::Kind::kFolder;
}

bool is_there(const fs::path& path) {
  return look_at(path) != FileObservation::Kind::kAbsent;
}

fs::path without_trailing_slash(fs::path path) {
  return path.has_filename() ? std::move(path) : path.parent_path();
}

std::vector<std::string> list_folder(const fs::path& folder, const std::string& pattern) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::string name = entry.path().filename().string();
    if (fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD) == 0) names.push_back(std::move(name));
  }
  std::ranges::sort(names);
  if (ReadScope::is_open()) {
    std::string all;
    for (const std::string& name : names) all.append(name).push_back('\0');
    ReadScope::report(
        {FileObservation::Kind::kListed, folder / pattern, XXH3_64bits(all.data(), all.size())});
  }
  return names;
}

}  // namespace mh
