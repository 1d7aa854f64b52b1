// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/find_program.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "slam/io/file_errors.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A word or an operator of a command.
struct Token {
  char op = 0;                      ///< ; & | < > ( ) or newline; 0 = a word
  std::string raw;                  ///< as written
  std::optional<std::string> text;  ///< after the shell's expansion; absent if not understood
};

/// Splits a command as /bin/sh does. A word is understood if it consists of letters, quotes,
/// backslashes, a leading ~ and environment variables; not if it contains substitutions, patterns,
/// placeholders or variables that the command itself assigns.
class Scanner {
 public:
  Scanner(const std::string& command, const fs::path& folder)
      : command_(command), folder_(folder) {}

  std::vector<Token> tokens() {
    while (at_ < command_.size()) {
      const char c = command_[at_];
      if (std::string_view(" \t").find(c) != std::string_view::npos) {
        end_word();
        ++at_;
      } else if (std::string_view(";&|<>()\n").find(c) != std::string_view::npos) {
        end_word();
        // The second character of >&, >| and <& belongs to the first.
        const bool second = (c == '&' || c == '|') && at_ > 0 &&
                            (command_[at_ - 1] == '>' || command_[at_ - 1] == '<');
        if (!second) tokens_.push_back({.op = c, .raw = std::string(1, c), .text = {}});
        ++at_;
      } else if (c == '#' && !in_word_) {
        at_ = std::min(command_.find('\n', at_), command_.size());
      } else {
        if (!in_word_) begin_word();
        take(c);
      }
    }
    end_word();
    return std::move(tokens_);
  }
  /// The environment variables found so far, with their values; absent if not set.
  const std::map<std::string, std::optional<std::string>>& variables() const { return variables_; }

 private:
  void begin_word() {
    in_word_ = true;
    begin_ = at_;
    text_ = "";
  }
  void end_word() {
    if (!in_word_) return;
    in_word_ = false;
    const std::string raw = command_.substr(begin_, at_ - begin_);
    if (const auto end = raw.find('='); end != std::string::npos)
      assigned_.insert(raw.substr(0, end));
    tokens_.push_back({.op = 0, .raw = raw, .text = std::move(text_)});
  }
  void add(std::string_view more) {
    if (text_) *text_ += more;
  }
  /// Skips past the next `end`; the current word is then not understood.
  void skip_past(char end) {
    text_.reset();
    at_ = std::min(command_.find(end, at_), command_.size() - 1) + 1;
  }

  void take(char c) {
    const std::size_t start = at_++;
    if (c == '\'') {
      const std::size_t end = std::min(command_.find('\'', at_), command_.size());
      const std::string inside = command_.substr(at_, end - at_);
      at_ = std::min(end + 1, command_.size());
      add_literal(inside);
    } else if (c == '"') {
      take_double_quoted();
    } else if (c == '\\') {
      if (at_ < command_.size() && command_[at_] != '\n') add({&command_[at_], 1});
      ++at_;
    } else if (c == '$') {
      take_dollar(false);
    } else if (c == '`') {
      skip_past('`');
    } else if (c == '~' && start == begin_) {
      const char* home = std::getenv("HOME");
      const bool own = at_ == command_.size() ||
                       std::string_view("/ \t;&|\n").find(command_[at_]) != std::string_view::npos;
      if (home != nullptr && own && !assigned_.contains("HOME"))
        add(home);
      else
        text_.reset();
    } else if (std::string_view("*?[{}").find(c) != std::string_view::npos) {
      text_.reset();
    } else {
      add({&c, 1});
    }
  }

  /// Placeholders are replaced within quotes, too.
  void add_literal(const std::string& inside) {
    if (inside.find('{') != std::string::npos)
      text_.reset();
    else
      add(inside);
  }

  void take_double_quoted() {
    while (at_ < command_.size() && command_[at_] != '"') {
      const char c = command_[at_++];
      if (c == '\\' && at_ < command_.size() &&
          std::string_view("$`\"\\").find(command_[at_]) != std::string_view::npos)
        add({&command_[at_++], 1});
      else if (c == '$')
        take_dollar(true);
      else if (c == '`')
        skip_past('`');
      else
        add_literal(std::string(1, c));
    }
    ++at_;
  }

  /// Parses what follows a dollar sign.
  void take_dollar(bool quoted) {
    const bool braced = at_ < command_.size() && command_[at_] == '{';
    if (at_ < command_.size() && command_[at_] == '(') {
      text_.reset();
      int depth = 0;
      do {
        depth += command_[at_] == '(' ? 1 : command_[at_] == ')' ? -1 : 0;
        ++at_;
      } while (at_ < command_.size() && depth > 0);
      return;
    }
    if (braced) ++at_;
    std::string name;
    while (at_ < command_.size() &&
           (std::isalnum(static_cast<unsigned char>(command_[at_])) || command_[at_] == '_'))
      name += command_[at_++];
    if (braced && (at_ == command_.size() || command_[at_] != '}')) return skip_past('}');
    if (braced) ++at_;
    const std::optional<std::string> value = value_of(name);
    // Without quotes, the shell splits a value at whitespace and expands patterns in it.
    if (!value || (!quoted && value->find_first_of(" \t\n*?[") != std::string::npos))
      text_.reset();
    else
      add(*value);
  }

  std::optional<std::string> value_of(const std::string& name) {
    if (name.empty() || assigned_.contains(name)) return std::nullopt;
    if (name == "PWD") return fs::absolute(folder_).lexically_normal().string();
    const char* found = std::getenv(name.c_str());
    return variables_[name] = found == nullptr ? std::nullopt : std::optional<std::string>(found);
  }

  const std::string& command_;
  const fs::path& folder_;
  std::size_t at_ = 0, begin_ = 0;
  bool in_word_ = false;
  std::optional<std::string> text_;
  std::set<std::string> assigned_;
  std::map<std::string, std::optional<std::string>> variables_;
  std::vector<Token> tokens_;
};

/// What the shell starts for a word without a slash: a path from PATH, the name of a builtin or
/// keyword, or nothing.
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

/// A word of a command and its role in it.
struct Word {
  Token token;
  bool program = false;    ///< the shell looks it up: the first word of a simple command
  bool elsewhere = false;  ///< it follows a `cd`, so its folder is unknown
};

/// The words that name what is run or read; files that > or tee writes to are left out.
std::vector<Word> words_of(const OutsideProgram& program) {
  std::vector<Word> words;
  bool begins = true, written = false, elsewhere = false, tee = false;
  for (Token& token : Scanner(program.command, program.folder).tokens()) {
    if (token.op != 0) {
      written = token.op == '>';
      if (token.op != '>' && token.op != '<') begins = true, tee = false;
      continue;
    }
    if (written) {
      written = false;
      continue;
    }
    const bool assignment =
        begins && token.raw.find('=') != std::string::npos && token.raw.find('=') > 0;
    const bool passes = token.raw == "exec" || token.raw == "{" || token.raw == "}" ||
                        token.raw == "!" || token.raw == "then" || token.raw == "do" ||
                        token.raw == "else" || token.raw == "if" || token.raw == "while";
    if (begins && passes) continue;
    const bool is_program = begins && !assignment;
    if (is_program) {
      begins = false;
      tee = token.text && (*token.text == "tee" || token.text->ends_with("/tee"));
      elsewhere = elsewhere || token.raw == "cd";
    } else if (tee) {
      continue;
    }
    words.push_back({std::move(token), is_program, elsewhere});
  }
  return words;
}

/// The path that a word refers to.
fs::path place_of(const OutsideProgram& program, const std::string& text) {
  return program.folder / text;  // absolute if `text` is
}

std::vector<fs::path> folders_on_path() {
  std::vector<fs::path> folders;
  const char* const path = std::getenv("PATH");
  std::istringstream text(path == nullptr ? "" : path);
  for (std::string folder; std::getline(text, folder, ':');) folders.emplace_back(folder);
  return folders;
}

/// A file of files_of(), whether it exists or not.
struct NamedFile : ProgramFile {
  bool on_path = false;  ///< found in a folder of PATH
};

std::vector<NamedFile> named_files(const OutsideProgram& program) {
  std::vector<NamedFile> files;
  bool found_program = false;
  for (const Word& word : words_of(program)) {
    if (!word.token.text) continue;
    const std::string& text = *word.token.text;
    if (word.program && text.find('/') == std::string::npos) {
      if (found_program) continue;
      const fs::path file = what_the_shell_starts(text);
      found_program = file.is_absolute();  // else a shell builtin or keyword
      if (found_program) files.push_back({{word.token.raw, file}, true});
      continue;
    }
    found_program = found_program || word.program;
    const auto add_part = [&](const std::string& raw, const std::string& part) {
      if (!part.empty() && (part[0] == '/' || !word.elsewhere))
        files.push_back({{raw, place_of(program, part)}});
    };
    add_part(word.token.raw, text);
    if (const auto end = text.find('='); end != std::string::npos)
      add_part(word.token.raw.substr(word.token.raw.find('=') + 1), text.substr(end + 1));
  }
  for (const std::string& file : {program.library, program.settings})
    if (!file.empty()) files.push_back({{file, program.folder / file}});
  if (program.is_library()) files.push_back({{"modelhouse-library-host", library_host()}});
  for (const std::string& input : program.inputs)
    files.push_back({{input, program.folder / input}});
  return files;
}

}  // namespace

void require_program(const OutsideProgram& program) {
  const std::string who = (program.place.empty() ? "" : program.place + ": ") + described(program);
  if (program.is_library()) {
    if (const char* reason = why_unreadable(program.folder / program.library); reason != nullptr)
      throw InputError(fmt::format("{} cannot be loaded: {}; has it been built?", who, reason));
    return;
  }
  const std::vector<Word> words = words_of(program);
  const auto first = std::ranges::find_if(words, &Word::program);
  if (first == words.end() || !first->token.text) return;
  const std::string& word = *first->token.text;
  if (word.empty() || word[0] == '-') return;
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: '{}' cannot be started: {}", who, word, why));
  };
  if (word.find('/') != std::string::npos) {
    const fs::path file = place_of(program, word);
    if (const char* reason = why_unreadable(file);
        reason != nullptr && std::string_view(reason) != "no permission")
      refuse(std::string(reason) + "; has it been built?");
    if (access(file.c_str(), X_OK) != 0) refuse("it may not be executed");
    return;
  }
  if (what_the_shell_starts(word).empty()) refuse("no such program on PATH");
}

fs::path library_host() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "modelhouse-library-host";
}

std::vector<ProgramFile> files_of(const OutsideProgram& program) {
  std::vector<ProgramFile> files;
  for (NamedFile& named : named_files(program)) {
    std::error_code error;
    const bool known =
        std::ranges::any_of(files, [&](const ProgramFile& f) { return f.word == named.word; });
    if (!known && fs::is_regular_file(named.file, error) &&
        access(named.file.c_str(), R_OK) == 0)  // a program may be executable but not readable
      files.push_back(std::move(named));
  }
  return files;
}

std::vector<fs::path> places_of(const OutsideProgram& program) {
  std::vector<fs::path> places;
  for (const NamedFile& named : named_files(program)) {
    if (named.on_path)
      for (const fs::path& folder : folders_on_path()) {
        const fs::path place = folder / named.file.filename();
        if (place == named.file) break;
        places.push_back(place);
      }
    places.push_back(named.file);
  }
  return places;
}

std::map<std::string, std::optional<std::string>> variables_of(const OutsideProgram& program) {
  Scanner scanner(program.command, program.folder);
  scanner.tokens();
  return scanner.variables();
}

std::string unseen_program(const OutsideProgram& program) {
  if (!program.inputs.empty()) return {};
  const std::vector<ProgramFile> seen = files_of(program);
  for (const Word& word : words_of(program)) {
    if (!word.program) continue;
    const auto& text = word.token.text;
    if (text && text->find('/') == std::string::npos &&
        !fs::path(what_the_shell_starts(*text)).is_absolute())
      continue;  // a shell builtin or keyword
    if (std::ranges::any_of(seen, [&](const ProgramFile& f) { return f.word == word.token.raw; }))
      return {};
    return fmt::format(
        "warning: outside program '{}': cannot tell which file '{}' is: list it under `inputs`, or "
        "old results are kept when it changes",
        program.name, word.token.raw);
  }
  return {};
}

}  // namespace mh
