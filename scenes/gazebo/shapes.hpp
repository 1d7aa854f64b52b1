// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <sdf/Geometry.hh>

#include "scenes/scene.hpp"

namespace mh::gazebo {

/// What is wrong with a shape's dimensions; nullopt if they are valid. libsdformat does not check
/// this: it accepts any number.
std::optional<std::string> fault_of(const sdf::Geometry& geometry);

/// A box, capsule, cylinder, ellipsoid, plane or sphere as one object, centered on its own origin;
/// nullopt for other kinds. A texture covers each side once.
std::optional<Scene> shape_of(const sdf::Geometry& geometry, const Material& look);

}  // namespace mh::gazebo
