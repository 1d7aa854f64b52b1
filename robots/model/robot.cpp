// SPDX-License-Identifier: Apache-2.0
#include "robots/model/robot.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "robots/model/robot_fields.hpp"
#include "robots/model/wheel_base.hpp"
#include "slam/core/angles.hpp"
#include "slam/io/settings_io.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

/// Reads the fields of a list (robot_fields.hpp) from the mapping that contains them.
template <class Fields>
Fields read_fields(YamlReader& mapping) {
  Fields read;
  MappingReader reader(mapping);
  fields(read, reader);
  return read;
}

/// Reads the fields of a list from a mapping that contains nothing else.
template <class Fields>
Fields read_all(YamlReader mapping) {
  const auto read = read_fields<Fields>(mapping);
  mapping.finish();
  return read;
}

/// The focal length (px) that spreads `fov_deg` over `size_px` pixels.
double focal_px(double fov_deg, int size_px) {
  return 0.5 * size_px / std::tan(0.5 * fov_deg * kDegree);
}

Camera read_lens(YamlReader& yaml) {
  const auto lens = read_fields<LensFields>(yaml);
  Camera camera;
  camera.width_px = lens.width_px;
  camera.height_px = lens.height_px;
  camera.fx_px = focal_px(lens.horizontal_fov_deg, camera.width_px);
  camera.fy_px = focal_px(lens.vertical_fov_deg, camera.height_px);
  camera.cx_px = 0.5 * (camera.width_px - 1);  // pixel centers at integers
  camera.cy_px = 0.5 * (camera.height_px - 1);
  camera.rate_hz = lens.rate_hz;
  camera.baseline_m = lens.baseline_m;
  // The same as in the sensor levels: a Kinect's depth noise of 0.0019 z^2 m (Nguyen et al.,
  // 3DIMPVT 2012) corresponds to 0.08 px at fx = 577 px; rounded up.
  camera.disparity_sigma_px = 0.1;
  camera.disparity_sigma_is_given = true;
  return camera;
}

/// Reads where the camera's body is (x forward, z up; fixed-axis roll, pitch, yaw as in URDF) and
/// converts it to the optical frame (z forward, x right).
SE3 read_mount(YamlReader& yaml) {
  const std::vector<double> xyz = yaml.at("position_m").as_numbers(3);
  const std::vector<double> rpy = yaml.at("roll_pitch_yaw_deg").as_numbers(3);
  const Eigen::Matrix3d base_from_body =
      (Eigen::AngleAxisd(rpy[2] * kDegree, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(rpy[1] * kDegree, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(rpy[0] * kDegree, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  Eigen::Matrix3d body_from_optical;  // REP 103: columns are the optical axes in the body frame
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {base_from_body * body_from_optical, {xyz[0], xyz[1], xyz[2]}};
}

/// Reads a calibrated lens: focal lengths, principal point, plumb-bob distortion.
Camera read_calibrated(YamlReader& yaml) {
  Camera camera;
  MappingReader reader(yaml);
  size_fields(camera, reader);
  rate_fields(camera, reader);
  const std::vector<double> k = yaml.at("fx_fy_cx_cy_px").as_numbers(4);
  camera.fx_px = k[0];
  camera.fy_px = k[1];
  camera.cx_px = k[2];
  camera.cy_px = k[3];
  const std::vector<double> d = yaml.at("k1_k2_p1_p2_k3").as_numbers(5);
  camera.distortion = distortion_of(d);
  try {
    validate(camera);
  } catch (const InputError& e) {
    yaml.fail(e.what());
  }
  return camera;
}

/// Reads what is mounted on the links of a URDF.
class EquipmentReader {
 public:
  EquipmentReader(YamlReader yaml, const std::filesystem::path& robot_file,
                  std::vector<std::string>* warnings)
      : yaml_(std::move(yaml)), warnings_(warnings) {
    e_.tree = load_urdf(robot_file.parent_path() / yaml_.string("urdf"), warnings);
  }

  Equipment read() {
    if (const auto base = yaml_.find("base_link")) {
      base_link_ = base->as_string();
      e_.base_from_root = base_from(*base, base_link_).inverse();
    }
    if (const auto wheels = yaml_.find("wheels")) e_.wheels = read_wheels(*wheels);
    if (auto head = yaml_.find("head")) {
      e_.head = {.yaw = joint(head->at("yaw")).name, .pitch = joint(head->at("pitch")).name};
      head->finish();
    }
    if (const auto link = yaml_.find("depth_camera_link")) {
      e_.depth_camera_link = link->as_string();
      base_from(*link, e_.depth_camera_link);
    }
    for (auto& [name, camera] : entries("cameras")) {
      MountedCamera mounted{.name = name, .link = camera.string("link")};
      base_from(camera.at("link"), mounted.link);
      mounted.camera = read_calibrated(camera);
      camera.finish();
      e_.cameras.push_back(std::move(mounted));
    }
    if (const auto bumpers = yaml_.find("bumpers"))
      for (const YamlReader& bumper : bumpers->items()) {
        e_.bumpers.push_back(bumper.as_string());
        base_from(bumper, e_.bumpers.back());
      }
    for (auto& [name, laser] : entries("lasers")) e_.lasers.push_back(read_laser(name, laser));
    for (auto& [name, sonar] : entries("sonars")) e_.sonars.push_back(read_sonar(name, sonar));
    if (const auto imu = yaml_.find("imu_link"))
      e_.base_from_imu = base_from(*imu, imu->as_string());
    if (const auto errors = yaml_.find("odometry")) e_.odometry = read_all<OdometryErrors>(*errors);
    if (const auto zone = yaml_.find("collision_reflex"))
      e_.reflex = read_all<CollisionReflex>(*zone);
    yaml_.finish();
    return std::move(e_);
  }

 private:
  /// The entries of a mapping; empty if the mapping is absent.
  std::vector<std::pair<std::string, YamlReader>> entries(const std::string& key) {
    auto found = yaml_.find(key);
    return found ? found->entries() : std::vector<std::pair<std::string, YamlReader>>{};
  }
  SE3 base_from(const YamlReader& place, const std::string& link) const {
    try {
      return e_.base_from(link);
    } catch (const InputError& e) {
      place.fail(e.what());
    }
  }
  const Joint& joint(const YamlReader& name) const {
    try {
      return e_.tree.joint(name.as_string());
    } catch (const InputError& e) {
      name.fail(e.what());
    }
  }
  SE3 read_link(YamlReader& yaml) const {
    const YamlReader link = yaml.at("link");
    return base_from(link, link.as_string());
  }

  /// The joint that steers a wheel, as in PR2's casters; "" if there is none.
  std::string steered_by(const Joint& wheel) const {
    constexpr double kUpright = 0.5;
    std::string link = wheel.parent;
    for (auto at = e_.tree.joints.rbegin(); at != e_.tree.joints.rend(); ++at) {
      if (link == base_link_) break;
      if (at->child != link) continue;
      const Eigen::Vector3d axis = e_.base_from(at->child).rotation() * at->axis;
      if (at->kind == Joint::Kind::kTurning && std::abs(axis.z()) > kUpright) return at->name;
      link = at->parent;
    }
    return "";
  }

  WheelBase read_wheels(YamlReader yaml) const {
    WheelBase wheels;
    MappingReader reader(yaml);
    wheel_fields(wheels, reader);
    const YamlReader joints = yaml.at("joints");
    double highest_m = 0;  // of the wheel whose bottom is farthest from the floor
    for (const YamlReader& name : joints.items()) {
      const Joint& wheel = joint(name);
      if (std::ranges::find(wheels.wheels, wheel.name, &WheelBase::Wheel::joint) !=
          wheels.wheels.end())
        name.fail(fmt::format("'{}' is listed twice", wheel.name));
      const SE3 base_from_wheel = e_.base_from(wheel.child);
      const Eigen::Vector3d axle = base_from_wheel.rotation() * wheel.axis;
      constexpr double kSteep = 0.5;  // 30 degrees: accepts cambered wheels but no steering axis
      if (wheel.kind != Joint::Kind::kTurning || std::abs(axle.z()) > kSteep)
        name.fail(fmt::format(
            "joint '{}' is not a wheel joint: it {}", wheel.name,
            wheel.kind == Joint::Kind::kTurning ? "turns about an upright axis" : "does not turn"));
      if (const std::string steered = steered_by(wheel); !steered.empty())
        name.fail(fmt::format(
            "joint '{}' is steered by joint '{}': leave out `wheels`, such bases are not supported",
            wheel.name, steered));
      if (!(wheel.velocity > 0))
        name.fail(fmt::format("the URDF limits the velocity of joint '{}' to 0", wheel.name));
      wheels.wheels.push_back({.joint = wheel.name,
                               .place_m = base_from_wheel.translation().head<2>(),
                               .axle_rad = std::atan2(axle.y(), axle.x())});
      wheels.max_rim_m_per_s = std::min(wheels.max_rim_m_per_s, wheel.velocity * wheels.radius_m);
      const double bottom_m = base_from_wheel.translation().z() - wheels.radius_m;
      if (std::abs(bottom_m) > std::abs(highest_m)) highest_m = bottom_m;
    }
    if (const std::string wrong = find_kind(wheels); !wrong.empty()) joints.fail(wrong);
    constexpr double kSunk_m = 0.02;
    if (warnings_ != nullptr && std::abs(highest_m) > kSunk_m)
      warnings_->push_back(fmt::format(
          "{}:{}: wheels of this radius would stand {:.3f} m {} the floor, where the base's frame "
          "is: does the URDF have a link there to name as base_link?",
          joints.file(), joints.line(), std::abs(highest_m), highest_m > 0 ? "above" : "below"));
    yaml.finish();
    return wheels;
  }
  LaserScanner read_laser(const std::string& name, YamlReader& yaml) const {
    const auto fan = read_fields<FanFields>(yaml);
    LaserScanner laser{.name = name,
                       .base_from_laser = read_link(yaml),
                       .rays = fan.rays,
                       .field_of_view_rad = fan.field_of_view_deg * kDegree,
                       .sigma_m = fan.sigma_m,
                       .sigma_share = fan.sigma_share};
    read_range(yaml, laser.min_range_m, laser.max_range_m);
    yaml.finish();
    return laser;
  }
  Sonar read_sonar(const std::string& name, YamlReader& yaml) const {
    const auto cone = read_fields<ConeFields>(yaml);
    Sonar sonar{.name = name,
                .base_from_sonar = read_link(yaml),
                .field_of_view_rad = cone.field_of_view_deg * kDegree};
    read_range(yaml, sonar.min_range_m, sonar.max_range_m);
    sonar.resolution_m = cone.resolution_m;
    yaml.finish();
    return sonar;
  }
  static void read_range(YamlReader& yaml, double& min_m, double& max_m) {
    const YamlReader range = yaml.at("range_m");
    const std::vector<double> values = range.as_numbers(2);
    if (!(values[0] >= 0 && values[0] < values[1]))
      range.fail(fmt::format("[{}, {}] is not a range", values[0], values[1]));
    min_m = values[0];
    max_m = values[1];
  }

  YamlReader yaml_;
  std::string base_link_;  ///< "": the URDF's root
  std::vector<std::string>* warnings_;
  Equipment e_;
};

}  // namespace

Robot load_robot(const std::filesystem::path& file, std::vector<std::string>* warnings) {
  YamlReader yaml = YamlReader::load(file);
  Robot robot;
  robot.name = yaml.string("name");

  YamlReader base = yaml.at("base");
  MappingReader body(base);
  body_fields(robot, body);
  robot.limits = read_all<BaseLimits>(base.at("limits"));
  base.finish();

  YamlReader camera = yaml.at("camera");
  robot.camera = read_lens(camera);
  robot.base_from_camera = read_mount(camera);
  camera.finish();
  if (const auto equipment = yaml.find("equipment"))
    robot.equipment =
        std::make_shared<const Equipment>(EquipmentReader(*equipment, file, warnings).read());
  yaml.finish();
  try {
    validate(robot.camera);
  } catch (const std::invalid_argument& e) {
    camera.fail(e.what());
  }
  return robot;
}

}  // namespace mh
