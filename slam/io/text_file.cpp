// SPDX-License-Identifier: Apache-2.0
#include "slam/io/text_file.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {

std::string_view without_mark(std::string_view text, const std::filesystem::path& file) {
  constexpr std::string_view kUtf8 = "\xef\xbb\xbf", kUtf16[] = {"\xff\xfe", "\xfe\xff"};
  if (text.starts_with(kUtf16[0]) || text.starts_with(kUtf16[1]))
    throw InputError(fmt::format("{}:1: is UTF-16 text: save it as UTF-8", file.string()));
  return text.starts_with(kUtf8) ? text.substr(kUtf8.size()) : text;
}

std::string read_text(const std::filesystem::path& file) {
  std::string text = read_file(file);
  text.erase(0, text.size() - without_mark(text, file).size());
  if (text.find('\n') == std::string::npos) std::ranges::replace(text, '\r', '\n');
  return text;
}

}  // namespace mh
