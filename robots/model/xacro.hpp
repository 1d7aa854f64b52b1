// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace mh {

/// Replaces what a URDF takes from the xacro arguments (by their defaults) and properties at its
/// top: `$(arg NAME)` and `${NAME}`, as the TurtleBot3's files have them. Lines stay where they
/// are.
/// @throws InputError, naming file, line and what to do, if the file holds any other xacro.
std::string with_xacro_names(std::string urdf, const std::filesystem::path& file);

}  // namespace mh
