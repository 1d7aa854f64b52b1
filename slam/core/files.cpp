// SPDX-License-Identifier: Apache-2.0
#include "slam/core/files.hpp"

#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace mh {
namespace fs = std::filesystem;

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(fmt::format("{}: cannot be made a folder{}", folder.string(),
                                 error ? ": " + error.message() : ""));
  const fs::path probe = folder / fmt::format(".probe.{}", getpid());
  {
    std::ofstream out(probe);
    out << "x";
    if (!out.flush()) throw InputError(fmt::format("{}: cannot be written to", folder.string()));
  }
  fs::remove(probe, error);
}

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = file.parent_path() / fmt::format(".{}.{}.tmp{}", file.stem().string(),
                                                              getpid(), file.extension().string());
  std::error_code error;
  try {
    write(temporary);
    if (!fs::exists(temporary, error))
      throw InputError(fmt::format("{}: cannot be written", file.string()));
    fs::rename(temporary, file, error);
    if (error)
      throw InputError(fmt::format("{}: cannot be written: {}", file.string(), error.message()));
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
}

void write_atomically(const fs::path& file, std::string_view content) {
  write_atomically(file, [&](const fs::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (!out.flush()) {
      if (errno == ENOSPC)
        throw MachineError(
            fmt::format("{}: the disk is full: make room and run again", file.string()));
      throw InputError(fmt::format("{}: cannot be written", file.string()));
    }
  });
}

std::string read_file(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    throw InputError(fmt::format("{}: cannot be read: it is a folder", file.string()));
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    const bool there = fs::exists(file, error);
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(),
                                 there ? "no permission" : "no such file"));
  }
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace mh
