// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/find_program.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <sstream>
#include <string>
#include <utility>

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

/// What the shell says that it starts by a word without a slash: a path from PATH, the name of one
/// of its own words, or nothing.
std::string what_the_shell_starts(const std::string& word) {
  const std::string question = expand_command("command -v {word} 2>/dev/null", {{"word", word}});
  std::string answer;
  if (std::FILE* shell = popen(question.c_str(), "r"); shell != nullptr) {
    for (int c = std::fgetc(shell); c != EOF && c != '\n'; c = std::fgetc(shell))
      answer += static_cast<char>(c);
    pclose(shell);
  }
  return answer;
}

/// A command cut where the shell may cut it, and at '='; without the files that it writes to by
/// '>'.
std::vector<std::string> pieces(const std::string& command) {
  constexpr std::string_view kBetween = " \t\n;&|<>()='\"`";
  std::vector<std::string> all;
  bool written = false;
  for (std::size_t at = 0; at < command.size();) {
    const std::size_t end = std::min(command.find_first_of(kBetween, at), command.size());
    if (end > at && !std::exchange(written, false)) all.push_back(command.substr(at, end - at));
    if (end < command.size() && command[end] == '>') written = true;
    at = end + 1;
  }
  return all;
}

}  // namespace

void require_program(const OutsideProgram& program) {
  const std::string word = first_program(program.command);
  if (word.empty() || word[0] == '-') return;
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}outside program '{}' ({}): '{}' cannot be started: {}",
                                 program.place.empty() ? "" : program.place + ": ", program.name,
                                 program.command, word, why));
  };
  if (word.find('/') != std::string::npos) {
    const std::filesystem::path file = program.folder / word;
    if (const char* reason = why_unreadable(file);
        reason != nullptr && std::string_view(reason) != "no permission")
      refuse(std::string(reason) + "; has it been built?");
    if (access(file.c_str(), X_OK) != 0) refuse("it may not be executed");
    return;
  }
  if (what_the_shell_starts(word).empty()) refuse("no such program on PATH");
}

std::vector<ProgramFile> files_of(const OutsideProgram& program) {
  std::vector<ProgramFile> files;
  const auto add = [&](const std::string& word, const std::filesystem::path& file) {
    std::error_code error;
    const bool known =
        std::ranges::any_of(files, [&](const ProgramFile& f) { return f.word == word; });
    if (!known && std::filesystem::is_regular_file(file, error) &&
        access(file.c_str(), R_OK) == 0)  // a program may be one that may only be executed
      files.push_back({word, file});
  };
  const std::string first = first_program(program.command);
  if (first.find('/') == std::string::npos && !first.empty())
    if (const std::filesystem::path file = what_the_shell_starts(first); file.is_absolute())
      add(first, file);
  for (const std::string& word : pieces(program.command)) add(word, program.folder / word);
  for (const std::string& input : program.inputs) add(input, program.folder / input);
  return files;
}

}  // namespace mh
