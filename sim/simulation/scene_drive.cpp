// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/scene_drive.hpp"

#include "scenes/load.hpp"
#include "sim/sensors/shutter.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "sim/simulation/simulated_sequence.hpp"
#include "sim/simulation/travel.hpp"

namespace mh {
namespace {

class SceneSequence : public Sequence {
 public:
  SceneSequence(const SceneDrive& source, const Robot& robot, const Scene& scene,
                const DrivenPath& path, const SensorConfig& sensors)
      : sensors_(sensors),
        shutter_(make_scene_renderer(scene), robot.camera, path.camera, sensors),
        arriving_(arriving(shutter_.path().size(), sensors, RandomStream(source.seed))) {}
  const Camera& camera() const override { return shutter_.camera(); }
  std::size_t size() const override { return arriving_.size(); }
  Stamp stamp_ns(std::size_t index) const override {
    return shutter_.path()[arriving_[index]].stamp_ns;
  }
  RgbdFrame frame(std::size_t index, RandomStream noise) const override {
    return sense_moment(shutter_, sensors_, LabelMode::kExact, arriving_[index], noise).frame;
  }
  const Trajectory* truth() const override { return &shutter_.path(); }

 private:
  SensorConfig sensors_;
  Shutter shutter_;
  std::vector<std::size_t> arriving_;  // of the shutter's path
};

}  // namespace

std::unique_ptr<Sequence> open_scene(const SceneDrive& source, std::vector<std::string>* notes) {
  SensorConfig sensors = exact_sensors();
  if (!source.level.empty()) sensors = load_sensor_config(source.level);
  const Robot robot = load_robot(source.robot);
  Scene scene = load_scene(source.scene, notes, source.frame);
  source.light ? source.light(scene) : light_scene(scene, 2);
  const DrivenPath path = travel(scene, robot, source.tour.string());
  if (notes != nullptr && !path.moved.empty()) notes->push_back(path.moved);
  return std::make_unique<SceneSequence>(source, robot, scene, path, sensors);
}

}  // namespace mh
