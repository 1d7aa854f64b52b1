// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace mh {

/// A Collada file as assimp can read it: blanks before a list of numbers, which it takes for the
/// list's end, are left out. All else stays as it is.
/// @param z_is_up  whatever the file says of its up axis, as Gazebo takes it
std::string repaired_collada(std::string_view text, bool z_is_up = false);

}  // namespace mh
