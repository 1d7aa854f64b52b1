// SPDX-License-Identifier: Apache-2.0
#include "bench/world/frame_studio.hpp"

#include <algorithm>
#include <chrono>

namespace mh {
namespace {

template <class Future>
bool ready(const Future& future) {
  return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

FrameStudio::FrameStudio(std::shared_ptr<const Renderer> renderer, Camera camera,
                         std::vector<TimedPose> world_from_camera, SensorConfig sensors,
                         std::size_t kept)
    : shutter_(std::move(renderer), camera, std::move(world_from_camera), sensors),
      sensors_(sensors),
      kept_(kept) {}

RgbdFrame FrameStudio::frame(std::size_t index, RandomStream noise, LabelMode labels,
                             const Following& following) {
  Claim claimed = claim(index, noise);
  if (claimed.to_make) {
    make(std::move(*claimed.to_make), index, noise);
  } else if (following) {
    constexpr int kAhead = 4;
    std::size_t next = following(index);
    for (int k = 0; k < kAhead && next < size() && !ready(claimed.shot); ++k) {
      Claim ahead = claim(next, noise);
      if (ahead.to_make) make(std::move(*ahead.to_make), next, noise);
      next = following(next);
    }
  }
  const std::shared_ptr<const Shot> picture = claimed.shot.get();
  RgbdFrame frame = picture->unlabelled;
  if (labels != LabelMode::kNone)
    frame.semantics = sense_labels(picture->truth, labels, sensors_,
                                   path()[index].world_from_camera, noise.fork(index));
  return frame;
}

FrameStudio::Claim FrameStudio::claim(std::size_t index, RandomStream noise) {
  const Key key{index, noise.key()};
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(shots_.begin(), shots_.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  if (found != shots_.end()) return {found->second, std::nullopt};
  std::promise<std::shared_ptr<const Shot>> promise;
  SharedShot shot = promise.get_future().share();
  shots_.emplace_back(key, shot);
  if (shots_.size() > kept_) shots_.pop_front();
  return {std::move(shot), std::move(promise)};
}

void FrameStudio::make(std::promise<std::shared_ptr<const Shot>> promise, std::size_t index,
                       RandomStream noise) const {
  try {
    auto made = std::make_shared<Shot>();
    Shutter::Exposed exposed = shutter_.expose(index);
    made->unlabelled = sense(exposed.seen, camera(), sensors_, noise.fork(index),
                             path()[index].stamp_ns, exposed.gain);
    made->truth = std::move(exposed.seen);
    promise.set_value(std::move(made));
  } catch (...) {
    promise.set_exception(std::current_exception());  // reaches everybody who waits for it
  }
}

}  // namespace mh
