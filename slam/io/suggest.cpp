// SPDX-License-Identifier: Apache-2.0
#include "slam/io/suggest.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mh {
namespace {

std::string plain(std::string_view word) {
  std::string result;
  for (const char c : word)
    if (c != ' ' && c != '-' && c != '_')
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Number of edits that turn one word into the other (optimal string alignment).
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t other = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + other});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> nearest_word(std::string_view word,
                                        const std::vector<std::string>& valid) {
  constexpr std::size_t kLongest = 64;  // of a mistyped word
  const std::string meant = plain(word.substr(0, kLongest));
  std::size_t least = std::max<std::size_t>(1, meant.size() / 3) + 1;
  std::optional<std::string> nearest;
  for (const std::string& candidate : valid) {
    const std::string other = plain(candidate);
    const std::size_t longer = std::max(meant.size(), other.size());
    const std::size_t apart = edits(meant, other);
    if (apart >= least || apart >= longer) continue;  // the words have nothing in common
    least = apart;
    nearest = candidate;
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& valid) {
  const auto nearest = nearest_word(word, valid);
  return nearest ? fmt::format("; did you mean '{}'?", *nearest) : "";
}

std::string hint(std::string_view word, const std::vector<std::string>& valid,
                 std::string_view all) {
  constexpr std::size_t kMost = 40;
  if (valid.empty()) return "";
  const std::string nearest = did_you_mean(word, valid);
  std::string text = nearest.empty() ? "; there are: " : nearest + " There are: ";
  const std::size_t shown = all.empty() ? valid.size() : std::min(kMost, valid.size());
  text +=
      fmt::format("{}", fmt::join(valid.begin(), valid.begin() + static_cast<long>(shown), ", "));
  if (shown < valid.size()) text += fmt::format(" and {} more ({})", valid.size() - shown, all);
  return text;
}

}  // namespace mh
