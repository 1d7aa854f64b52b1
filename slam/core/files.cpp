// SPDX-License-Identifier: Apache-2.0
#include "slam/core/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/file_errors.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

/// @returns 0, or errno of what failed
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

}  // namespace

void make_output_folder(const fs::path& folder) {
  if (folder.empty()) throw InputError("the folder to write has an empty name");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error == std::errc::no_space_on_device) throw_unwritable(folder, ENOSPC);
  if (error || !fs::is_directory(folder))
    throw InputError(fmt::format("{}: cannot be made a folder{}", folder.string(),
                                 error ? ": " + error.message() : ""));
  const fs::path probe = folder / fmt::format(".probe.{}", getpid());
  const int failed = write_all(probe, "x");
  fs::remove(probe, error);
  if (failed == 0) return;
  if (failed == ENOSPC || failed == EDQUOT) throw_unwritable(folder, failed);
  throw InputError(fmt::format("{}: cannot be written to", folder.string()));
}

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = file.parent_path() / fmt::format(".{}.{}.tmp{}", file.stem().string(),
                                                              getpid(), file.extension().string());
  std::error_code error;
  // A rename would put a file in the place of a device such as /dev/stdout.
  if (fs::exists(file, error) && !fs::is_regular_file(file, error))
    throw InputError(fmt::format("{}: cannot be written: it is {}", file.string(),
                                 fs::is_directory(file, error) ? "a folder" : "no file"));
  try {
    write(temporary);
    if (!fs::exists(temporary, error)) throw_unwritable(file, 0);
    fs::rename(temporary, file, error);
    if (error) throw_unwritable(file, error.value());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

void write_atomically(const fs::path& file, std::string_view content) {
  write_atomically(file, [&](const fs::path& temporary) {
    if (const int error = write_all(temporary, content)) throw_unwritable(file, error);
  });
}

std::string read_file(const fs::path& file) {
  require_readable(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace mh
