// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "slam/io/printable.hpp"

namespace mh {

/// Bad input: a file, a setting or an argument that the user can fix. The message names file, place
/// and value. The command line prints it as one line on stderr and exits with code 2. It is passed
/// through printable(), since it quotes files and is written into JSON.
struct InputError : std::runtime_error {
  explicit InputError(const std::string& message) : std::runtime_error(printable(message)) {}
};

/// The machine failed (disk full, time limit, memory): exit code 3.
struct MachineError : std::runtime_error {
  explicit MachineError(const std::string& message) : std::runtime_error(printable(message)) {}
};

}  // namespace mh
