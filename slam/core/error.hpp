// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace mh {

/// Bad input: a file, a setting or an argument that the user can fix. The message names file, place
/// and value. The command line prints it as one line on stderr and exits with code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine failed (disk full, time limit, memory): exit code 3.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mh
