// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/cli/declarations.hpp"

namespace mh::cli {
namespace {

/// Escapes text for roff, so that no line becomes a request and no '-' a hyphen.
std::string roff(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((i == 0 || text[i - 1] == '\n') && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  return result;
}

std::string option_entry(const OptionDeclaration& option) {
  std::string text =
      fmt::format(".TP\n\\fB{}\\fR", roff(fmt::format("{}", fmt::join(option.names, ", "))));
  if (option.takes_value && !option.positional)
    text += option.choices.empty() || option.choices.size() > 6
                ? " \\fIVALUE\\fR"
                : fmt::format(" \\fI{}{}\\fR", option.or_file ? "FILE|" : "",
                              roff(fmt::format("{}", fmt::join(option.choices, "|"))));
  text += "\n" + roff(option.meaning);
  if (!option.meaning.ends_with('.')) text += ".";
  if (!option.usual.empty()) text += fmt::format(" Default: {}.", roff(option.usual));
  if (option.required) text += " Required.";
  return text + "\n";
}

}  // namespace

std::string manual_page(const std::vector<CommandDeclaration>& all) {
  const CommandDeclaration& program = all.front();
  std::string text = fmt::format(
      ".\\\" Made by: modelhouse manual\n.TH MODELHOUSE 1 \"\" \"modelhouse {}\"\n.SH NAME\n"
      "modelhouse \\- test bench for object\\-aware visual SLAM\n.SH SYNOPSIS\n"
      "\\fBmodelhouse\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n{}\n",
      MH_VERSION, roff(program.meaning));
  for (const OptionDeclaration& option : program.options) text += option_entry(option);
  text += ".SH COMMANDS\n";
  for (const CommandDeclaration& command : all) {
    if (command.path.empty()) continue;
    text += fmt::format(".SS modelhouse {}\n{}\n", roff(command.path), roff(command.meaning));
    for (const OptionDeclaration& option : command.options) text += option_entry(option);
    if (!command.footer.empty()) text += fmt::format(".PP\n.nf\n{}\n.fi\n", roff(command.footer));
  }
  return text + fmt::format(".SH EXIT STATUS\n.nf\n{}\n.fi\n", roff(program.footer));
}

}  // namespace mh::cli
