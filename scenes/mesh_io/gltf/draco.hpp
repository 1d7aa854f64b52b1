// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/mesh_io/gltf/data.hpp"

namespace mh::gltf {

/// Replaces primitives that use KHR_draco_mesh_compression with the decompressed triangles.
/// @throws InputError if the compression is damaged.
void decompress_primitives(Json& gltf, Data& data);

}  // namespace mh::gltf
