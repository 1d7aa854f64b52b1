// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/io/error.hpp"

namespace mh {

/// An outside program failed its run: the message names the program, its command and what it did. A
/// MachineError, so that a crash of an outside program never looks like a regression.
struct OutsideError : MachineError {
  using MachineError::MachineError;
};

}  // namespace mh
