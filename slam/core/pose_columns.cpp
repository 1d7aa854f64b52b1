// SPDX-License-Identifier: Apache-2.0
#include "slam/core/pose_columns.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/lower_case.hpp"

namespace mh {
namespace {

constexpr std::string_view kWhitespace = " \t\r\n\v\f";

/// A column's name in lower case, and the unit after it in brackets.
struct Name {
  std::string text, unit;
};

std::string_view trimmed(std::string_view text, std::string_view what) {
  const std::size_t first = text.find_first_not_of(what);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(what) - first + 1);
}

std::vector<Name> names_in(std::string_view line, char separator) {
  line = trimmed(line, kWhitespace);
  if (line.starts_with('#') || line.starts_with('%')) line.remove_prefix(1);
  std::vector<Name> names;
  for (const std::string_view word : words_of_line(line, separator)) {
    const std::size_t bracket = std::min(word.find_first_of("[("), word.size());
    const std::string unit = lower_case(std::string(trimmed(word.substr(bracket), "[]() ")));
    const std::string_view text = trimmed(word.substr(0, bracket), kWhitespace);
    if (bracket == 0 && !word.empty()) {  // a unit after a space: "tx [m]"
      if (!names.empty()) names.back().unit = unit;
      continue;
    }
    names.push_back({lower_case(std::string(text)), unit});
  }
  return names;
}

/// Whether three consecutive names end in x, y, z after a common prefix, which may be empty.
bool is_vector(std::span<const Name> names, std::size_t first) {
  if (first + 3 > names.size()) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string& name = names[first + k].text;
    if (name.empty() || name.back() != "xyz"[k]) return false;
    if (name.substr(0, name.size() - 1) !=
        names[first].text.substr(0, names[first].text.size() - 1))
      return false;
  }
  return true;
}

bool begin_alike(const std::string& a, const std::string& b) {
  return std::string_view(a).substr(0, a.size() - 1) == std::string_view(b).substr(0, b.size() - 1);
}

/// Finds the columns of x y z qx qy qz qw. The rotation is a name that ends in w and the vector
/// with the same prefix directly after or before it; the position is the first other vector.
std::optional<std::array<std::size_t, 7>> pose_in(std::span<const Name> names) {
  for (std::size_t w = 0; w < names.size(); ++w) {
    if (!names[w].text.ends_with('w')) continue;
    // If position and rotation have the same names, as in "x y z w x y z", the rotation's vector
    // follows w.
    for (const bool behind : {true, false}) {
      if (!behind && w < 3) continue;
      const std::size_t q = behind ? w + 1 : w - 3;
      if (!is_vector(names, q) || !begin_alike(names[q].text, names[w].text)) continue;
      for (std::size_t p = 0; p < names.size(); ++p)
        if (is_vector(names, p) && (p + 2 < std::min(q, w) || p > std::max(q + 2, w)))
          return std::array<std::size_t, 7>{p, p + 1, p + 2, q, q + 1, q + 2, w};
    }
  }
  return std::nullopt;
}

const std::map<std::string, int, std::less<>> kUnits = {
    {"s", 0},     {"sec", 0},    {"secs", 0},     {"seconds", 0},     {"ms", -3},
    {"msec", -3}, {"us", -6},    {"µs", -6},      {"usec", -6},       {"ns", -9},
    {"nsec", -9}, {"nsecs", -9}, {"nanosec", -9}, {"nanoseconds", -9}};

std::optional<int> unit_of(const Name& name) {
  const std::size_t last = name.text.find_last_of("_. ");
  const std::string_view end =
      std::string_view(name.text).substr(last == std::string::npos ? 0 : last + 1);
  for (const std::string_view word : {std::string_view(name.unit), end})
    if (const auto unit = kUnits.find(word); unit != kUnits.end()) return unit->second;
  return std::nullopt;
}

/// Finds the time columns among those that are not the pose's.
/// @throws InputError if there are several, none of them named as a time
void find_stamp(std::span<const Name> names, PoseColumns& columns) {
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::ranges::find(columns.pose, i) == columns.pose.end()) others.push_back(i);
  for (const char* rest : {"nsecs", "nsec", "nanosec"})
    for (const std::size_t ns : others) {
      if (!names[ns].text.ends_with(rest)) continue;
      const std::string stem = names[ns].text.substr(0, names[ns].text.rfind(rest));
      for (const std::size_t s : others)
        if (names[s].text == stem + "secs" || names[s].text == stem + "sec") {
          columns.stamp = s;
          columns.nanoseconds = ns;
          columns.unit = 0;
          return;
        }
    }
  const auto is_named = [&](const char* part) {
    return std::ranges::find_if(
        others, [&](std::size_t i) { return names[i].text.find(part) != std::string::npos; });
  };
  auto stamp = is_named("stamp");
  if (stamp == others.end()) stamp = is_named("time");
  if (stamp == others.end())
    stamp = std::ranges::find_if(others, [&](std::size_t i) {
      return names[i].text == "t" || names[i].text == "ts" || unit_of(names[i]).has_value();
    });
  // If a single column is left and it is the first, it is the time, whatever its name.
  if (stamp == others.end() && (others.empty() || others.size() > 1 || others[0] != 0))
    throw InputError("its columns have names, but none of them is a time");
  columns.stamp = stamp == others.end() ? others[0] : *stamp;
  columns.unit = unit_of(names[columns.stamp]);
}

std::string listed(std::span<const Name> names) {
  std::string text;
  for (const Name& name : names) text += (text.empty() ? "" : " ") + name.text;
  return text;
}

}  // namespace

std::vector<std::string_view> words_of_line(std::string_view line, char separator) {
  std::vector<std::string_view> words;
  line = trimmed(line, kWhitespace);
  while (!line.empty()) {
    const std::size_t end = std::min(
        separator == ' ' ? line.find_first_of(kWhitespace) : line.find(separator), line.size());
    words.push_back(trimmed(trimmed(line.substr(0, end), kWhitespace), "\""));
    line.remove_prefix(std::min(end + 1, line.size()));
    line = trimmed(line, kWhitespace);
  }
  return words;
}

std::optional<PoseColumns> columns_named_by(std::string_view line, char separator,
                                            const PoseColumns& usual, std::size_t values) {
  std::vector<Name> names = names_in(line, separator);
  const bool is_comment = trimmed(line, kWhitespace).starts_with('#');
  auto pose = pose_in(names);
  if (const std::size_t words = names.size() - std::min(names.size(), values);
      pose && words > 0 && words < std::ranges::min(*pose)) {  // as in "# format: timestamp tx ..."
    names.erase(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(words));
    for (std::size_t& place : *pose) place -= words;
  }
  PoseColumns columns = usual;
  if (names.size() == values && pose) {
    columns.pose = *pose;
    find_stamp(names, columns);
    const std::size_t last =
        std::max({std::ranges::max(*pose), columns.stamp, columns.nanoseconds.value_or(0)});
    columns.least = last + 1;
    columns.most = std::max(usual.most, values);
    if (const std::string& unit = names[(*pose)[0]].unit; !unit.empty() && unit != "m")
      throw InputError(fmt::format("its positions are in '{}', not in m", unit));
    return columns;
  }
  const auto is_of_quaternion = [](const Name& name) { return name.text.starts_with('q'); };
  const bool states_others = names.size() >= 8 && separator != ' ' &&
                             ((!is_comment && names.size() == values) ||
                              std::ranges::count_if(names, is_of_quaternion) >= 4);
  if (!pose) {
    if (states_others)
      throw InputError(fmt::format(
          "its columns are named {}: names that end in x, y, z, w are read, such as `tx ty tz qx "
          "qy qz qw`",
          listed(names)));
    return std::nullopt;
  }
  // The seven names must be adjacent and follow the stamp's name; words before it do not name
  // columns.
  const auto [first, last] = std::ranges::minmax(*pose);
  if (last - first != 6 || first == 0) return std::nullopt;
  for (std::size_t k = 0; k < 7; ++k) columns.pose[k] = (*pose)[k] - first + 1;
  columns.unit = unit_of(names[first - 1]);
  columns.most = std::max(usual.most, names.size() - first + 1);
  return columns;
}

}  // namespace mh
