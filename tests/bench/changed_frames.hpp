// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#include "bench/protocol/world/world.hpp"
#include "bench/run/one/watched_frames.hpp"

namespace mh::testing_support {

using FrameChange = std::function<void(std::size_t index, RgbdFrame&)>;

/// A sequence that applies a change to each frame as it is made.
class ChangedFrames : public SequenceView {
 public:
  ChangedFrames(std::shared_ptr<const Sequence> inner, FrameChange change)
      : SequenceView(*inner), inner_(std::move(inner)), change_(std::move(change)) {}
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    RgbdFrame frame = SequenceView::frame(i, noise);
    change_(i, frame);
    return frame;
  }

 private:
  std::shared_ptr<const Sequence> inner_;
  FrameChange change_;
};

/// The world with `change` applied to all its frames; without a change, the world as it is.
inline World with_changed_frames(World world, const FrameChange& change) {
  if (!change) return world;
  for (auto* sequence : {&world.mapping, &world.query_tour})
    if (*sequence) *sequence = std::make_shared<const ChangedFrames>(*sequence, change);
  return world;
}

}  // namespace mh::testing_support
