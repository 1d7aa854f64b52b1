// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// Collects the words of a range, for the functions below.
template <class Range, class Word = std::identity>
std::vector<std::string> words_of(const Range& range, Word word = {}) {
  std::vector<std::string> words;
  for (const auto& item : range) words.emplace_back(std::invoke(word, item));
  return words;
}

/// Returns the word most likely meant by a misspelled one: the one that is the fewest edits away
/// (insert, delete, replace, or swap two neighboring characters; letter case, spaces, '-' and '_'
/// do not count), ties to the first; nullopt if more than a third of the word is wrong.
std::optional<std::string> nearest_word(std::string_view word,
                                        const std::vector<std::string>& valid);

/// "; did you mean 'pepper'?", to append to a message; "" if no word is close.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& valid);

/// Help for the author of an invalid word, to append to the message: "; did you mean 'pepper'?
/// There are: handheld, ideal, pepper". Long lists are cut.
/// @param all  where to find the whole list, mentioned if it is cut: "modelhouse reference classes"
std::string hint(std::string_view word, const std::vector<std::string>& valid,
                 std::string_view all = {});

}  // namespace mh
