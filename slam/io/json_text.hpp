// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "slam/io/error.hpp"

namespace mh {

/// How deep lists and objects may be nested in JSON: comparing, copying and writing values recurses
/// at each level and would overflow the stack at some ten thousand levels.
inline constexpr int kDeepestJson = 200;

/// Whether a text has more levels than that; looks at brackets alone.
bool is_nested_too_deep(std::string_view json);

/// What is wrong, in our own words: "3:7: is not JSON", "has no 'id'".
std::string json_fault(const nlohmann::json::exception& error);

/// Parses JSON that a program or a person wrote.
/// @throws InputError without a file's name if it is not JSON, or nested too deeply.
template <class Json>
Json parse_json(std::string_view text) {
  if (is_nested_too_deep(text))
    throw InputError("is nested more than " + std::to_string(kDeepestJson) + " levels deep");
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(json_fault(error));
  }
}

/// The same, but returns a discarded value, which has no type, instead of throwing.
template <class Json>
Json parse_json_or_discard(std::string_view text) {
  if (is_nested_too_deep(text)) return Json(nlohmann::json::value_t::discarded);
  return Json::parse(text, nullptr, false);
}

}  // namespace mh
