// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/node_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <span>
#include <vector>

#include "scenes/mesh_io/class_words.hpp"

namespace mh {
namespace {

constexpr std::string_view kClassKey = "#class=";
constexpr std::string_view kInstanceKey = "#instance=";

std::optional<InstanceId> parse_id(std::string_view text) {
  InstanceId id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return id;
}

constexpr std::size_t kLongest = 3;  // words in a class name
constexpr std::string_view kAbout[] = {"with", "of", "on", "for", "in", "under", "without", "and"};

/// The words of a name in lower case: runs of letters, also split at a change of case (TVCabinet is
/// "tv cabinet"). The "b" left over from a counter such as FloorB_01 is not a word.
std::vector<std::string> words_in_name(std::string_view name) {
  std::vector<std::string> words;
  const auto is = [&](std::size_t i, int (*kind)(int)) {
    return i < name.size() && kind(static_cast<unsigned char>(name[i])) != 0;
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (!is(i, std::isalpha)) continue;
    const bool after_letter = i > 0 && is(i - 1, std::isalpha);
    const bool hump = is(i, std::isupper) && ((i > 0 && is(i - 1, std::islower)) ||
                                              (after_letter && is(i + 1, std::islower)));
    if (!after_letter || hump) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
  }
  std::erase_if(words, [](const std::string& word) { return word.size() < 2; });
  return words;
}

/// Whether words spell a name, ignoring its spaces.
bool says(std::string_view name, std::span<const std::string> words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0 && name.starts_with(' ')) name.remove_prefix(1);
    for (std::string_view rest = words[i]; !rest.empty(); rest.remove_prefix(1)) {
      if (name.starts_with(' ')) name.remove_prefix(1);
      if (!name.starts_with(rest[0])) return false;
      name.remove_prefix(1);
    }
  }
  return name.empty();
}

/// "boxes" is "box", "shelves" is "shelf", "bodies" is "body".
std::vector<std::string> singulars(const std::string& word) {
  std::vector<std::string> forms{word};
  const auto cut = [&](std::string_view ending, std::string_view instead) {
    if (word.size() > ending.size() + 2 && word.ends_with(ending))
      forms.push_back(word.substr(0, word.size() - ending.size()) + std::string(instead));
  };
  cut("s", "");
  cut("es", "");
  cut("ies", "y");
  cut("ves", "f");
  return forms;
}

/// The class that these words name together, in the singular or plural; nullopt if they name none.
std::optional<ClassId> class_of_words(std::span<const std::string> run) {
  std::vector<std::string> words(run.begin(), run.end());
  for (const std::string& last : singulars(run.back())) {
    words.back() = last;
    for (const ClassInfo& info : classes())
      if (info.id != kVoid && info.id != kBackground && says(info.name, words)) return info.id;
    for (const ClassWord& word : kClassWords)
      if (says(word.words, words)) return *class_by_name(word.class_name);
    if (words.size() > 1) continue;
    const auto synonym = class_by_name(last);
    if (synonym && *synonym != kVoid && *synonym != kBackground) return synonym;
  }
  return std::nullopt;
}

}  // namespace

std::string node_name(std::string_view name, ClassId class_id, InstanceId instance) {
  return fmt::format("{}{}{}{}{}", name, kClassKey, classes()[class_id].name, kInstanceKey,
                     instance);
}

NodeLabel parse_node_name(std::string_view node) {
  const auto class_at = node.find(kClassKey);
  const auto instance_at = node.find(kInstanceKey);
  if (class_at == node.npos || instance_at == node.npos || instance_at < class_at)
    return {.name = std::string(node), .class_id = guess_class(node), .instance = std::nullopt};
  const auto class_begin = class_at + kClassKey.size();
  const auto class_name = node.substr(class_begin, instance_at - class_begin);
  return {.name = std::string(node.substr(0, class_at)),
          .class_id = class_by_name(class_name).value_or(kVoid),
          .is_explicit = true,
          .instance = parse_id(node.substr(instance_at + kInstanceKey.size()))};
}

ClassId guess_class(std::string_view name) {
  const std::vector<std::string> words = words_in_name(name.substr(name.rfind('/') + 1));
  ClassId head = kVoid;
  for (std::size_t i = 0; i < words.size();) {
    // Words after "with", "of" or the like only describe the thing named before.
    if (head != kVoid && std::ranges::find(kAbout, words[i]) != std::end(kAbout)) return head;
    std::size_t used = 1;
    for (std::size_t count = std::min(kLongest, words.size() - i); count > 0; --count) {
      const std::span run(words.data() + i, count);
      const std::optional<ClassId> found = class_of_words(run);
      if (!found) continue;
      if (*found != kVoid) head = *found;  // the last noun decides: a table lamp is a lamp
      used = count;
      break;
    }
    i += used;
  }
  return head;
}

std::optional<ClassId> class_of_noun(std::string_view name) {
  const std::vector<std::string> words = words_in_name(name);
  for (std::size_t count = std::min(kLongest, words.size()); count > 0; --count)
    if (const auto found =
            class_of_words({words.end() - static_cast<std::ptrdiff_t>(count), words.end()}))
      return found;
  return std::nullopt;
}

bool is_finer(ClassId class_id, ClassId lump) {
  constexpr ClassId kOtherStructure = 38, kOtherProp = 40;
  return class_id > kBackground && lump >= kOtherStructure && lump <= kOtherProp;
}

}  // namespace mh
