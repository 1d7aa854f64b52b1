// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace mh {

/// Rewrites a Collada file so that assimp can read it. Removes what assimp rejects: comments,
/// whitespace before a list of numbers, and holes in polygons (which are filled). Names a file for
/// images that name none. Everything else is unchanged.
/// @param z_is_up  ignore the file's up axis, as Gazebo does
std::string repaired_collada(std::string_view text, bool z_is_up = false);

}  // namespace mh
