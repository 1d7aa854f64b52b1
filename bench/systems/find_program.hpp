// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/systems/outside_program.hpp"

namespace mh {

/// Finds out before the work whether the first program of an outside command exists and may be
/// executed, looked for as /bin/sh will: by its path from the program's folder, or on PATH. A
/// command that begins with anything but a plain word (a variable, a quote, a bracket) is not
/// judged.
/// @throws InputError naming the suite's line, system, command and program.
void require_program(const OutsideProgram& program);

/// A file that an outside program is made of or reads, as far as the suite names it.
struct ProgramFile {
  std::string word;            ///< as it stands in the suite
  std::filesystem::path file;  ///< where it lies
};

/// The first program of the command, found as /bin/sh will find it; every other word of the command
/// that names a regular file from the program's folder (what stands behind a '=' too); the inputs.
/// Each once. What is not there or cannot be read is left out, and what is written to by '>'.
std::vector<ProgramFile> files_of(const OutsideProgram& program);

}  // namespace mh
