// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/scene.hpp"

namespace mh {

/// Computes the box of every instance from its faces; zero if it has none.
void find_boxes(Scene& scene);

/// For a mesh without a plan: makes the box of each floor a room, for consumers that need places
/// where people can stand (metering, previews, plans). @pre boxes are set
void rooms_from_floors(Scene& scene);

}  // namespace mh
