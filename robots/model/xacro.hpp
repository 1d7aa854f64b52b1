// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace mh {

/// Replaces a URDF's references to the xacro arguments and properties at its top, as used in the
/// TurtleBot3's files: `$(arg NAME)` by the argument's default, `${NAME}` by the property's value.
/// Line numbers stay the same.
/// @throws InputError, naming file, line and what to do, if the file contains any other xacro.
std::string with_xacro_names(std::string urdf, const std::filesystem::path& file);

}  // namespace mh
