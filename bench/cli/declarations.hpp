// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace mh::cli {

/// An option, flag or positional argument as it was declared.
struct OptionDeclaration {
  std::vector<std::string> names;  ///< "--jobs"; of a positional argument "suite"
  std::string meaning;
  std::string usual;                 ///< the default; "" = none
  std::vector<std::string> choices;  ///< words that are valid or shipped under a name
  bool takes_value = false, positional = false, required = false;
};

/// A command with what it takes.
struct CommandDeclaration {
  std::string path;  ///< "scene info"; "" of the program itself
  std::string meaning, footer;
  std::vector<std::string> commands = {};  ///< below it, by their last word
  std::vector<OptionDeclaration> options = {};
};

/// Every command that help lists, each before those below it. Completion, manual page and the help
/// after a slip are made from these, so that none can fall behind.
std::vector<CommandDeclaration> declarations(const CLI::App& app);

/// The declaration of a command; never absent for a path that declarations() gave.
const CommandDeclaration& find_command(const std::vector<CommandDeclaration>& all,
                                       const std::string& path);

/// A script for "bash", "zsh" or "fish".
std::string completion_script(const std::vector<CommandDeclaration>& all, const std::string& shell);

/// A manual page in roff.
std::string manual_page(const std::vector<CommandDeclaration>& all);

/// What went wrong on the command line, in one line, with what may have been meant.
std::string explain(const CLI::ParseError& error, const CLI::App& app);

/// The command that a line reached before it ended or failed.
const CLI::App& reached(const CLI::App& app);

}  // namespace mh::cli
