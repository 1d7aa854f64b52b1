// SPDX-License-Identifier: Apache-2.0
#include "scenes/find_file.hpp"

#include <cctype>
#include <string>

#include "slam/io/files.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

/// A shell pattern that matches a name in any letter case.
std::string any_case(const std::string& name) {
  std::string pattern;
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (std::isalpha(code)) {
      pattern +=
          {'[', static_cast<char>(std::tolower(code)), static_cast<char>(std::toupper(code)), ']'};
    } else if (c == '*' || c == '?' || c == '[' || c == '\\') {
      pattern += {'\\', c};
    } else {
      pattern += c;
    }
  }
  return pattern;
}

}  // namespace

std::optional<fs::path> find_any_case(const fs::path& path) {
  if (is_there(path)) return path;
  fs::path found;
  for (const fs::path& part : path) {
    if (found.empty() || is_there(found / part)) {
      found /= part;
      continue;
    }
    const auto names = list_folder(found, any_case(part.string()));
    if (names.empty()) return std::nullopt;
    found /= names.front();
  }
  return is_there(found) ? std::optional(found) : std::nullopt;
}

}  // namespace mh
