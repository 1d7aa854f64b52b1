// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/file_checksums.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "slam/core/digest.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/read_record.hpp"

namespace mh {
namespace fs = std::filesystem;

FileChecksums::FileChecksums(fs::path folder) : folder_(std::move(folder)) {
  const fs::path file = folder_ / kName;
  if (!fs::is_regular_file(file)) return;
  std::istringstream lines(read_file(file));
  constexpr std::size_t kDigits = 16;
  for (std::string line; std::getline(lines, line);) {
    std::uint64_t digest = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), digest, 16);
    if (error == std::errc() && end == line.data() + kDigits && line.size() > kDigits + 2)
      digests_[line.substr(kDigits + 2)] = digest;  // else a line that was cut off
  }
}

std::string FileChecksums::name_of(const fs::path& file) const {
  return file.lexically_relative(folder_).generic_string();
}

void FileChecksums::add(std::span<const fs::path> files) {
  std::string lines;
  std::map<std::string, std::uint64_t> added;
  for (const fs::path& file : files) {
    const std::uint64_t digest = digest_file(file);
    added[name_of(file)] = digest;
    lines += fmt::format("{:016x}  {}\n", digest, name_of(file));
  }
  const std::scoped_lock lock(mutex_);
  for (const auto& [name, digest] : added) digests_[name] = digest;
  std::ofstream out(folder_ / kName, std::ios::app | std::ios::binary);
  if (!(out << lines << std::flush)) throw_unwritable(folder_ / kName, errno);
}

bool FileChecksums::hold(std::span<const fs::path> files) const {
  for (const fs::path& file : files) {
    std::uint64_t noted = 0;
    {
      const std::scoped_lock lock(mutex_);
      const auto found = digests_.find(name_of(file));
      if (found == digests_.end()) return false;
      noted = found->second;
    }
    std::error_code error;
    if (!fs::is_regular_file(file, error) || digest_file(file) != noted) return false;
  }
  return true;
}

void FileChecksums::finish() {
  if (digests_.empty()) return;
  std::string lines;
  for (const auto& [name, digest] : digests_) {
    if (!hold(std::array{folder_ / name}))
      throw InputChanged(
          fmt::format("{}: was changed while the sequence was written: start the "
                      "command again",
                      (folder_ / name).string()));
    lines += fmt::format("{:016x}  {}\n", digest, name);
  }
  write_atomically(folder_ / kName, lines);
}

}  // namespace mh
