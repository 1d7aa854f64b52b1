// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sim/render/renderer.hpp"
#include "tests/slam/pipeline/box_room.hpp"

namespace mh::testing_support {

/// The box room as a scene: exact images in closed form. It supports only BoxRoom::camera().
class BoxRoomRenderer : public Renderer {
 public:
  /// @param shift_m  shift of the whole room along x
  /// @param blank    true: its walls are gray
  explicit BoxRoomRenderer(double shift_m = 0, bool blank = false)
      : room_from_world_(Eigen::Matrix3d::Identity(), Eigen::Vector3d(-shift_m, 0, 0)),
        blank_(blank) {}

  RenderedFrame render(const Camera&, const SE3& world_from_camera) const override {
    RgbdFrame seen = BoxRoom::render(room_from_world_ * world_from_camera, 0);
    RenderedFrame frame;
    frame.color = std::move(seen.color);
    if (blank_) std::fill(frame.color.begin(), frame.color.end(), Rgb8{128, 128, 128});
    frame.depth_m = std::move(seen.depth_m);
    frame.classes = Grid2d<ClassId>(frame.color.width(), frame.color.height());
    frame.instances = Grid2d<InstanceId>(frame.color.width(), frame.color.height());
    for (int y = 0; y < frame.color.height(); ++y)
      for (int x = 0; x < frame.color.width(); ++x)
        frame.instances(x, y) = frame.classes(x, y) = seen.semantics.index(x, y);
    return frame;
  }

 private:
  SE3 room_from_world_;
  bool blank_;
};

}  // namespace mh::testing_support
