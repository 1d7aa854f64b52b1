// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robots/model/robot.hpp"
#include "slam/core/camera.hpp"
#include "slam/io/setting.hpp"

// The numbers of a robot's file as lists of fields (slam/io/setting.hpp), from which the file is
// read and its keys are documented. Structure (links and joints of a URDF, poses, lists and
// references by name) has its own readers in robot.cpp.

namespace mh {

namespace setting {
inline constexpr SettingRange kImageSize_px = required({16, 8192}), kRate_hz = required({0.1, 240});
}  // namespace setting

/// Fields of `base`.
template <MaybeConst<Robot> R, class Visit>
void body_fields(R& robot, Visit& v) {
  v("mass_kg", robot.mass_kg, setting::required({0.1, 1000}), "of the whole robot");
  v("footprint_radius_m", robot.footprint_radius_m, setting::required({0.02, 2}),
    "of a disc that contains the robot, seen from above");
  v("height_m", robot.height_m, setting::required({0.05, 3}),
    "of the robot, which must fit under obstacles");
}

template <MaybeConst<BaseLimits> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [max_velocity_m_per_s, max_acceleration_m_per_s2, max_turn_rad_per_s,
         max_turn_acceleration_rad_per_s2, max_jerk_m_per_s3, max_turn_jerk_rad_per_s3] = c;
  v("max_velocity_m_per_s", max_velocity_m_per_s, setting::required({0.01, 5}),
    "in any direction; for a differential base, forward and backward");
  v("max_acceleration_m_per_s2", max_acceleration_m_per_s2, setting::required({0.01, 20}), "");
  v("max_turn_rad_per_s", max_turn_rad_per_s, setting::required({0.01, 10}), "");
  v("max_turn_acceleration_rad_per_s2", max_turn_acceleration_rad_per_s2,
    setting::required({0.01, 50}), "");
  v("max_jerk_m_per_s3", max_jerk_m_per_s3, {0.01, 1000}, "default: not limited");
  v("max_turn_jerk_rad_per_s3", max_turn_jerk_rad_per_s3, {0.01, 1000}, "default: not limited");
}

/// The RGB-D camera as data sheets describe it.
struct LensFields {
  int width_px = 0, height_px = 0;
  double horizontal_fov_deg = 0, vertical_fov_deg = 0, rate_hz = 0, baseline_m = 0;
};

template <MaybeConst<LensFields> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [width_px, height_px, horizontal_fov_deg, vertical_fov_deg, rate_hz, baseline_m] = c;
  v("width_px", width_px, setting::kImageSize_px, "of color and depth");
  v("height_px", height_px, setting::kImageSize_px, "");
  v("horizontal_fov_deg", horizontal_fov_deg, setting::required({1, 170}),
    "from edge to edge of the image");
  v("vertical_fov_deg", vertical_fov_deg, setting::required({1, 170}), "");
  v("rate_hz", rate_hz, setting::kRate_hz, "frames per second");
  v("baseline_m", baseline_m, setting::required({1e-3, 1}), "from projector to infrared camera");
}

/// Fields of a calibrated camera.
template <MaybeConst<Camera> C, class Visit>
void size_fields(C& camera, Visit& v) {
  v("width_px", camera.width_px, setting::kImageSize_px, "");
  v("height_px", camera.height_px, setting::kImageSize_px, "");
}
template <MaybeConst<Camera> C, class Visit>
void rate_fields(C& camera, Visit& v) {
  v("rate_hz", camera.rate_hz, setting::kRate_hz, "frames per second");
}

/// Fields of `wheels`, without their joints.
template <MaybeConst<WheelBase> C, class Visit>
void wheel_fields(C& wheels, Visit& v) {
  v("radius_m", wheels.radius_m, setting::required({0.005, 1}), "");
}

/// Fields of a laser scanner, without its link and range.
struct FanFields {
  int rays = 0;
  double field_of_view_deg = 0;
  double sigma_m = 0, sigma_share = 0;
};

template <MaybeConst<FanFields> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [rays, field_of_view_deg, sigma_m, sigma_share] = c;
  v("rays", rays, setting::required({2, 10000}), "");
  v("field_of_view_deg", field_of_view_deg, setting::required({0.1, 360}),
    "from first to last ray");
  v("sigma_m", sigma_m, {0, 1}, "standard deviation of a range's noise");
  v("sigma_share", sigma_share, {0, 0.5},
    "the same, as a share of the range; the larger of the two applies");
}

/// Fields of a sonar, without its link and range.
struct ConeFields {
  double field_of_view_deg = 0, resolution_m = 0;
};

template <MaybeConst<ConeFields> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [field_of_view_deg, resolution_m] = c;
  v("field_of_view_deg", field_of_view_deg, setting::required({1, 170}), "of the cone");
  v("resolution_m", resolution_m, setting::required({0, 1}), "quantization step of a reading");
}

template <MaybeConst<OdometryErrors> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [scale, scale_spread, slip_per_sqrt_m] = c;
  v("scale", scale, setting::required({-0.5, 0.5}), "of all wheels: 0.01 reads 1 % too long");
  v("scale_spread", scale_spread, setting::required({0, 0.2}),
    "standard deviation of each wheel's own scale, drawn by seed");
  v("slip_per_sqrt_m", slip_per_sqrt_m, setting::required({0, 0.5}),
    "standard deviation in m after 1 m at the rim; grows with the square root of that distance");
}

template <MaybeConst<CollisionReflex> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [ahead_m, aside_m] = c;
  v("ahead_m", ahead_m, setting::required({0, 3}), "from the shell, in the direction of travel");
  v("aside_m", aside_m, setting::required({0, 3}), "to either side of that path");
}

}  // namespace mh
