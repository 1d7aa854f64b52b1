// SPDX-License-Identifier: Apache-2.0
#include "robots/model/robot_keys.hpp"

#include <utility>

#include "robots/model/robot_fields.hpp"
#include "slam/io/settings_io.hpp"

namespace mh {
namespace {

/// Lists keys: those of numbers by visiting their fields, the others explicitly.
class KeyLister {
 public:
  void mapping(const char* name) { mapping_ = name; }
  void add(const char* key, const char* value, const char* meaning, bool required = true) {
    keys_.push_back({mapping_, key, value, meaning, required});
  }
  template <class T>
  void operator()(const char* key, const T&, const SettingRange& range, const char* meaning) {
    keys_.push_back({mapping_, key, interval(range), meaning, range.required});
  }
  std::vector<RobotKey> take() { return std::move(keys_); }

 private:
  std::string mapping_;
  std::vector<RobotKey> keys_;
};

}  // namespace

std::vector<RobotKey> robot_keys() {
  const Robot robot;
  const Camera camera;
  const WheelBase wheels;
  const LensFields lens;
  const FanFields fan;
  const ConeFields cone;
  const OdometryErrors odometry;
  const CollisionReflex reflex;
  KeyLister list;
  list.mapping("");
  list.add("name", "word", "the robot's name in results");
  list.add("base", "mapping", "the body that drives");
  list.add("camera", "mapping", "the RGB-D camera");
  list.add("equipment", "mapping", "what is mounted on the links of a URDF: other sensors", false);

  list.mapping("base");
  body_fields(robot, list);
  list.add("limits", "mapping", "how fast it drives and turns");
  list.mapping("base.limits");
  fields(robot.limits, list);

  list.mapping("camera");
  fields(lens, list);
  list.add("position_m", "3 numbers", "of the camera's body in the base's frame");
  list.add("roll_pitch_yaw_deg", "3 numbers",
           "of the camera's body (x forward, z up) about fixed axes, as in URDF");

  list.mapping("equipment");
  const auto add_part = [&](const char* key, const char* value, const char* meaning) {
    list.add(key, value, meaning, false);
  };
  list.add("urdf", "file", "relative to the robot's file");
  add_part("base_link", "link", "the base's frame, on the floor; default: the URDF's root");
  add_part("wheels", "mapping", "if absent, the robot drives in any direction and has no odometry");
  add_part("head", "mapping", "joints that move the camera");
  add_part("depth_camera_link", "link",
           "optical frame of the RGB-D camera; if absent, no head moves the camera");
  add_part("cameras", "mapping", "more color cameras, by name");
  add_part("bumpers", "list of links", "where the shell makes contact first");
  add_part("lasers", "mapping", "laser scanners, by name");
  add_part("sonars", "mapping", "sonars, by name");
  add_part("imu_link", "link", "where the IMU sits");
  add_part("odometry", "mapping", "errors of wheel odometry; default: none");
  add_part("collision_reflex", "mapping", "how close an obstacle must be to stop the robot");

  list.mapping("equipment.wheels");
  list.add("joints", "list of joints",
           "of the URDF, which limits their velocity; three: omnidirectional; two (or 4, 6, 8) on "
           "parallel axles: differential");
  wheel_fields(wheels, list);
  list.mapping("equipment.head");
  list.add("yaw", "joint", "");
  list.add("pitch", "joint", "");

  list.mapping("equipment.cameras.NAME");
  list.add("link", "link", "optical frame");
  size_fields(camera, list);
  list.add("fx_fy_cx_cy_px", "4 numbers", "as calibrated");
  list.add("k1_k2_p1_p2_k3", "5 numbers", "plumb-bob distortion");
  rate_fields(camera, list);

  list.mapping("equipment.lasers.NAME");
  list.add("link", "link", "rays leave along x, rotated about z");
  fields(fan, list);
  list.add("range_m", "2 numbers", "nearest and farthest reading");

  list.mapping("equipment.sonars.NAME");
  list.add("link", "link", "the sonar looks along x");
  fields(cone, list);
  list.add("range_m", "2 numbers", "nearest and farthest reading");

  list.mapping("equipment.odometry");
  fields(odometry, list);
  list.mapping("equipment.collision_reflex");
  fields(reflex, list);
  return list.take();
}

}  // namespace mh
