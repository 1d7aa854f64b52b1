// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace mh {

/// A text from somebody's file as it may be printed and written into JSON: what is no UTF-8 and
/// what a terminal would obey (escapes, tabs, ends of lines, turns of direction) becomes '?', byte
/// by byte. A pattern of the result matches the text itself, as '?' stands for any letter in it.
std::string legible(std::string text);
/// The same without a copy.
bool is_legible(std::string_view text);

}  // namespace mh
