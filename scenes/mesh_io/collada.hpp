// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace mh {

/// A Collada file as assimp can read it. Left out is what it refuses files for: blanks before a
/// list of numbers, comments, holes of polygons (which are filled). All else stays as it is.
/// @param z_is_up  whatever the file says of its up axis, as Gazebo takes it
std::string repaired_collada(std::string_view text, bool z_is_up = false);

}  // namespace mh
