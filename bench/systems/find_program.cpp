// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/find_program.hpp"

#include <unistd.h>

#include <cctype>
#include <cstdlib>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "slam/core/file_errors.hpp"

namespace mh {
namespace {

bool is_plain(const std::string& word) {
  for (const char c : word)
    if (!std::isalnum(static_cast<unsigned char>(c)) &&
        std::string_view("_./+-@%:,=").find(c) == std::string_view::npos)
      return false;
  return true;
}

/// The word that the shell will look up: after assignments and `exec`. Empty if that is not plain.
std::string first_program(const std::string& command) {
  std::istringstream words(command);
  for (std::string word; words >> word;) {
    // The program may end before a blank does: "true;".
    if (const auto end = word.find_first_of(";&|<>"); end != std::string::npos) word.resize(end);
    if (!is_plain(word)) return {};
    if (word != "exec" && word.find('=') == std::string::npos) return word;
  }
  return {};
}

}  // namespace

void require_program(const OutsideProgram& program) {
  const std::string word = first_program(program.command);
  if (word.empty() || word[0] == '-') return;
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("outside program '{}' ({}): '{}' cannot be started: {}",
                                 program.name, program.command, word, why));
  };
  if (word.find('/') != std::string::npos) {
    const std::filesystem::path file = program.folder / word;
    if (const char* reason = why_unreadable(file);
        reason != nullptr && std::string_view(reason) != "no permission")
      refuse(reason);
    if (access(file.c_str(), X_OK) != 0) refuse("it may not be executed");
    return;
  }
  // The shell knows its own words, and PATH.
  const std::string question =
      expand_command("command -v {word} >/dev/null 2>&1", {{"word", word}});
  if (std::system(question.c_str()) != 0) refuse("no such program on PATH");
}

}  // namespace mh
