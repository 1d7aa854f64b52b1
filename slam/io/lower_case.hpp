// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// The text with small letters in the place of A to Z; all other characters stay.
inline std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace mh
