// SPDX-License-Identifier: Apache-2.0
#include "bench/recorded/frame_sequence.hpp"

#include <utility>
#include <vector>

#include "bench/metrics/trajectory_io.hpp"
#include "bench/recorded/tum_folder.hpp"
#include "bench/world/world.hpp"
#include "sim/sensors/sensors.hpp"

namespace mh {
namespace {

class TumSequence : public FrameSequence {
 public:
  TumSequence(const std::filesystem::path& folder, const Settings& settings)
      : camera_{settings.camera, settings.depth_per_metre, settings.exchange_red_blue},
        frames_(load_tum_folder(folder)) {
    const auto truth = folder / "groundtruth.txt";
    if (std::filesystem::exists(truth)) truth_ = read_tum(truth);
  }
  const Camera& camera() const override { return camera_.camera; }
  std::size_t size() const override { return frames_.size(); }
  Stamp stamp_ns(std::size_t index) const override { return frames_[index].stamp_ns; }
  RgbdFrame frame(std::size_t index) const override { return read_frame(frames_[index], camera_); }
  std::optional<Trajectory> truth() const override { return truth_; }

 private:
  RecordedCamera camera_;
  std::vector<RecordedFrame> frames_;
  std::optional<Trajectory> truth_;
};

class SceneSequence : public FrameSequence {
 public:
  explicit SceneSequence(const SceneDrive& source)
      : robot_(load_robot(source.robot)), noise_(source.seed) {
    const Tour tour = load_tour(source.tour);
    sensors_.depth_noise_on = sensors_.colour_noise_on = false;
    if (!source.level.empty()) sensors_ = load_sensor_config(source.level);
    scene_ = load_lit_scene(source.scene, 2);
    renderer_ = make_scene_renderer(scene_);
    path_ = drive(scene_, robot_, tour);
  }
  const Camera& camera() const override { return robot_.camera; }
  std::size_t size() const override { return path_.camera.size(); }
  Stamp stamp_ns(std::size_t index) const override { return path_.camera[index].stamp_ns; }
  RgbdFrame frame(std::size_t index) const override {
    const TimedPose& pose = path_.camera[index];
    return sense(renderer_->render(robot_.camera, pose.world_from_camera), robot_.camera, sensors_,
                 LabelMode::kExact, noise_.fork(index), pose.stamp_ns);
  }
  std::optional<Trajectory> truth() const override { return path_.camera; }

 private:
  Robot robot_;
  SensorConfig sensors_;
  Scene scene_;
  std::unique_ptr<Renderer> renderer_;
  DrivenPath path_;
  RandomStream noise_;
};

class MemorySequence : public FrameSequence {
 public:
  MemorySequence(const Camera& camera, std::vector<RgbdFrame> frames)
      : camera_(camera), frames_(std::move(frames)) {}
  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return frames_.size(); }
  Stamp stamp_ns(std::size_t index) const override { return frames_[index].stamp_ns; }
  RgbdFrame frame(std::size_t index) const override { return frames_[index]; }
  std::optional<Trajectory> truth() const override { return std::nullopt; }

 private:
  Camera camera_;
  std::vector<RgbdFrame> frames_;
};

}  // namespace

std::unique_ptr<FrameSequence> open_tum_folder(const std::filesystem::path& folder,
                                               const Settings& settings) {
  return std::make_unique<TumSequence>(folder, settings);
}

std::unique_ptr<FrameSequence> open_scene(const SceneDrive& drive) {
  return std::make_unique<SceneSequence>(drive);
}

std::unique_ptr<FrameSequence> frames_in_memory(const Camera& camera,
                                                std::vector<RgbdFrame> frames) {
  return std::make_unique<MemorySequence>(camera, std::move(frames));
}

}  // namespace mh
