// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/collada.hpp"

namespace mh {

std::string repaired_collada(std::string_view text, bool z_is_up) {
  constexpr std::string_view kBlank = " \t\r\n";
  constexpr std::string_view kNumberStart = "0123456789+-.";
  std::string repaired;
  repaired.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t tag_end = text.find('>', at);
    if (tag_end == text.npos) {
      repaired += text.substr(at);
      break;
    }
    repaired += text.substr(at, tag_end + 1 - at);
    at = tag_end + 1;
    const std::size_t content = text.find_first_not_of(kBlank, at);
    if (content != text.npos && kNumberStart.find(text[content]) != kNumberStart.npos) at = content;
  }
  constexpr std::string_view kUpAxis = "<up_axis>";
  if (const std::size_t tag = repaired.find(kUpAxis); z_is_up && tag != repaired.npos) {
    const std::size_t axis = repaired.find_first_of("XY<", tag + kUpAxis.size());
    if (axis != repaired.npos && repaired[axis] != '<') repaired[axis] = 'Z';
  }
  return repaired;
}

}  // namespace mh
