// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/obj_text.hpp"

#include <algorithm>
#include <array>

namespace mh {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// Puts a zero before each number that starts with the decimal point.
void append_coordinates(std::string_view line, std::string& to) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_signed = i >= 2 && (line[i - 1] == '-' || line[i - 1] == '+');
    if (line[i] == '.' && i > 0 && is_blank(line[i - (is_signed ? 2 : 1)])) to += '0';
    to += line[i];
  }
}

}  // namespace

std::optional<std::string> repaired_obj(std::string_view text) {
  constexpr std::array<std::string_view, 5> kSigns = {" .", "\t.", "-.", "+.", "aniso"};
  if (std::ranges::none_of(kSigns, [&](auto sign) { return text.find(sign) != text.npos; }))
    return std::nullopt;
  std::string repaired;
  repaired.reserve(text.size() + text.size() / 8);
  while (!text.empty()) {
    const std::size_t size = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, size);
    text.remove_prefix(size);
    const std::string_view inner =
        line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
    if (inner.starts_with("aniso"))
      repaired += '\n';
    else if (inner.starts_with('v'))
      append_coordinates(line, repaired);
    else
      repaired += line;
  }
  return repaired;
}

}  // namespace mh
