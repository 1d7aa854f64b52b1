// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bench/audit/true_view.hpp"
#include "bench/protocol/metrics/query_summary.hpp"
#include "bench/protocol/world/world.hpp"
#include "slam/map/map.hpp"

namespace mh {

/// Ground truth of what a finished map shows.
struct TrueMap {
  std::vector<KeyframeId> live;  ///< the keyframes that were not erased, in order of their ids
  std::vector<std::optional<TrueView>> views;       ///< by keyframe id; absent for erased keyframes
  std::vector<std::optional<TruePoint>> landmarks;  ///< by landmark id: see true_landmark()
};

/// The point that a landmark represents: the median, per coordinate, of the points shown by the
/// keypoints that observe it, so that one wrong observation does not move it. nullopt if no
/// keypoint shows anything.
std::optional<TruePoint> true_landmark(const Landmark& landmark,
                                       const std::vector<std::optional<TrueView>>& views);

/// The scene, pedestrian included, at a time of the mapping or of the second tour.
std::shared_ptr<const Renderer> scene_at(const SimulatedPlace& place, QuerySet set, Stamp stamp_ns);

/// Renders every live keyframe at its true pose. @pre world.simulated
TrueMap true_map(const Map& map, const World& world, const TrueCamera& camera);

}  // namespace mh
