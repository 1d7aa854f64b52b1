// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace mh {

/// "1 run", "2 runs", "0 runs".
/// @param more  the plural where it is not the word plus "s": "queries"
std::string counted(std::integral auto count, std::string_view one, std::string_view more = {}) {
  std::string text = std::to_string(count) + " ";
  if (count == 1) return text.append(one);
  return more.empty() ? text.append(one).append("s") : text.append(more);
}

}  // namespace mh
