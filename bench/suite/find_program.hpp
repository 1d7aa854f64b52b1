// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/suite/outside_program.hpp"

namespace mh {

/// Checks before any work that the library exists, or that the first program of an outside command
/// exists and is executable. It is looked up in the same way as /bin/sh will: by its path from the
/// program's folder, or on PATH. A first word that is not understood (see files_of) is not checked.
/// @throws InputError naming the suite's line, system, command and program.
void require_program(const OutsideProgram& program);

/// A file that an outside program consists of or reads, as far as the suite names it.
struct ProgramFile {
  std::string word;            ///< as written in the suite
  std::filesystem::path file;  ///< its path
};

/// Lists these files, each once: the command's first program that is not a shell builtin or
/// keyword, as /bin/sh will find it; every other word of the command that names a regular file
/// relative to the program's folder (also after a '='); the library, settings and inputs, and the
/// program that runs a library. Quotes,
/// backslashes, a leading ~ and environment variables are understood. Left out are files that do
/// not exist or cannot be read, those that > or tee writes to, relative words after a `cd`, and
/// words with a placeholder, a pattern, a substitution or a variable that the command sets.
std::vector<ProgramFile> files_of(const OutsideProgram& program);

/// Lists the places where a file that appears, changes or goes away would change what files_of()
/// lists: its files, those that do not exist yet, and for a program on PATH the same name in the
/// folders before it.
std::vector<std::filesystem::path> places_of(const OutsideProgram& program);

/// The program that runs systems in shared libraries, beside this program.
std::filesystem::path library_host();

/// The environment variables that the command names, with their values; absent if not set.
/// Variables that it sets itself, and PWD, are left out.
std::map<std::string, std::optional<std::string>> variables_of(const OutsideProgram& program);

/// Returns a warning if a command without `inputs` starts a program that files_of() does not find:
/// cached results would then be reused after a change of the program. Empty otherwise.
std::string unseen_program(const OutsideProgram& program);

}  // namespace mh
