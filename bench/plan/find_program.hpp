// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/plan/outside_program.hpp"

namespace mh {

/// Finds out before the work whether the library is there, or the first program of an outside
/// command exists and may be executed, looked for as /bin/sh will: by its path from the program's
/// folder, or on PATH. A first word that is not understood (see files_of) is not judged.
/// @throws InputError naming the suite's line, system, command and program.
void require_program(const OutsideProgram& program);

/// A file that an outside program is made of or reads, as far as the suite names it.
struct ProgramFile {
  std::string word;            ///< as it stands in the suite
  std::filesystem::path file;  ///< where it lies
};

/// The command's first program that is not one of the shell's own words, found as /bin/sh will find
/// it; every other word of the command that names a regular file from the program's folder (what
/// stands behind a '=' too); library, settings and inputs. Each once. Quotes, backslashes, a
/// leading ~ and variables of the environment are understood. Left out: what is not there or cannot
/// be read, what > or tee writes to, relative words behind a `cd`, and words with a placeholder, a
/// pattern, a substitution or a variable that the command sets.
std::vector<ProgramFile> files_of(const OutsideProgram& program);

/// A warning where the first program of a command that names no inputs is not among its files: its
/// results would outlive a change of it. Empty otherwise.
std::string unseen_program(const OutsideProgram& program);

}  // namespace mh
