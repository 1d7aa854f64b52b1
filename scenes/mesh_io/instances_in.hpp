// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

namespace mh {

/// Sets the box of every instance from the faces that are its own; zero where it has none.
void find_boxes(Scene& scene);

/// For a mesh that came without a plan: the box of each floor is a room, so that those who ask
/// where people stand (metering, previews, plans) find an answer. @pre boxes are set
void rooms_from_floors(Scene& scene);

}  // namespace mh
