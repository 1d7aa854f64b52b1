// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

struct aiScene;

namespace mh {

/// Cuts faces of very many corners like a fan, which is right where they are convex: assimp's
/// triangulation takes the square of the corners and more, half a minute for 60,000.
/// @param warnings  one line for every mesh that has such faces; may be null.
void cut_large_faces(const aiScene& in, const std::filesystem::path& file,
                     std::vector<std::string>* warnings);

}  // namespace mh
