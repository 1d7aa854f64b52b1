// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/node_name.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <limits>

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
          .instance = parse_id(node.substr(instance_at + kInstanceKey.size()))};
}

ClassId guess_class(std::string_view name) {
  std::string words;
  for (const char c : name.substr(name.rfind('/') + 1)) {
    const auto letter = static_cast<unsigned char>(c);
    const bool is_letter = std::isalpha(letter) != 0;
    if (is_letter) words += static_cast<char>(std::tolower(letter));
    if (!is_letter && !words.empty() && words.back() != ' ') words += ' ';
  }
  if (words.ends_with(' ')) words.pop_back();
  // The longest run of words at the start, then those behind it: "wooden table" is a table.
  for (std::string_view rest = words; !rest.empty();) {
    for (std::string_view run = rest;;) {
      if (const auto found = class_by_name(run)) return *found;
      const auto last_space = run.rfind(' ');
      if (last_space == run.npos) break;
      run = run.substr(0, last_space);
    }
    const auto space = rest.find(' ');
    rest = space == rest.npos ? std::string_view() : rest.substr(space + 1);
  }
  return kVoid;
}

}  // namespace mh
