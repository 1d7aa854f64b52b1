// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include <sdf/Light.hh>

#include "scenes/scene.hpp"

namespace mh::gazebo {

/// A light of a world as one of ours: what reflects it is about as bright as Gazebo shows it. A
/// directional one is a sun; a point or a spot is a lamp that shines to all sides and fades with
/// the square of the distance, as bright at 2 m as the file tells.
Light light_of(const sdf::Light& light, const Eigen::Affine3d& world_from_light);

/// The length (m) to which edges are split, so that light, which is kept at vertices, can vary over
/// a floor of two triangles: 1 m, or more where that would be a million faces.
float edge_for_light_m(const Scene& scene);

}  // namespace mh::gazebo
