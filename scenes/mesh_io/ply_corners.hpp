// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mh {

/// Rewrites a PLY whose faces have texture coordinates of their own, as MeshLab writes them (the
/// list `texcoord`), with a separate vertex for each corner. Assimp would give a vertex the
/// coordinates of its last face.
/// @param name  names the file in messages
/// @returns nullopt for other PLYs
/// @throws InputError naming file and face: truncated, or a missing vertex.
std::optional<std::string> ply_with_corners(std::string_view bytes, const std::string& name);

}  // namespace mh
