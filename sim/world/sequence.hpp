// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "sim/sensors/shutter.hpp"
#include "sim/world/pedestrian.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// What really was: never handed to SLAM, only to what scores it.
struct GroundTruth {
  Stamp stamp_ns = 0;
  SE3 world_from_camera;
};

struct SimulatedFrame {
  RgbdFrame frame;
  GroundTruth truth;
};

/// The frames that a camera delivers along a path through a scene, made on demand. Frame i under
/// the same `attempt` stream is the same bits whenever and wherever it is asked for.
class SimulatedSequence {
 public:
  /// @param pedestrian_scene  `renderer`'s scene with a pedestrian; may be null
  SimulatedSequence(std::shared_ptr<const Renderer> renderer, Camera camera,
                    std::vector<TimedPose> world_from_camera, SensorConfig sensors,
                    LabelMode labels,
                    std::shared_ptr<const PedestrianScene> pedestrian_scene = nullptr);

  std::size_t size() const { return path().size(); }
  const Camera& camera() const { return shutter_.camera(); }
  const std::vector<TimedPose>& path() const { return shutter_.path(); }
  /// Sensor noise is keyed by (attempt, i, pixel).
  SimulatedFrame at(std::size_t i, RandomStream attempt) const;

 private:
  Shutter shutter_;
  SensorConfig sensors_;
  LabelMode labels_;
};

}  // namespace mh
