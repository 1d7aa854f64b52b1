// SPDX-License-Identifier: Apache-2.0
#include "robots/model/robot.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

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
  camera.cx_px = 0.5 * (camera.width_px - 1);  // pixel centres at integers
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
  yaml.finish();
  try {
    validate(robot.camera);
  } catch (const std::invalid_argument& e) {
    camera.fail(e.what());
  }
  return robot;
}

}  // namespace mh
