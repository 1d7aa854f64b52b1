// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace mh {

/// Bad input: a file, a setting or an argument that the user can mend. The message names file,
/// place and value. The command line turns it into one line on stderr and exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine failed the work (disk full, time limit, memory): exit code 3.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace mh
