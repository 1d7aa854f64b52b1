// SPDX-License-Identifier: Apache-2.0
#include "robots/model/robot_keys.hpp"

#include <array>

namespace mh {
namespace {

constexpr std::array kKeys = {
    RobotKey{"", "name", "word", "how results call it"},
    RobotKey{"", "base", "mapping", "the body that drives"},
    RobotKey{"", "camera", "mapping", "the RGB-D camera"},
    RobotKey{"", "equipment", "mapping", "what hangs on the links of a URDF: other sensors", false},

    RobotKey{"base", "mass_kg", "[0.1, 1000]", "of the whole robot"},
    RobotKey{"base", "footprint_radius_m", "[0.02, 2]", "a disc that holds it, seen from above"},
    RobotKey{"base", "height_m", "[0.05, 3]", "what it must pass under"},
    RobotKey{"base", "limits", "mapping", "how fast it drives and turns"},

    RobotKey{"base.limits", "max_velocity_m_per_s", "[0.01, 5]", "in any direction"},
    RobotKey{"base.limits", "max_acceleration_m_per_s2", "[0.01, 20]", ""},
    RobotKey{"base.limits", "max_turn_rad_per_s", "[0.01, 10]", ""},
    RobotKey{"base.limits", "max_turn_acceleration_rad_per_s2", "[0.01, 50]", ""},
    RobotKey{"base.limits", "max_jerk_m_per_s3", "[0.01, 1000]", "without: not limited", false},
    RobotKey{"base.limits", "max_turn_jerk_rad_per_s3", "[0.01, 1000]", "without: not limited",
             false},

    RobotKey{"camera", "width_px", "[16, 8192]", "of color and depth"},
    RobotKey{"camera", "height_px", "[16, 8192]", ""},
    RobotKey{"camera", "horizontal_fov_deg", "[1, 170]", "from edge to edge of the image"},
    RobotKey{"camera", "vertical_fov_deg", "[1, 170]", ""},
    RobotKey{"camera", "rate_hz", "[0.1, 240]", "frames per second"},
    RobotKey{"camera", "baseline_m", "[0.001, 1]", "from projector to infrared camera"},
    RobotKey{"camera", "position_m", "3 numbers", "of the camera's body in the base's frame"},
    RobotKey{"camera", "roll_pitch_yaw_deg", "3 numbers",
             "of the camera's body (x forward, z up) about fixed axes, as in URDF"},

    RobotKey{"equipment", "urdf", "file", "relative to the robot's file"},
    RobotKey{"equipment", "wheels", "mapping", "three omnidirectional wheels"},
    RobotKey{"equipment", "head", "mapping", "joints that move the camera"},
    RobotKey{"equipment", "depth_camera_link", "link", "optical frame of the RGB-D camera"},
    RobotKey{"equipment", "cameras", "mapping", "further color cameras by name"},
    RobotKey{"equipment", "bumpers", "list of links", "where the shell is felt"},
    RobotKey{"equipment", "lasers", "mapping", "laser scanners by name"},
    RobotKey{"equipment", "sonars", "mapping", "sonars by name"},
    RobotKey{"equipment", "imu_link", "link", "where the IMU sits"},
    RobotKey{"equipment", "odometry", "mapping", "how wheel odometry errs"},
    RobotKey{"equipment", "collision_reflex", "mapping", "where the robot stops by itself"},

    RobotKey{"equipment.wheels", "joints", "3 joints", "of the URDF, which limits their velocity"},
    RobotKey{"equipment.wheels", "radius_m", "[0.005, 1]", ""},
    RobotKey{"equipment.head", "yaw", "joint", ""},
    RobotKey{"equipment.head", "pitch", "joint", ""},

    RobotKey{"equipment.cameras.NAME", "link", "link", "optical frame"},
    RobotKey{"equipment.cameras.NAME", "width_px", "[16, 8192]", ""},
    RobotKey{"equipment.cameras.NAME", "height_px", "[16, 8192]", ""},
    RobotKey{"equipment.cameras.NAME", "fx_fy_cx_cy_px", "4 numbers", "as calibrated"},
    RobotKey{"equipment.cameras.NAME", "k1_k2_p1_p2_k3", "5 numbers", "plumb-bob distortion"},
    RobotKey{"equipment.cameras.NAME", "rate_hz", "[0.1, 240]", "frames per second"},

    RobotKey{"equipment.lasers.NAME", "link", "link", "rays leave along x, turned about z"},
    RobotKey{"equipment.lasers.NAME", "rays", "[2, 10000]", ""},
    RobotKey{"equipment.lasers.NAME", "field_of_view_deg", "[0.1, 360]", "from first to last ray"},
    RobotKey{"equipment.lasers.NAME", "range_m", "2 numbers", "nearest and farthest reading"},

    RobotKey{"equipment.sonars.NAME", "link", "link", "looks along x"},
    RobotKey{"equipment.sonars.NAME", "field_of_view_deg", "[1, 170]", "of the cone"},
    RobotKey{"equipment.sonars.NAME", "range_m", "2 numbers", "nearest and farthest reading"},
    RobotKey{"equipment.sonars.NAME", "resolution_m", "[0, 1]", "step of a reading"},

    RobotKey{"equipment.odometry", "scale", "[-0.5, 0.5]", "of all wheels: 0.01 = 1 % too long"},
    RobotKey{"equipment.odometry", "scale_spread", "[0, 0.2]", "of each wheel's, drawn by seed"},
    RobotKey{"equipment.odometry", "slip_per_sqrt_m", "[0, 0.5]",
             "m of error after 1 m of rim, growing with its root"},
    RobotKey{"equipment.collision_reflex", "ahead_m", "[0, 3]", "from the shell, along its way"},
    RobotKey{"equipment.collision_reflex", "aside_m", "[0, 3]", "to either side of its way"},
};

}  // namespace

std::span<const RobotKey> robot_keys() {
  return kKeys;
}

}  // namespace mh
