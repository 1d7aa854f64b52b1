// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/simulated_sequence.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

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

/// Senses what the shutter exposed at the path's i-th pose; without labels.
RgbdFrame sense_exposed(const Shutter& shutter, const SensorConfig& sensors, std::size_t i,
                        RandomStream noise, const Shutter::Exposed& exposed) {
  return sense(exposed.seen, shutter.camera(), sensors, noise.fork(i), shutter.path()[i].stamp_ns,
               exposed.gain);
}

/// Labels what is seen at the path's i-th pose; uses only classes and instances of `seen`.
SemanticImage label_exposed(const Shutter& shutter, const SensorConfig& sensors, LabelMode labels,
                            std::size_t i, RandomStream noise, const RenderedFrame& seen) {
  return sense_labels(seen, labels, sensors, shutter.path()[i].world_from_camera, noise.fork(i));
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
  images_ = images;
  // Annotated labels need exposures with the classes at the stamp; all other labels share the same
  // exposures.
  name_ = labels_ == LabelMode::kAnnotated ? name + "-annotated" : name;
  shared_ = std::make_unique<SharedExposures>(images, name_, camera(), size());
}

SensedMoment sense_moment(const Shutter& shutter, const SensorConfig& sensors, LabelMode labels,
                          std::size_t i, RandomStream noise) {
  Shutter::Exposed exposed = shutter.expose(i, labels);
  RgbdFrame frame = sense_exposed(shutter, sensors, i, noise, exposed);
  frame.semantics = label_exposed(shutter, sensors, labels, i, noise, exposed.seen);
  return {std::move(frame), std::move(exposed.seen)};
}

/// The file of frames with this noise; null if they are not shared.
SharedExposures* SimulatedSequence::shared_with(RandomStream noise) const {
  const auto at = std::ranges::find(images_.noises, noise.key(), &RandomStream::key);
  if (at == images_.noises.end()) return nullptr;
  const std::lock_guard only_one(opening_);
  std::unique_ptr<SharedExposures>& file = noisy_[noise.key()];
  if (!file)
    file = std::make_unique<SharedExposures>(
        images_,
        fmt::format("{}/{}-{}", folder_of(images_.noises), name_, at - images_.noises.begin()),
        camera(), size());
  return file.get();
}

Shutter::Exposed SimulatedSequence::exposed(std::size_t i) const {
  const auto expose = [&](std::size_t k) { return shutter_.expose(k, labels_); };
  return shared_ ? shared_->get(i, expose) : expose(i);
}

/// The exposure, with its color and depth replaced by the sensor's.
Shutter::Exposed SimulatedSequence::noisy(std::size_t i, RandomStream noise) const {
  const auto add_noise = [&](std::size_t k) {
    Shutter::Exposed made = exposed(k);
    RgbdFrame frame = sense_exposed(shutter_, sensors_, k, noise, made);
    made.seen.color = std::move(frame.color);
    made.seen.depth_m = std::move(frame.depth_m);
    return made;
  };
  SharedExposures* shared = shared_with(noise);
  return shared != nullptr ? shared->get(i, add_noise) : add_noise(i);
}

RgbdFrame SimulatedSequence::frame(std::size_t i, RandomStream noise) const {
  RenderedFrame seen = noisy(i, noise).seen;
  SemanticImage semantics = label_exposed(shutter_, sensors_, labels_, i, noise, seen);
  RgbdFrame made{stamp_ns(i), std::move(seen.color), std::move(seen.depth_m), std::move(semantics)};
  if (!odom_from_camera_.empty()) made.odom_from_camera = odom_from_camera_[i];
  if (lasers_) made.lasers = lasers_(i);
  return made;
}

}  // namespace mh
