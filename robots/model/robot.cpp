// SPDX-License-Identifier: Apache-2.0
#include "robots/model/robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "slam/core/yaml.hpp"

namespace mh {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

BaseLimits read_limits(YamlReader yaml) {
  BaseLimits limits;
  limits.max_velocity_m_per_s = yaml.number("max_velocity_m_per_s", 0.01, 5.0);
  limits.max_acceleration_m_per_s2 = yaml.number("max_acceleration_m_per_s2", 0.01, 20.0);
  limits.max_turn_rad_per_s = yaml.number("max_turn_rad_per_s", 0.01, 10.0);
  limits.max_turn_acceleration_rad_per_s2 =
      yaml.number("max_turn_acceleration_rad_per_s2", 0.01, 50.0);
  if (const auto jerk = yaml.find("max_jerk_m_per_s3"))
    limits.max_jerk_m_per_s3 = jerk->as_double(0.01, 1000.0);
  if (const auto jerk = yaml.find("max_turn_jerk_rad_per_s3"))
    limits.max_turn_jerk_rad_per_s3 = jerk->as_double(0.01, 1000.0);
  yaml.finish();
  return limits;
}

/// The focal length (px) that spreads `fov_deg` over `size_px` pixels.
double focal_px(double fov_deg, int size_px) {
  return 0.5 * size_px / std::tan(0.5 * fov_deg * kRadPerDeg);
}

Camera read_lens(YamlReader& yaml) {
  Camera camera;
  camera.width_px = static_cast<int>(yaml.integer("width_px", 16, 8192));
  camera.height_px = static_cast<int>(yaml.integer("height_px", 16, 8192));
  camera.fx_px = focal_px(yaml.number("horizontal_fov_deg", 1.0, 170.0), camera.width_px);
  camera.fy_px = focal_px(yaml.number("vertical_fov_deg", 1.0, 170.0), camera.height_px);
  camera.cx_px = 0.5 * (camera.width_px - 1);  // pixel centers at integers
  camera.cy_px = 0.5 * (camera.height_px - 1);
  camera.rate_hz = yaml.number("rate_hz", 0.1, 240.0);
  camera.baseline_m = yaml.number("baseline_m", 1e-3, 1.0);
  return camera;
}

/// Where the camera's body sits (x forward, z up; fixed-axis roll, pitch, yaw as in URDF), turned
/// into its optical frame (z forward, x right).
SE3 read_mount(YamlReader& yaml) {
  const std::vector<double> xyz = yaml.at("position_m").as_numbers(3);
  const std::vector<double> rpy = yaml.at("roll_pitch_yaw_deg").as_numbers(3);
  const Eigen::Matrix3d base_from_body =
      (Eigen::AngleAxisd(rpy[2] * kRadPerDeg, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(rpy[1] * kRadPerDeg, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy[0] * kRadPerDeg, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  Eigen::Matrix3d body_from_optical;  // REP 103: columns are the optical axes in the body frame
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {base_from_body * body_from_optical, {xyz[0], xyz[1], xyz[2]}};
}

/// A lens as calibrated: focal lengths, principal point, plumb-bob distortion.
Camera read_calibrated(YamlReader& yaml) {
  Camera camera;
  camera.width_px = static_cast<int>(yaml.integer("width_px", 16, 8192));
  camera.height_px = static_cast<int>(yaml.integer("height_px", 16, 8192));
  const std::vector<double> k = yaml.at("fx_fy_cx_cy_px").as_numbers(4);
  camera.fx_px = k[0];
  camera.fy_px = k[1];
  camera.cx_px = k[2];
  camera.cy_px = k[3];
  const std::vector<double> d = yaml.at("k1_k2_p1_p2_k3").as_numbers(5);
  camera.distortion = {d[0], d[1], d[2], d[3], d[4]};
  camera.rate_hz = yaml.number("rate_hz", 0.1, 240.0);
  try {
    validate(camera);
  } catch (const InputError& e) {
    yaml.fail(e.what());
  }
  return camera;
}

/// Reads what hangs on the links of a URDF.
class EquipmentReader {
 public:
  EquipmentReader(YamlReader yaml, const std::filesystem::path& robot_file)
      : yaml_(std::move(yaml)), tree_(load_urdf(robot_file.parent_path() / yaml_.string("urdf"))) {}

  Equipment read() {
    Equipment e;
    e.wheels = read_wheels(yaml_.at("wheels"));
    YamlReader head = yaml_.at("head");
    e.head_yaw = joint(head, "yaw").name;
    e.head_pitch = joint(head, "pitch").name;
    head.finish();
    e.depth_camera_link = yaml_.string("depth_camera_link");
    base_from(yaml_.at("depth_camera_link"), e.depth_camera_link);
    for (auto& [name, camera] : yaml_.at("cameras").entries()) {
      MountedCamera mounted{.name = name, .link = camera.string("link")};
      base_from(camera.at("link"), mounted.link);
      mounted.camera = read_calibrated(camera);
      camera.finish();
      e.cameras.push_back(std::move(mounted));
    }
    for (const YamlReader& bumper : yaml_.at("bumpers").items()) {
      e.bumpers.push_back(bumper.as_string());
      base_from(bumper, e.bumpers.back());
    }
    for (auto& [name, laser] : yaml_.at("lasers").entries())
      e.lasers.push_back(read_laser(name, laser));
    for (auto& [name, sonar] : yaml_.at("sonars").entries())
      e.sonars.push_back(read_sonar(name, sonar));
    const YamlReader imu = yaml_.at("imu_link");
    e.base_from_imu = base_from(imu, imu.as_string());
    YamlReader odometry = yaml_.at("odometry");
    e.odometry = {.scale = odometry.number("scale", -0.5, 0.5),
                  .scale_spread = odometry.number("scale_spread", 0.0, 0.2),
                  .slip_per_sqrt_m = odometry.number("slip_per_sqrt_m", 0.0, 0.5)};
    odometry.finish();
    YamlReader reflex = yaml_.at("collision_reflex");
    e.reflex = {.ahead_m = reflex.number("ahead_m", 0.0, 3.0),
                .aside_m = reflex.number("aside_m", 0.0, 3.0)};
    reflex.finish();
    yaml_.finish();
    e.tree = std::move(tree_);
    return e;
  }

 private:
  SE3 base_from(const YamlReader& place, const std::string& link) const {
    try {
      return tree_.root_from(link);
    } catch (const InputError& e) {
      place.fail(e.what());
    }
  }
  const Joint& joint(YamlReader& yaml, const std::string& key) const {
    const YamlReader node = yaml.at(key);
    try {
      return tree_.joint(node.as_string());
    } catch (const InputError& e) {
      node.fail(e.what());
    }
  }
  SE3 read_link(YamlReader& yaml) const {
    const YamlReader link = yaml.at("link");
    return base_from(link, link.as_string());
  }

  OmniWheels read_wheels(YamlReader yaml) const {
    OmniWheels wheels;
    wheels.radius_m = yaml.number("radius_m", 0.005, 1.0);
    const YamlReader joints = yaml.at("joints");
    const std::vector<YamlReader> names = joints.items();
    if (names.size() != wheels.wheels.size())
      joints.fail(fmt::format("has {} joints: an omnidirectional base has three", names.size()));
    double slowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string name = names[i].as_string();
      const auto found = std::ranges::find(tree_.joints, name, &Joint::name);
      if (found == tree_.joints.end())
        names[i].fail(fmt::format("the URDF has no joint '{}'", name));
      const SE3 base_from_wheel = tree_.root_from(found->child);
      const Eigen::Vector3d axle = base_from_wheel.rotation() * found->axis;
      wheels.wheels[i] = {.joint = name,
                          .place_m = base_from_wheel.translation().head<2>(),
                          .axle_rad = std::atan2(axle.y(), axle.x())};
      slowest = std::min(slowest, found->velocity);
    }
    wheels.max_rim_m_per_s = slowest * wheels.radius_m;
    if (!(wheels.max_rim_m_per_s > 0) || std::isinf(wheels.max_rim_m_per_s))
      joints.fail("the URDF limits the velocity of none of these joints");
    yaml.finish();
    return wheels;
  }
  LaserScanner read_laser(const std::string& name, YamlReader& yaml) const {
    LaserScanner laser{
        .name = name,
        .base_from_laser = read_link(yaml),
        .rays = static_cast<int>(yaml.integer("rays", 2, 10000)),
        .field_of_view_rad = yaml.number("field_of_view_deg", 0.1, 360) * kRadPerDeg};
    read_range(yaml, laser.min_range_m, laser.max_range_m);
    yaml.finish();
    return laser;
  }
  Sonar read_sonar(const std::string& name, YamlReader& yaml) const {
    Sonar sonar{.name = name,
                .base_from_sonar = read_link(yaml),
                .field_of_view_rad = yaml.number("field_of_view_deg", 1, 170) * kRadPerDeg};
    read_range(yaml, sonar.min_range_m, sonar.max_range_m);
    sonar.resolution_m = yaml.number("resolution_m", 0, 1);
    yaml.finish();
    return sonar;
  }
  static void read_range(YamlReader& yaml, double& min_m, double& max_m) {
    const YamlReader range = yaml.at("range_m");
    const std::vector<double> values = range.as_numbers(2);
    if (!(values[0] >= 0 && values[0] < values[1]))
      range.fail(fmt::format("[{}, {}] is no range", values[0], values[1]));
    min_m = values[0];
    max_m = values[1];
  }

  YamlReader yaml_;
  KinematicTree tree_;
};

}  // namespace

Robot load_robot(const std::filesystem::path& file) {
  YamlReader yaml = YamlReader::load(file);
  Robot robot;
  robot.name = yaml.string("name");

  YamlReader base = yaml.at("base");
  robot.mass_kg = base.number("mass_kg", 0.1, 1000.0);
  robot.footprint_radius_m = base.number("footprint_radius_m", 0.02, 2.0);
  robot.height_m = base.number("height_m", 0.05, 3.0);
  robot.limits = read_limits(base.at("limits"));
  base.finish();

  YamlReader camera = yaml.at("camera");
  robot.camera = read_lens(camera);
  robot.base_from_camera = read_mount(camera);
  camera.finish();
  if (const auto equipment = yaml.find("equipment"))
    robot.equipment = std::make_shared<const Equipment>(EquipmentReader(*equipment, file).read());
  yaml.finish();
  try {
    validate(robot.camera);
  } catch (const std::invalid_argument& e) {
    camera.fail(e.what());
  }
  return robot;
}

}  // namespace mh
