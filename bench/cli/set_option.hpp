// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "slam/io/error.hpp"

namespace mh::cli {

/// The values of an option that may be given several times as NAME=VALUE.
/// @throws InputError if one is not NAME=VALUE, or if a name is given twice.
inline std::map<std::string, std::string> named_values(const std::string& option,
                                                       const std::vector<std::string>& given) {
  std::map<std::string, std::string> values;
  for (const std::string& word : given) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(fmt::format("{} {}: is not NAME=VALUE", option, word));
    if (!values.emplace(word.substr(0, equals), word.substr(equals + 1)).second)
      throw InputError(fmt::format("{} {}: is set twice", option, word.substr(0, equals)));
  }
  return values;
}

/// Values from the command line for `${NAME}` in a suite: --set NAME=VALUE.
struct SetOption {
  std::vector<std::string> given;

  void add_to(CLI::App& command) {
    command
        .add_option("--set", given,
                    "NAME=VALUE: replaces ${NAME} in the suite; a file or folder is relative to "
                    "the current folder")
        ->allow_extra_args(false);
  }

  /// @throws as named_values()
  std::map<std::string, std::string> values() const {
    namespace fs = std::filesystem;
    std::map<std::string, std::string> values = named_values("--set", given);
    std::error_code error;
    // Paths in the suite are relative to its folder, but paths from the user are relative to the
    // working directory.
    for (auto& [name, value] : values)
      if (!value.empty() && fs::exists(value, error))
        value = fs::absolute(value).lexically_normal().string();
    return values;
  }
};

}  // namespace mh::cli
