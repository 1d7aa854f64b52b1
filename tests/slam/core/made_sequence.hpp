// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

#include "slam/core/sequence.hpp"

namespace mh {

/// A sequence whose frames are made by a function.
class MadeSequence : public Sequence {
 public:
  using Make = std::function<RgbdFrame(std::size_t, RandomStream)>;
  MadeSequence(std::size_t count, Make make, const Camera& camera = {})
      : count_(count), make_(std::move(make)), camera_(camera) {}
  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return count_; }
  Stamp stamp_ns(std::size_t i) const override { return make_(i, RandomStream()).stamp_ns; }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override { return make_(i, noise); }
  const Trajectory* truth() const override { return nullptr; }
  std::span<const ImuReading> imu() const override { return readings; }

  std::vector<ImuReading> readings;

 private:
  std::size_t count_;
  Make make_;
  Camera camera_;
};

}  // namespace mh
