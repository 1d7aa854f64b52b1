// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

struct aiScene;

namespace mh {

/// Triangulates faces with very many corners as fans, which is correct for convex ones: assimp's
/// triangulation takes time at least quadratic in the number of corners, half a minute for 60,000.
/// @param warnings  one line for every mesh that has such faces; may be null.
void cut_large_faces(const aiScene& in, const std::filesystem::path& file,
                     std::vector<std::string>* warnings);

}  // namespace mh
