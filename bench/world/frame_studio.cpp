// SPDX-License-Identifier: Apache-2.0
#include "bench/world/frame_studio.hpp"

#include <algorithm>

namespace mh {

FrameStudio::FrameStudio(std::shared_ptr<const Renderer> renderer, Camera camera,
                         std::vector<TimedPose> world_from_camera, SensorConfig sensors,
                         std::size_t kept)
    : renderer_(std::move(renderer)),
      camera_(camera),
      path_(std::move(world_from_camera)),
      sensors_(sensors),
      kept_(kept) {}

RgbdFrame FrameStudio::frame(std::size_t index, RandomStream noise, LabelMode labels) {
  const std::shared_ptr<const Shot> picture = shot(index, noise);
  RgbdFrame frame = picture->unlabelled;
  if (labels != LabelMode::kNone) frame.semantics = label_image(picture->truth, labels);
  return frame;
}

std::shared_ptr<const FrameStudio::Shot> FrameStudio::shot(std::size_t index, RandomStream noise) {
  const Key key{index, noise.key()};
  std::promise<std::shared_ptr<const Shot>> promise;
  {
    std::unique_lock lock(mutex_);
    const auto found = std::find_if(shots_.begin(), shots_.end(),
                                    [&](const auto& entry) { return entry.first == key; });
    if (found != shots_.end()) {
      const SharedShot known = found->second;
      lock.unlock();
      return known.get();
    }
    shots_.emplace_back(key, promise.get_future().share());
    if (shots_.size() > kept_) shots_.pop_front();
  }
  try {
    auto made = std::make_shared<Shot>();
    const TimedPose& pose = path_[index];
    made->truth = renderer_->render(camera_, pose.world_from_camera);
    made->unlabelled =
        sense(made->truth, camera_, sensors_, LabelMode::kNone, noise.fork(index), pose.stamp_ns);
    promise.set_value(made);
    return made;
  } catch (...) {
    promise.set_exception(std::current_exception());
    throw;
  }
}

}  // namespace mh
