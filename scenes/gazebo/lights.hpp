// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include <sdf/Light.hh>

#include "scenes/scene.hpp"

namespace mh::gazebo {

/// Converts a light of a world: surfaces appear about as bright as in Gazebo. A directional light
/// becomes a sun; a point or spot light becomes a lamp that shines in all directions and fades with
/// the square of the distance, with the file's brightness at 2 m.
Light light_of(const sdf::Light& light, const Eigen::Affine3d& world_from_light);

/// Length (m) to which edges are split so that light, which is stored per vertex, can vary over a
/// floor of two triangles: 1 m, or more if that would give over a million faces.
float edge_for_light_m(const Scene& scene);

}  // namespace mh::gazebo
