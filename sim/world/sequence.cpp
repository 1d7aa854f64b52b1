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

/// Senses and labels what the shutter exposed at the path's i-th moment.
SensedMoment sense_exposed(const Shutter& shutter, const SensorConfig& sensors, LabelMode labels,
                           std::size_t i, RandomStream noise, Shutter::Exposed exposed) {
  const TimedPose& moment = shutter.path()[i];
  const RandomStream its_noise = noise.fork(i);
  RgbdFrame frame =
      sense(exposed.seen, shutter.camera(), sensors, its_noise, moment.stamp_ns, exposed.gain);
  frame.semantics =
      sense_labels(exposed.seen, labels, sensors, moment.world_from_camera, its_noise);
  return {std::move(frame), std::move(exposed.seen)};
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

void SimulatedSequence::share(const SharedImages& images, const std::string& name) {
  const bool annotated = labels_ == LabelMode::kAnnotated;  // all other labels see the same
  shared_ = std::make_unique<SharedExposures>(images, annotated ? name + "-annotated" : name,
                                              shutter_.camera(), shutter_.path().size());
}

SensedMoment sense_moment(const Shutter& shutter, const SensorConfig& sensors, LabelMode labels,
                          std::size_t i, RandomStream noise) {
  return sense_exposed(shutter, sensors, labels, i, noise, shutter.expose(i, labels));
}

RgbdFrame SimulatedSequence::frame(std::size_t i, RandomStream noise) const {
  const auto expose = [&](std::size_t k) { return shutter_.expose(k, labels_); };
  return sense_exposed(shutter_, sensors_, labels_, i, noise,
                       shared_ ? shared_->get(i, expose) : expose(i))
      .frame;
}

}  // namespace mh
