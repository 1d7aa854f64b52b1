// SPDX-License-Identifier: Apache-2.0
#include "sim/world/sequence.hpp"

#include <cassert>
#include <utility>

namespace mh {

SimulatedSequence::SimulatedSequence(std::shared_ptr<const Renderer> renderer, Camera camera,
                                     std::vector<TimedPose> world_from_camera, SensorConfig sensors,
                                     LabelMode labels)
    : renderer_(std::move(renderer)),
      camera_(camera),
      path_(std::move(world_from_camera)),
      sensors_(sensors),
      labels_(labels) {
  assert(renderer_ != nullptr);
}

SimulatedFrame SimulatedSequence::at(std::size_t i, RandomStream attempt) const {
  assert(i < path_.size());
  const TimedPose& moment = path_[i];
  const RenderedFrame picture = renderer_->render(camera_, moment.world_from_camera);
  return {sense(picture, camera_, sensors_, labels_, attempt.fork(i), moment.stamp_ns),
          {moment.stamp_ns, moment.world_from_camera}};
}

}  // namespace mh
