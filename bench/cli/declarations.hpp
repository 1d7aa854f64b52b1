// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace mh::cli {

/// An option, flag or positional argument as it was declared.
struct OptionDeclaration {
  std::vector<std::string> names;  ///< "--jobs"; for a positional argument, "suite"
  std::string meaning;
  std::string usual;                 ///< the default; empty if there is none
  std::vector<std::string> choices;  ///< valid words, or names of shipped files
  bool or_file = false;              ///< whether any other file is valid, too
  bool takes_value = false, positional = false, required = false;
};

/// A command with its options and subcommands.
struct CommandDeclaration {
  std::string path;  ///< "scene info"; empty for the program itself
  std::string meaning, footer;
  std::vector<std::string> commands = {};  ///< subcommands, by their last word
  std::vector<OptionDeclaration> options = {};
};

/// Returns every command that help lists, each before its subcommands. Completion, the manual page
/// and the hints after a mistake are all generated from this list, so that none of them can become
/// outdated.
std::vector<CommandDeclaration> declarations(const CLI::App& app);

/// Finds the declaration of a command. It exists for every path that declarations() returned.
const CommandDeclaration& find_command(const std::vector<CommandDeclaration>& all,
                                       const std::string& path);

/// Returns the completion script for "bash", "zsh" or "fish".
std::string completion_script(const std::vector<CommandDeclaration>& all, const std::string& shell);

/// Returns the manual page in roff.
std::string manual_page(const std::vector<CommandDeclaration>& all);

/// Explains in one line what is wrong with the command line, with a suggestion of what was meant.
std::string explain(const CLI::ParseError& error, const CLI::App& app);

/// Returns the innermost command that parsing had reached when the line ended or parsing failed.
const CLI::App& reached(const CLI::App& app);

}  // namespace mh::cli
