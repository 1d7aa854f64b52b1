// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace mh {

/// Makes untrusted text safe to print and to write into JSON: invalid UTF-8 and anything a terminal
/// would act on (escapes, tabs, line ends, bidirectional controls) becomes '?', byte by byte. Used
/// as a pattern, the result still matches the original text, since '?' matches any character.
std::string printable(std::string text);
/// Whether printable() would leave the text unchanged.
bool is_legible(std::string_view text);

}  // namespace mh
