// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/collada.hpp"

#include <algorithm>

namespace mh {
namespace {

/// If a text begins with a comment, a hole, or a tag of a polygon with holes, returns the length of
/// that part; otherwise 0.
std::size_t size_of_unread(std::string_view text) {
  const auto up_to = [&](std::string_view end) {
    const std::size_t found = text.find(end);
    return found == text.npos ? text.size() : found + end.size();
  };
  if (text.starts_with("<!--")) return up_to("-->");
  if (text.starts_with("<h>")) return up_to("</h>");
  return text.starts_with("<ph>") || text.starts_with("</ph>") ? up_to(">") : 0;
}

}  // namespace

std::string repaired_collada(std::string_view text, bool z_is_up) {
  constexpr std::string_view kBlank = " \t\r\n";
  constexpr std::string_view kNumberStart = "0123456789+-.";
  std::string repaired;
  repaired.reserve(text.size());
  bool in_nameless_image = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t tag = std::min(text.find('<', at), text.size());
    repaired += text.substr(at, tag - at);
    const std::string_view rest = text.substr(tag);
    if (rest.empty()) break;
    if (const std::size_t unread = size_of_unread(rest)) {
      at = tag + unread;
      continue;
    }
    const std::size_t size = std::min(rest.find('>'), rest.size() - 1) + 1;
    if (rest.starts_with("<image ") || rest.starts_with("<image>"))
      in_nameless_image = rest[size - 2] != '/';
    if (rest.starts_with("<init_from") || rest.starts_with("<data")) in_nameless_image = false;
    if (rest.starts_with("</image>") && in_nameless_image)  // assimp would reject the whole file
      repaired += "<init_from>that it does not name</init_from>";
    repaired += rest.substr(0, size);
    at = tag + size;
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
