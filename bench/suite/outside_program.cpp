// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/outside_program.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <functional>
#include <span>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

constexpr std::string_view kOfDataset[] = {"dataset", "associations", "settings",
                                           "labels",  "trajectory",   "seed"};
constexpr std::string_view kOfConversation[] = {"settings", "seed"};

/// Copies text, replacing each {word} with what `replace` returns. A brace after a dollar sign
/// belongs to the shell.
std::string replace_placeholders(std::string_view text,
                                 const std::function<std::string(std::string_view)>& replace) {
  std::string result;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool ours = text[at] == '{' && (at == 0 || text[at - 1] != '$');
    const std::size_t end = ours ? text.find('}', at) : std::string_view::npos;
    const std::string_view word =
        end == std::string_view::npos ? std::string_view() : text.substr(at + 1, end - at - 1);
    const bool is_word = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    });
    if (!is_word) {
      result += text[at];
      continue;
    }
    result += replace(word);
    at = end;
  }
  return result;
}

/// The first quoted part of a command that wrongly contains a placeholder; empty if there is none.
/// A placeholder's value comes with its own single quotes: within single quotes, they would end the
/// quoted part; within double quotes, they would be literal. Double-quoted parts with spaces are
/// accepted, since they may be commands for another shell ("sh -c").
std::string quoted_placeholder(const std::string& command) {
  for (std::size_t at = command.find_first_of("'\"\\"); at < command.size();
       at = command.find_first_of("'\"\\", at)) {
    if (command[at] == '\\') {
      at += 2;
      continue;
    }
    const std::size_t end = std::min(command.find(command[at], at + 1), command.size() - 1);
    const std::string part = command.substr(at, end + 1 - at);
    bool holds = false;
    replace_placeholders(part, [&](std::string_view) {
      holds = true;
      return std::string();
    });
    if (holds && (part[0] == '\'' || part.find(' ') == std::string::npos)) return part;
    at = end + 1;
  }
  return {};
}

}  // namespace

std::string shell_quoted(std::string_view value) {
  std::string result = "'";
  for (const char c : value) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

void validate(const OutsideProgram& program) {
  limits(program, [&](const char* key, double value, const SettingRange& range, auto&&...) {
    if (!allows(range, value))
      throw InputError(
          fmt::format("{}: {}: {} is outside {}", program.name, key, value, interval(range)));
  });
  if (program.is_library()) return;
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}: command: {}", program.name, what));
  };
  if (program.command.find_first_not_of(" \t\n") == std::string::npos) fail("is empty");
  const bool dataset = program.mode == OutsideMode::kTrajectory;
  const std::span<const std::string_view> known =
      dataset ? std::span<const std::string_view>(kOfDataset) : kOfConversation;
  bool writes_trajectory = false;
  replace_placeholders(program.command, [&](std::string_view word) {
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      std::string list;
      for (const std::string_view name : known) list += fmt::format(" {{{}}}", name);
      fail(fmt::format("'{{{}}}' is not one of{}", word, list));
    }
    writes_trajectory |= word == "trajectory";
    return std::string();
  });
  if (const std::string quoted = quoted_placeholder(program.command); !quoted.empty())
    fail(fmt::format("{} is inside quotes: its value is already quoted", quoted));
  if (dataset && !writes_trajectory)
    fail("{trajectory} is missing: where should the program write its poses?");
}

std::string described(const OutsideProgram& program) {
  return program.is_library()
             ? fmt::format("outside library '{}' ({})", program.name, program.library)
             : fmt::format("outside program '{}' ({})", program.name, program.command);
}

std::string fill_in(std::string_view command, std::string_view placeholder,
                    std::string_view value) {
  return replace_placeholders(command, [&](std::string_view word) {
    return word == placeholder ? shell_quoted(value) : fmt::format("{{{}}}", word);
  });
}

std::string expand_command(
    std::string_view command,
    const std::vector<std::pair<std::string_view, std::string>>& placeholders) {
  return replace_placeholders(command, [&](std::string_view word) {
    for (const auto& [name, value] : placeholders)
      if (name == word) return shell_quoted(value);
    assert(!"a placeholder without a value");
    return std::string();
  });
}

}  // namespace mh
