// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/mesh_io/gltf/data.hpp"

namespace mh::gltf {

/// Removes what moves: animations and skins, whose meshes stay in their modeled pose.
void drop_movement(Json& gltf);

/// Empties the nodes that KHR_node_visibility hides.
void drop_hidden(Json& gltf);

/// Replaces a node of EXT_mesh_gpu_instancing by one node of that name per instance.
void place_instances(Json& gltf, Data& data);

}  // namespace mh::gltf
