// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/percent.hpp"

#include <charconv>

#include "slam/io/files.hpp"

namespace mh {

std::string percent_decoded(std::string_view uri) {
  std::string decoded;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const char* digits = uri.data() + i + 1;
    if (uri[i] == '%' && i + 2 < uri.size() &&
        std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2 && code != 0) {
      decoded += static_cast<char>(code);
      i += 2;
    } else {
      decoded += uri[i];
    }
  }
  return decoded;
}

std::string named_by_uri(const std::filesystem::path& folder, const std::string& uri) {
  if (uri.find('%') == uri.npos || is_there(folder / uri)) return uri;
  return percent_decoded(uri);
}

}  // namespace mh
