// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "sim/render/renderer.hpp"
#include "sim/sensors/lens.hpp"
#include "sim/sensors/sense.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// The camera's pose some time after (or before) a stamp of its path: between two poses it moves
/// with a constant twist; before the first and after the last it is at rest.
SE3 pose_at(const Trajectory& path, std::size_t i, double after_s);

/// Indices of the frames that arrive, always including the first. Random draws are keyed by the
/// frame's index.
std::vector<std::size_t> arriving(std::size_t frames, const SensorConfig& config,
                                  RandomStream stream);
/// The frames of a path that arrive.
Trajectory arriving_frames(const Trajectory& path, const SensorConfig& config, RandomStream stream);

/// Captures images along a path: the light and depth at the sensors during each frame, before
/// noise. Frame i is a pure function of i. Safe to use from several threads.
class Shutter {
 public:
  /// A scene in which something moves: its renderer at a given time.
  using SceneAt = std::function<std::shared_ptr<const Renderer>(Stamp)>;

  /// @param renderer  renderer of the scene; shared, since one renderer serves every path
  /// @param path      world_from_camera, at least one pose
  Shutter(SceneAt scene, const Camera& camera, Trajectory path, const SensorConfig& config);
  Shutter(std::shared_ptr<const Renderer> renderer, const Camera& camera, Trajectory path,
          const SensorConfig& config);

  struct Exposed {
    /// Depth is that of the stamp plus its offset, all rows at once. Classes and instances of a row
    /// are those of the middle of its exposure, from the image along the motion that is nearest in
    /// time, at most half of MotionSampling::step_px away; for kAnnotated, they are those of the
    /// stamp.
    RenderedFrame seen;
    double gain = 1.0;  ///< gain of the exposure control, not yet applied
  };
  Exposed expose(std::size_t i, LabelMode labels = LabelMode::kExact) const;

  const Trajectory& path() const { return path_; }
  /// The camera as SLAM should know it: with the lens that the level specifies.
  const Camera& camera() const { return camera_; }

 private:
  struct Moment {
    std::shared_ptr<const Renderer> scene;
    SE3 world_from_camera;
  };
  Moment moment(std::size_t i, double after_s) const;
  RenderedFrame render(const Camera& pinhole, std::size_t i, double after_s) const;
  int images_within(std::size_t i) const;
  void blur(RenderedFrame& image, std::size_t i, int images, LabelMode labels) const;
  std::vector<double> exposure_gains() const;
  double gain(std::size_t i) const;

  SceneAt scene_;
  Camera camera_;
  Lens lens_;
  Trajectory path_;
  SensorConfig config_;
  struct Gains {
    std::once_flag made;
    std::vector<double> by_frame;
  };
  std::shared_ptr<Gains> gains_ = std::make_shared<Gains>();  // computed when the first is needed
};

/// The camera with the distortion that a level specifies.
Camera with_lens(Camera camera, const SensorConfig& config);

}  // namespace mh
