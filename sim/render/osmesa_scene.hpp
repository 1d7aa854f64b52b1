// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "scenes/scene.hpp"
#include "sim/render/osmesa_context.hpp"

#ifdef MH_HAS_OSMESA
namespace mh {

/// The faces of one material, drawn together.
struct Batch {
  int first = 0, count = 0;        // faces
  GLuint texture = 0;              // 0 = none
  GLuint opacity = 0;              // 0 = no holes
  Eigen::Vector3f base, emission;  // linear, x exposure
  bool pane = false;               // emission is the light that the pane transmits
};

/// Uploads a scene to the current context: vertices, the face tables that the shaders read,
/// textures.
std::vector<Batch> load_scene(const Gl& gl, const Scene& scene, float exposure);

}  // namespace mh
#endif
