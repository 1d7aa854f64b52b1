// SPDX-License-Identifier: Apache-2.0
#include "slam/io/file_errors.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include <fmt/format.h>

namespace mh {
namespace fs = std::filesystem;

void throw_unwritable(const fs::path& file, int error) {
  if (error == ENOSPC || error == EDQUOT)
    throw DiskFullError(
        fmt::format("{}: the disk is full: make room and run again", file.string()));
  if (error == EFBIG)
    throw MachineError(fmt::format("{}: cannot be written: {}", file.string(),
                                   std::generic_category().message(error)));
  throw InputError(fmt::format("{}: cannot be written{}", file.string(),
                               error == 0 ? "" : ": " + std::generic_category().message(error)));
}

const char* why_unreadable(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  switch (status.type()) {
    case fs::file_type::regular:
      return access(file.c_str(), R_OK) == 0 ? nullptr : "no permission";
    case fs::file_type::directory:
      return "it is a folder";
    case fs::file_type::not_found:
      return "no such file";
    case fs::file_type::none:
      return error == std::errc::permission_denied               ? "no permission"
             : error == std::errc::too_many_symbolic_link_levels ? "its links form a cycle"
                                                                 : "the system denies access";
    default:
      return "it is not a file";
  }
}

void require_readable_at_once(const fs::path& file, std::uintmax_t bytes) {
  if (bytes > kMostReadAtOnce_bytes)
    throw InputError(fmt::format(
        "{}: cannot be read: it has {:.1f} GB, at most {:.1f} GB can be read", file.string(),
        static_cast<double>(bytes) * 1e-9, static_cast<double>(kMostReadAtOnce_bytes) * 1e-9));
}

void require_readable(const fs::path& file) {
  if (const char* reason = why_unreadable(file))
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(), reason));
}

void require_open(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder, error) && access(folder.c_str(), R_OK | X_OK) != 0)
    throw InputError(fmt::format("{}: cannot be read: no permission", folder.string()));
}

}  // namespace mh
