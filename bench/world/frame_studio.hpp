// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "sim/sensors/shutter.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// The frames along one path, shared by the runs that see the same noise: rendering and sensing are
/// done once per (frame, noise stream), then dressed in each run's labels. Keeps the last few
/// pictures; frames are pure functions of their key, so what is kept never changes a bit.
/// Safe to call from several threads.
class FrameStudio {
 public:
  /// @param kept  pictures remembered (some 5 MB each at 640x480)
  FrameStudio(std::shared_ptr<const Renderer> renderer, Camera camera,
              std::vector<TimedPose> world_from_camera, SensorConfig sensors,
              std::size_t kept = 24);

  std::size_t size() const { return path().size(); }
  const Camera& camera() const { return shutter_.camera(); }
  const std::vector<TimedPose>& path() const { return shutter_.path(); }

  /// The frame after a given one in the order in which they are asked for; size() or more: none.
  using Following = std::function<std::size_t(std::size_t)>;

  /// @param following  lets a caller who would wait while another makes this very picture make one
  ///                   of the next ones instead; empty: it waits
  RgbdFrame frame(std::size_t index, RandomStream noise, LabelMode labels,
                  const Following& following = {});

 private:
  struct Shot {
    RenderedFrame truth;
    RgbdFrame unlabelled;
  };
  using Key = std::pair<std::size_t, std::uint64_t>;
  using SharedShot = std::shared_future<std::shared_ptr<const Shot>>;

  /// The picture's future, and the promise to keep where the caller is to make it.
  struct Claim {
    SharedShot shot;
    std::optional<std::promise<std::shared_ptr<const Shot>>> to_make;
  };
  Claim claim(std::size_t index, RandomStream noise);
  void make(std::promise<std::shared_ptr<const Shot>> promise, std::size_t index,
            RandomStream noise) const;

  Shutter shutter_;
  SensorConfig sensors_;
  std::size_t kept_;
  std::mutex mutex_;
  std::deque<std::pair<Key, SharedShot>> shots_;  // oldest first
};

}  // namespace mh
