// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/mesh_io/gltf/data.hpp"

namespace mh::gltf {

/// Removes animations and skins; the meshes stay in their modeled pose.
void drop_movement(Json& gltf);

/// Empties the nodes that KHR_node_visibility hides.
void drop_hidden(Json& gltf);

/// Replaces each node that uses EXT_mesh_gpu_instancing with one node of the same name per
/// instance.
void place_instances(Json& gltf, Data& data);

}  // namespace mh::gltf
