// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/systems/outside_program.hpp"

namespace mh {

/// Finds out before the work whether the first program of an outside command exists and may be
/// executed, looked for as /bin/sh will: by its path from the program's folder, or on PATH. A
/// command that begins with anything but a plain word (a variable, a quote, a bracket) is not
/// judged.
/// @throws InputError naming system, command and program.
void require_program(const OutsideProgram& program);

}  // namespace mh
