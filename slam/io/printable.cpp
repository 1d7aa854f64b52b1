// SPDX-License-Identifier: Apache-2.0
#include "slam/io/printable.hpp"

#include <algorithm>
#include <cstddef>

namespace mh {
namespace {

/// Length in bytes of the first character; 0 if it is invalid or not printable.
std::size_t character(std::string_view text) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = at(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < size) return 0;
  unsigned code = first & (0x7fU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((at(i) & 0xc0U) != 0x80U) return 0;
    code = code << 6U | (at(i) & 0x3fU);
  }
  const bool longer_than_need_be = (size == 3 && code < 0x800) || (size == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  const bool obeyed =
      code < 0xa0 || (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return longer_than_need_be || surrogate || code > 0x10ffff || obeyed ? 0 : size;
}

}  // namespace

bool is_legible(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = character(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

std::string printable(std::string text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character(std::string_view(text).substr(i));
    if (size == 0) text[i] = '?';
    i += std::max<std::size_t>(size, 1);
  }
  return text;
}

}  // namespace mh
