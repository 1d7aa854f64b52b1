// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "slam/core/sequence.hpp"
#include "slam/detect/detector.hpp"

namespace mh {

/// A cache: returns the entry under a key, or makes and stores it.
using KeepDetections =
    std::function<std::string(const std::string& key, const std::function<std::string()>& make)>;

/// What a detector finds in an image, cached by the contents of network, settings and image.
/// @param keep  may be null
Detected detect_kept(const Detector& detector, const RgbdFrame& frame, std::size_t index,
                     const KeepDetections& keep);

/// The frames of another sequence, with a detector's labels instead of their own.
class DetectedSequence : public Sequence {
 public:
  /// @param fill  see labels_of()
  DetectedSequence(std::shared_ptr<const Sequence> inner, std::shared_ptr<const Detector> detector,
                   BoxFill fill, KeepDetections keep = nullptr);

  const Camera& camera() const override { return inner_->camera(); }
  std::size_t size() const override { return inner_->size(); }
  Stamp stamp_ns(std::size_t i) const override { return inner_->stamp_ns(i); }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override;
  const Trajectory* truth() const override { return inner_->truth(); }
  std::span<const ImuReading> imu() const override { return inner_->imu(); }

 private:
  std::shared_ptr<const Sequence> inner_;
  std::shared_ptr<const Detector> detector_;
  BoxFill fill_;
  KeepDetections keep_;
};

}  // namespace mh
