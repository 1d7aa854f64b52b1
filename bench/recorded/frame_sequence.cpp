// SPDX-License-Identifier: Apache-2.0
#include "bench/recorded/frame_sequence.hpp"

#include <utility>
#include <vector>

#include "bench/recorded/tum_folder.hpp"
#include "bench/world/world.hpp"
#include "sim/sensors/shutter.hpp"
#include "sim/world/travel.hpp"
#include "slam/core/trajectory_io.hpp"

namespace mh {
namespace {

class TumSequence : public FrameSequence {
 public:
  TumSequence(const std::filesystem::path& folder, const Settings& settings,
              std::vector<std::string>* notes)
      : camera_{settings.camera, settings.depth_per_meter, settings.exchange_red_blue},
        frames_(load_tum_folder(folder, notes)) {
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
  SceneSequence(const SceneDrive& source, const Robot& robot, const Scene& scene,
                const SensorConfig& sensors)
      : sensors_(sensors),
        noise_(source.seed),
        shutter_(make_scene_renderer(scene), robot.camera,
                 travel(scene, robot, source.tour.string()).camera, sensors),
        arriving_(arriving(shutter_.path().size(), sensors, RandomStream(source.seed))) {}
  const Camera& camera() const override { return shutter_.camera(); }
  std::size_t size() const override { return arriving_.size(); }
  Stamp stamp_ns(std::size_t index) const override {
    return shutter_.path()[arriving_[index]].stamp_ns;
  }
  RgbdFrame frame(std::size_t index) const override {
    const std::size_t i = arriving_[index];
    const TimedPose& pose = shutter_.path()[i];
    const RandomStream noise = noise_.fork(i);
    const Shutter::Exposed exposed = shutter_.expose(i);
    RgbdFrame frame = sense(exposed.seen, camera(), sensors_, noise, pose.stamp_ns, exposed.gain);
    frame.semantics =
        sense_labels(exposed.seen, LabelMode::kExact, sensors_, pose.world_from_camera, noise);
    return frame;
  }
  std::optional<Trajectory> truth() const override { return shutter_.path(); }

 private:
  SensorConfig sensors_;
  RandomStream noise_;
  Shutter shutter_;
  std::vector<std::size_t> arriving_;  // of the shutter's path
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
                                               const Settings& settings,
                                               std::vector<std::string>* notes) {
  return std::make_unique<TumSequence>(folder, settings, notes);
}

std::unique_ptr<FrameSequence> open_scene(const SceneDrive& source,
                                          std::vector<std::string>* notes) {
  SensorConfig sensors;
  sensors.depth_noise_on = sensors.color_noise_on = false;
  if (!source.level.empty()) sensors = load_sensor_config(source.level);
  const Robot robot = load_robot(source.robot);
  const Scene scene = load_lit_scene(
      source.scene, 2, Cache(), [](std::string_view) {}, notes, source.frame);
  return std::make_unique<SceneSequence>(source, robot, scene, sensors);
}

std::unique_ptr<FrameSequence> frames_in_memory(const Camera& camera,
                                                std::vector<RgbdFrame> frames) {
  return std::make_unique<MemorySequence>(camera, std::move(frames));
}

}  // namespace mh
