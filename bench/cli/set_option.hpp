// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "slam/core/error.hpp"

namespace mh::cli {

/// The command line's values for `${NAME}` in a suite: --set NAME=VALUE.
struct SetOption {
  std::vector<std::string> given;

  void add_to(CLI::App& command) {
    command
        .add_option("--set", given,
                    "NAME=VALUE: what ${NAME} in the suite stands for; a file or folder is seen "
                    "from here")
        ->allow_extra_args(false);
  }

  /// @throws InputError unless each is NAME=VALUE, each name once.
  std::map<std::string, std::string> values() const {
    namespace fs = std::filesystem;
    std::map<std::string, std::string> values;
    for (const std::string& word : given) {
      const std::size_t equals = word.find('=');
      if (equals == std::string::npos || equals == 0)
        throw InputError(fmt::format("--set {}: is not NAME=VALUE", word));
      const std::string name = word.substr(0, equals);
      std::string value = word.substr(equals + 1);
      std::error_code error;
      // The suite's paths are relative to its folder; the user's are relative to the working
      // directory.
      if (!value.empty() && fs::exists(value, error))
        value = fs::absolute(value).lexically_normal().string();
      if (!values.emplace(name, value).second)
        throw InputError(fmt::format("--set {}: is set twice", name));
    }
    return values;
  }
};

}  // namespace mh::cli
