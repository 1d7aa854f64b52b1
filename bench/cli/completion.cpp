// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/cli/declarations.hpp"

namespace mh::cli {
namespace {

/// Quotes text in single quotes for bash, zsh and fish: 'it'\''s'.
std::string in_quotes(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// Returns the first sentence of a text, for lists with one line per command.
std::string first_sentence(const std::string& text) {
  return text.substr(0, std::min(text.find(". "), text.find(';')));
}

/// "' bench'|' scene'|'scene info'": shell patterns, each with the command reached so far and a
/// word that may follow.
std::string steps(const std::vector<CommandDeclaration>& all) {
  std::vector<std::string> steps;
  for (const CommandDeclaration& command : all)
    for (const std::string& next : command.commands)
      steps.push_back(in_quotes(command.path + " " + next));
  return fmt::format("{}", fmt::join(steps, "|"));
}

std::vector<std::string> option_names(const CommandDeclaration& command) {
  std::vector<std::string> names;
  for (const OptionDeclaration& option : command.options)
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// The words to suggest for positional arguments: shipped names.
std::vector<std::string> positional_words(const CommandDeclaration& command) {
  std::vector<std::string> words;
  for (const OptionDeclaration& option : command.options)
    if (option.positional) words.insert(words.end(), option.choices.begin(), option.choices.end());
  return words;
}

std::string bash(const std::vector<CommandDeclaration>& all) {
  std::string values, words;
  for (const CommandDeclaration& command : all) {
    for (const OptionDeclaration& option : command.options)
      if (!option.positional && option.takes_value)
        for (const std::string& name : option.names)
          values += fmt::format("    {}) COMPREPLY=($(compgen -W {} -- \"$current\")); return ;;\n",
                                in_quotes(command.path + ":" + name),
                                in_quotes(fmt::format("{}", fmt::join(option.choices, " "))));
    words += fmt::format(
        "    {}) options={}; words={} ;;\n", in_quotes(command.path),
        in_quotes(fmt::format("{}", fmt::join(option_names(command), " "))),
        in_quotes(fmt::format(
            "{}", fmt::join(command.commands.empty() ? positional_words(command) : command.commands,
                            " "))));
  }
  return fmt::format(R"(# bash completion of modelhouse, made by: modelhouse completion bash
_modelhouse() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} at= options= words= i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$at ${{COMP_WORDS[i]}}" in
      {}) at="${{at:+$at }}${{COMP_WORDS[i]}}" ;;
    esac
  done
  COMPREPLY=()
  case "$at:${{COMP_WORDS[COMP_CWORD-1]}}" in
{}  esac
  case "$at" in
{}  esac
  [[ $current == -* ]] && words=$options
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _modelhouse modelhouse
)",
                     steps(all), values, words);
}

/// A specification for zsh's _arguments: '--out[Folder to write]:value:_files'.
std::string zsh_option(const OptionDeclaration& option, const std::string& name) {
  std::string meaning;
  for (const char c : first_sentence(option.meaning)) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') meaning += '\\';
    meaning += c;
  }
  std::string spec = fmt::format("{}[{}]", name, meaning);
  if (option.takes_value)
    spec += option.choices.empty() ? ":value:_files"
                                   : fmt::format(":value:({})", fmt::join(option.choices, " "));
  return in_quotes(spec);
}

std::string zsh(const std::vector<CommandDeclaration>& all) {
  std::string cases;
  for (const CommandDeclaration& command : all) {
    std::string specs;
    for (const OptionDeclaration& option : command.options)
      if (!option.positional)
        for (const std::string& name : option.names)
          specs += " \\\n        " + zsh_option(option, name);
    std::vector<std::string> list;
    for (const std::string& below : command.commands) {
      const std::string path = command.path.empty() ? below : command.path + " " + below;
      list.push_back(in_quotes(below + ":" + first_sentence(find_command(all, path).meaning)));
    }
    const std::vector<std::string> words = positional_words(command);
    const std::string rest =
        list.empty() ? in_quotes(words.empty()
                                     ? "*:file:_files"
                                     : fmt::format("*:file:{{_alternative "
                                                   "\"names:shipped:({})\" \"files:file:_files\"}}",
                                                   fmt::join(words, " ")))
                     : "'*::command:->command'";
    cases += fmt::format("    {})\n      list=({})\n      _arguments{} \\\n        {}\n      ;;\n",
                         in_quotes(command.path), fmt::join(list, " "), specs, rest);
  }
  return fmt::format(R"(#compdef modelhouse
# zsh completion of modelhouse, made by: modelhouse completion zsh
_modelhouse() {{
  local at= i state
  local -a list
  for ((i = 2; i < CURRENT; ++i)); do
    case "$at ${{words[i]}}" in
      {}) at="${{at:+$at }}${{words[i]}}" ;;
    esac
  done
  case "$at" in
{}  esac
  [[ $state == command ]] && _describe command list
}}
compdef _modelhouse modelhouse
)",
                     steps(all), cases);
}

std::string fish(const std::vector<CommandDeclaration>& all) {
  std::vector<std::string> known;
  for (const CommandDeclaration& command : all)
    for (const std::string& next : command.commands)
      known.push_back(in_quotes(command.path + " " + next));
  std::string text =
      fmt::format(R"(# fish completion of modelhouse, made by: modelhouse completion fish
function __modelhouse_at
  set -l at ''
  for word in (commandline -opc)[2..-1]
    switch "$at $word"
      case {}
        set at (string trim "$at $word")
    end
  end
  test "$at" = "$argv[1]"
end
)",
                  fmt::join(known, " "));
  for (const CommandDeclaration& command : all) {
    const std::string at =
        fmt::format("complete -c modelhouse -n {}",
                    in_quotes(fmt::format("__modelhouse_at \"{}\"", command.path)));
    for (const std::string& below : command.commands) {
      const std::string path = command.path.empty() ? below : command.path + " " + below;
      text += fmt::format("{} -f -a {} -d {}\n", at, below,
                          in_quotes(first_sentence(find_command(all, path).meaning)));
    }
    if (const auto words = positional_words(command); command.commands.empty() && !words.empty())
      text += fmt::format("{} -a {}\n", at, in_quotes(fmt::format("{}", fmt::join(words, " "))));
    for (const OptionDeclaration& option : command.options) {
      if (option.positional) continue;
      text += at;
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (option.takes_value) text += option.choices.empty() ? " -r" : " -x";
      if (!option.choices.empty())
        text += " -a " + in_quotes(fmt::format("{}", fmt::join(option.choices, " ")));
      text += " -d " + in_quotes(first_sentence(option.meaning)) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string completion_script(const std::vector<CommandDeclaration>& all,
                              const std::string& shell) {
  if (shell == "zsh") return zsh(all);
  return shell == "fish" ? fish(all) : bash(all);
}

}  // namespace mh::cli
