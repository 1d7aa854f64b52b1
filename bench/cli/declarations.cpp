// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/declarations.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/suite/shipped.hpp"
#include "slam/io/suggest.hpp"

namespace mh::cli {
namespace {

/// The words of "TEXT:{tum,scannet}".
std::vector<std::string> words_in(const std::string& type) {
  const auto open = type.find('{'), close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  std::istringstream list(type.substr(open + 1, close - open - 1));
  std::vector<std::string> words;
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

/// The kind of shipped file that an option (given by its name) takes.
std::optional<Shipped> shipped_for(const std::string& name) {
  if (name == "suite") return Shipped::kSuite;
  if (name == "scene" || name == "scenes" || name == "--scene") return Shipped::kScene;
  if (name == "tour" || name == "--tour" || name == "--motion") return Shipped::kTour;
  if (name == "--robot") return Shipped::kRobot;
  if (name == "--level") return Shipped::kLevel;
  if (name == "--vocabulary") return Shipped::kVocabulary;
  if (name == "--settings") return Shipped::kSettings;
  return std::nullopt;
}

OptionDeclaration declaration(const CLI::Option& option) {
  OptionDeclaration made;
  made.positional = option.get_positional();
  if (made.positional) made.names = {option.get_name(true, false)};
  for (const std::string& name : option.get_lnames()) made.names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) made.names.push_back("-" + name);
  made.meaning = option.get_description();
  made.usual = option.get_default_str();
  made.takes_value = option.get_items_expected_max() > 0;  // a flag expects none
  made.required = option.get_required();
  made.choices = words_in(option.get_type_name());
  if (made.choices.empty())
    if (const auto what = shipped_for(made.names.front())) {
      made.choices = shipped_names(*what);
      made.or_file = true;
    }
  return made;
}

void collect(const CLI::App& app, const std::string& path, std::vector<CommandDeclaration>& all) {
  CommandDeclaration made{
      .path = path, .meaning = app.get_description(), .footer = app.get_footer()};
  for (const CLI::Option* option : app.get_options()) made.options.push_back(declaration(*option));
  const auto listed =
      app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
  for (const CLI::App* sub : listed) made.commands.push_back(sub->get_name());
  all.push_back(std::move(made));
  for (const CLI::App* sub : listed)
    collect(*sub, path.empty() ? sub->get_name() : path + " " + sub->get_name(), all);
}

std::string path_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : path_of(*app.get_parent()) + " " + app.get_name();
}

}  // namespace

std::vector<CommandDeclaration> declarations(const CLI::App& app) {
  std::vector<CommandDeclaration> all;
  collect(app, "", all);
  return all;
}

const CommandDeclaration& find_command(const std::vector<CommandDeclaration>& all,
                                       const std::string& path) {
  const auto found = std::ranges::find(all, path, &CommandDeclaration::path);
  if (found == all.end()) throw std::logic_error("no command " + path);
  return *found;
}

const CLI::App& reached(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

void add_declarations(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* completion =
      app.add_subcommand("completion", "Prints a script that completes commands and options.");
  completion->add_option("shell", *shell, "Shell that runs the script")
      ->required()
      ->check(one_of_words({"bash", "zsh", "fish"}));
  completion->footer(
      "Example:\n  modelhouse completion bash > "
      "~/.local/share/bash-completion/completions/modelhouse");
  completion->callback(
      [shell, &app] { fmt::print("{}", completion_script(declarations(app), *shell)); });

  CLI::App* manual = app.add_subcommand("manual", "Prints the manual page (roff).");
  manual->footer("Example:\n  modelhouse manual | man -l -");
  manual->callback([&app] { fmt::print("{}", manual_page(declarations(app))); });
}

std::string explain(const CLI::ParseError& error, const CLI::App& app) {
  const CLI::App& at = reached(app);
  const std::string path = path_of(at);
  const std::string see = fmt::format(" ({} --help)", path);
  std::vector<CommandDeclaration> own;
  collect(at, "", own);
  const std::vector<std::string> left = app.remaining(true);
  const auto option = std::ranges::find_if(
      left, [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
  if (option != left.end()) {
    const std::string name = option->substr(0, option->find('='));
    std::vector<std::string> names;
    for (const OptionDeclaration& o : own.front().options)
      if (!o.positional) names.insert(names.end(), o.names.begin(), o.names.end());
    return fmt::format("{} takes no {}{}{}", path, name, did_you_mean(name, names), see);
  }
  if (!left.empty() && !own.front().commands.empty())
    return fmt::format("'{}' is not a command of {}{}", left.front(), path,
                       hint(left.front(), own.front().commands));
  if (!left.empty()) return fmt::format("{}: unexpected argument '{}'{}", path, left.front(), see);
  return error.what() + (dynamic_cast<const CLI::RequiredError*>(&error) ? see : std::string());
}

}  // namespace mh::cli
