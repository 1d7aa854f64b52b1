// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// The text with A to Z in lower case; all other characters are unchanged.
inline std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace mh
