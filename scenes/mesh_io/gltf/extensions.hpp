// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/mesh_io/gltf/data.hpp"

namespace mh::gltf {

/// Checks the extensions that a glTF 2.0 file lists against a table: those that are honored or
/// change nothing visible pass silently, others cause a warning.
/// @param warnings  receives a line for each visible loss
/// @throws InputError naming a required extension that is not known.
void check_extensions(Json& gltf, const std::filesystem::path& file,
                      std::vector<std::string>& warnings);

}  // namespace mh::gltf
