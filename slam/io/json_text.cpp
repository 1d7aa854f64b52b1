// SPDX-License-Identifier: Apache-2.0
#include "slam/io/json_text.hpp"

#include "slam/io/printable.hpp"

namespace mh {
namespace {

/// The part of a text between two others; empty if they are not found.
std::string between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t begin = text.find(before);
  if (begin == text.npos) return {};
  text.remove_prefix(begin + before.size());
  return std::string(text.substr(0, text.find(after)));
}

std::string fault_in(int id, std::string_view what) {
  switch (id) {
    case 302:
      return "holds " + between(what, "but is ", ",") + " where " +
             between(what, "type must be ", ",") + " is expected";
    case 304:
    case 305:
    case 306:
      return "holds " + between(what, " with ", ",") + " where an object or a list is expected";
    case 401:
      return "has no entry " + between(what, "array index ", " ");
    case 403:
      return "has no " + between(what, "key ", " not found");
    case 406:
      return "holds a number beyond the range of a double";
    default:
      return "does not have the expected contents";
  }
}

}  // namespace

bool is_nested_too_deep(std::string_view json) {
  int depth = 0;
  for (std::size_t at = json.find_first_of("[]{}\""); at < json.size();
       at = json.find_first_of("[]{}\"", at + 1)) {
    const char c = json[at];
    if (c == '"') {
      for (++at; at < json.size() && json[at] != '"'; ++at)
        if (json[at] == '\\') ++at;
    } else if (c == '[' || c == '{') {
      if (++depth > kDeepestJson) return true;
    } else {
      --depth;
    }
  }
  return false;
}

std::string json_fault(const nlohmann::json::exception& error) {
  const std::string_view what = error.what();
  if (dynamic_cast<const nlohmann::json::parse_error*>(&error) == nullptr)
    return printable(fault_in(error.id, what));
  const std::string line = between(what, "at line ", ","), column = between(what, "column ", ":");
  return line.empty() ? "is not JSON" : line + ":" + column + ": is not JSON";
}

}  // namespace mh
