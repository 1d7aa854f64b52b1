// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/true_map.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "slam/core/interpolate.hpp"

namespace mh {

std::optional<TruePoint> true_landmark(const Landmark& landmark,
                                       const std::vector<std::optional<TrueView>>& views) {
  std::vector<TruePoint> seen;
  for (const Observation& o : landmark.observations)
    if (const auto& view = views[o.keyframe.value])
      if (const auto& point = view->points[o.feature]) seen.push_back(*point);
  if (seen.empty()) return std::nullopt;
  const std::size_t middle = seen.size() / 2;
  TruePoint point{.in_world = {}, .depth_m = seen.front().depth_m};
  for (const int axis : {0, 1, 2}) {
    std::vector<double> along;
    for (const TruePoint& p : seen) along.push_back(p.in_world[axis]);
    std::ranges::nth_element(along, along.begin() + static_cast<std::ptrdiff_t>(middle));
    point.in_world[axis] = along[middle];
  }
  point.at_border = std::ranges::any_of(seen, &TruePoint::at_border);
  return point;
}

std::shared_ptr<const Renderer> scene_at(const SimulatedPlace& place, QuerySet set,
                                         Stamp stamp_ns) {
  const auto& walked_in = set == QuerySet::kHeldOut      ? place.pedestrian_scene
                          : set == QuerySet::kSecondTour ? place.query_pedestrian_scene
                                                         : nullptr;
  if (walked_in) return walked_in->at(stamp_ns);
  return set != QuerySet::kHeldOut && place.query_renderer ? place.query_renderer : place.renderer;
}

TrueMap true_map(const Map& map, const World& world, const TrueCamera& camera) {
  TrueMap made;
  made.views.resize(map.keyframes().size());
  for (const Keyframe& keyframe : map.keyframes()) {
    if (keyframe.erased) continue;
    made.live.push_back(keyframe.id);
    const auto pose =
        interpolated_pose(*world.mapping->truth(), keyframe.stamp_ns, kMaxTruthGap_ns);
    assert(pose);
    const auto scene = scene_at(*world.simulated, QuerySet::kHeldOut, keyframe.stamp_ns);
    made.views[keyframe.id.value] = look(*scene, camera, *pose, keyframe.features);
  }
  for (std::uint32_t i = 0; i < map.landmarks().size(); ++i) {
    const Landmark& landmark = map.at(LandmarkId{i});
    made.landmarks.push_back(landmark.erased ? std::nullopt : true_landmark(landmark, made.views));
  }
  return made;
}

}  // namespace mh
