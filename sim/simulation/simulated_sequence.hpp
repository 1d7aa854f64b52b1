// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "sim/sensors/shutter.hpp"
#include "sim/simulation/pedestrian.hpp"
#include "sim/simulation/shared_exposures.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// What the camera delivers at one pose of a shutter's path, and the exact frame behind it.
struct SensedMoment {
  RgbdFrame frame;
  RenderedFrame exact;
};

/// Exposes, senses and labels the frame at the path's i-th pose; SimulatedSequence::frame() does
/// the same in steps whose results it can share. Noise is keyed by (noise, i, pixel).
SensedMoment sense_moment(const Shutter& shutter, const SensorConfig& sensors, LabelMode labels,
                          std::size_t i, RandomStream noise);

/// The frames that a camera delivers along a path through a scene, made on demand.
class SimulatedSequence : public Sequence {
 public:
  /// @param pedestrian_scene  `renderer`'s scene with a pedestrian; may be null
  SimulatedSequence(std::shared_ptr<const Renderer> renderer, Camera camera,
                    std::vector<TimedPose> world_from_camera, SensorConfig sensors,
                    LabelMode labels,
                    std::shared_ptr<const PedestrianScene> pedestrian_scene = nullptr);

  /// From now on, exposures are shared with the processes that pass the same folder and name;
  /// frames whose noise is one of images.noises are shared with the processes that also pass the
  /// same noises.
  /// @param name identifies everything that the constructor received, except labels
  void share(const SharedImages& images, const std::string& name);

  /// From now on, frames carry the odometry at their stamp.
  /// @param odom_from_camera  one pose per frame
  void set_odometry(std::vector<SE3> odom_from_camera) {
    odom_from_camera_ = std::move(odom_from_camera);
  }
  /// From now on, frames carry what the lasers measure at their stamp.
  using LasersAt = std::function<std::vector<LaserScan>(std::size_t i)>;
  void set_lasers(LasersAt lasers) { lasers_ = std::move(lasers); }
  void set_imu(std::vector<ImuReading> readings) { imu_ = std::move(readings); }

  const Camera& camera() const override { return shutter_.camera(); }
  std::size_t size() const override { return shutter_.path().size(); }
  Stamp stamp_ns(std::size_t i) const override { return shutter_.path()[i].stamp_ns; }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override;
  const Trajectory* truth() const override { return &shutter_.path(); }
  std::span<const ImuReading> imu() const override { return imu_; }

 private:
  SharedExposures* shared_with(RandomStream noise) const;
  Shutter::Exposed exposed(std::size_t i) const;
  Shutter::Exposed noisy(std::size_t i, RandomStream noise) const;

  Shutter shutter_;
  SensorConfig sensors_;
  LabelMode labels_;
  std::vector<SE3> odom_from_camera_;        // or empty
  std::vector<ImuReading> imu_;              // or empty
  LasersAt lasers_;                          // or empty
  SharedImages images_;                      // where exposures are shared
  std::string name_;                         // name of their file
  std::unique_ptr<SharedExposures> shared_;  // or null
  mutable std::mutex opening_;
  mutable std::map<std::uint64_t, std::unique_ptr<SharedExposures>> noisy_;  // by key of the noise
};

}  // namespace mh
