// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenes/guarded_child.hpp"
#include "scenes/scene.hpp"

namespace mh {

/// Runs a reader that leans on foreign parsers in a child process under limits and takes the scene
/// over from it. A crash, a hang or a hunger for memory of theirs becomes an error in one line.
/// A reader within a reader runs in the child of the outer one. What the child reads is noted here
/// (ReadScope).
/// @param file      the innermost such file stands in the message.
/// @param warnings  where to append what `load` appended; may be null.
/// @param load      reads the scene; it is given where to append warnings.
/// @throws InputError, MachineError as `load` does, and see in_child().
Scene load_guarded(const std::filesystem::path& file, std::vector<std::string>* warnings,
                   const std::function<Scene(std::vector<std::string>*)>& load,
                   const GuardLimits& limits = {});

}  // namespace mh
