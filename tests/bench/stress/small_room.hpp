// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "sim/sensors/shutter.hpp"
#include "sim/simulation/faulty_sequence.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "tests/sim/boxes.hpp"
#include "tests/slam/core/kept_frames.hpp"

namespace mh {

/// A furnished room, seen by a small camera that moves and turns through it for 16 frames.
class SmallRoom {
 public:
  SmallRoom() {
    Scene scene = test::empty_room();
    test::add_box(scene, "table", {6, 4, 0}, {7, 6, 0.8F});
    test::add_box(scene, "shelf", {4, 8, 0}, {6, 8.5F, 1.9F});
    renderer_ = make_scene_renderer(scene);
    camera_ = {.width_px = 160,
               .height_px = 120,
               .fx_px = 131,
               .fy_px = 131,
               .cx_px = 79.5,
               .cy_px = 59.5};
    for (int i = 0; i < 16; ++i) {
      const double heading = 0.04 * i;
      Eigen::Matrix3d axes;  // x right, y down, z forward, looking level along the heading
      axes.col(0) = Eigen::Vector3d(std::sin(heading), -std::cos(heading), 0);
      axes.col(1) = Eigen::Vector3d(0, 0, -1);
      axes.col(2) = Eigen::Vector3d(std::cos(heading), std::sin(heading), 0);
      path_.push_back({i * 33'333'333LL, SE3(axes, {3 + 0.03 * i, 5, 1.2})});
    }
  }

  RandomStream noise() const { return RandomStream(5); }
  std::shared_ptr<const Sequence> sequence(const SensorConfig& level) const {
    return with_feed_faults(std::make_shared<SimulatedSequence>(
                                renderer_, camera_, arriving_frames(path_, level, RandomStream(0)),
                                level, LabelMode::kNone),
                            level);
  }
  std::vector<RgbdFrame> frames(const SensorConfig& level) const {
    const auto all = sequence(level);
    std::vector<RgbdFrame> frames;
    for (std::size_t i = 0; i < all->size(); ++i) frames.push_back(all->frame(i, noise()));
    return frames;
  }
  Camera camera(const SensorConfig& level) const { return sequence(level)->camera(); }
  /// The same frames as a recording, which knows no scene.
  std::shared_ptr<const Sequence> recording(const SensorConfig& level) const {
    return std::make_shared<KeptFrames>(frames(level), camera_, path_);
  }

 private:
  std::shared_ptr<const Renderer> renderer_;
  Camera camera_;
  Trajectory path_;
};

}  // namespace mh
