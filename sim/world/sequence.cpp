// SPDX-License-Identifier: Apache-2.0
#include "sim/world/sequence.hpp"

#include <utility>

namespace mh {
namespace {

Shutter::SceneAt scene_at(std::shared_ptr<const Renderer> renderer,
                          std::shared_ptr<const PedestrianScene> pedestrian_scene) {
  if (pedestrian_scene)
    return [pedestrian_scene = std::move(pedestrian_scene)](Stamp stamp_ns) {
      return pedestrian_scene->at(stamp_ns);
    };
  return [renderer = std::move(renderer)](Stamp) { return renderer; };
}

}  // namespace

SimulatedSequence::SimulatedSequence(std::shared_ptr<const Renderer> renderer, Camera camera,
                                     std::vector<TimedPose> world_from_camera, SensorConfig sensors,
                                     LabelMode labels,
                                     std::shared_ptr<const PedestrianScene> pedestrian_scene)
    : shutter_(scene_at(std::move(renderer), std::move(pedestrian_scene)), camera,
               std::move(world_from_camera), sensors),
      sensors_(sensors),
      labels_(labels) {}

SimulatedFrame SimulatedSequence::at(std::size_t i, RandomStream attempt) const {
  const TimedPose& moment = path()[i];
  const Shutter::Exposed exposed = shutter_.expose(i, labels_);
  RgbdFrame frame =
      sense(exposed.seen, camera(), sensors_, attempt.fork(i), moment.stamp_ns, exposed.gain);
  frame.semantics =
      sense_labels(exposed.seen, labels_, sensors_, moment.world_from_camera, attempt.fork(i));
  return {std::move(frame), {moment.stamp_ns, moment.world_from_camera}};
}

}  // namespace mh
