// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/map/map.hpp"

namespace mh {

/// Tells whether a map was made from a sequence, by comparing the depths of its keyframes'
/// keypoints with those in the frames of the same stamps.
class DepthComparison {
 public:
  /// @param map     must outlive this
  /// @param camera  of the sequence
  DepthComparison(const Map& map, Camera camera);

  /// Compares a frame with the keyframe of the same stamp, if there is one.
  void add(const RgbdFrame& frame);
  /// @throws InputError naming both if most depths differ.
  void require_same(const std::string& map, const std::string& sequence) const;

 private:
  Camera camera_;
  std::map<Stamp, const Keyframe*> keyframes_;
  std::size_t compared_ = 0, same_ = 0;
};

}  // namespace mh
