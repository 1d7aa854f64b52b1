// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// The words of a list of something, for the functions below.
template <class Range, class Word = std::identity>
std::vector<std::string> words_of(const Range& range, Word word = {}) {
  std::vector<std::string> words;
  for (const auto& item : range) words.emplace_back(std::invoke(word, item));
  return words;
}

/// The word that a misspelt one was probably meant to be: the one that the fewest edits lead to
/// (a character more, less, another, or two neighbors swapped; letter case, blank, '-' and '_' do
/// not count), the first of equals; nullopt where more than a third of the word is wrong.
std::optional<std::string> nearest_word(std::string_view word,
                                        const std::vector<std::string>& valid);

/// "; did you mean 'pepper'?", to be put behind a message; "" where no word is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& valid);

/// What helps whoever wrote a word that is not valid, to be put behind the message:
/// "; did you mean 'pepper'? There are: handheld, ideal, pepper". Long lists are cut.
/// @param all  where the whole list stands, told where it is cut: "modelhouse reference classes"
std::string hint(std::string_view word, const std::vector<std::string>& valid,
                 std::string_view all = {});

}  // namespace mh
