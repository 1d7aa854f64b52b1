// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "slam/core/sequence.hpp"

namespace mh {

/// Frames that were made before, with true poses for all or some.
class KeptFrames : public Sequence {
 public:
  KeptFrames(std::vector<RgbdFrame> frames, const Camera& camera, Trajectory truth)
      : frames_(std::move(frames)), camera_(camera), truth_(std::move(truth)) {}
  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return frames_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return frames_[i].stamp_ns; }
  RgbdFrame frame(std::size_t i, RandomStream) const override { return frames_[i]; }
  const Trajectory* truth() const override { return &truth_; }

 private:
  std::vector<RgbdFrame> frames_;
  Camera camera_;
  Trajectory truth_;
};

}  // namespace mh
