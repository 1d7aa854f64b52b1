// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "slam/io/guarded_child.hpp"

namespace mh {

/// Runs a reader that relies on third-party parsers in a child process under limits, and receives
/// the scene from it. If a parser crashes, hangs or exhausts memory, the result is a one-line
/// error. A nested reader runs in the child of the outer one. What the child reads is recorded in
/// this process (ReadScope).
/// @param file      named in error messages; the innermost file if readers are nested
/// @param warnings  where to append what `load` appended; may be null.
/// @param load      reads the scene; its argument is where to append warnings.
/// @throws InputError or MachineError as `load` does; see also in_child().
Scene load_guarded(const std::filesystem::path& file, std::vector<std::string>* warnings,
                   const std::function<Scene(std::vector<std::string>*)>& load,
                   const GuardLimits& limits = {});

}  // namespace mh
