// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/recordings/messages/types.hpp"

namespace mh::ros {

// Messages of a robot: its measurements, except images, and its map.

struct Bool {
  static constexpr const char* kType = "std_msgs/Bool";
  static constexpr const char* kMd5 = "8b94c1b53db61fb6aed406028ad6332a";
  bool data = false;
  static void fields(auto& m, auto& f) { f("data", m.data); }
};

struct Odometry {
  static constexpr const char* kType = "nav_msgs/Odometry";
  static constexpr const char* kMd5 = "cd5e73d190d741a2f92e81eda573aca7";
  Header header;
  std::string child_frame_id;
  PoseWithCovariance pose;
  TwistWithCovariance twist;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("child_frame_id", m.child_frame_id);
    f("pose", m.pose);
    f("twist", m.twist);
  }
};

struct LaserScan {
  static constexpr const char* kType = "sensor_msgs/LaserScan";
  static constexpr const char* kMd5 = "90c7ef2dc6895d81024acba2ac42f369";
  Header header;
  float angle_min = 0, angle_max = 0, angle_increment = 0, time_increment = 0, scan_time = 0,
        range_min = 0, range_max = 0;
  std::vector<float> ranges, intensities;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("angle_min", m.angle_min);
    f("angle_max", m.angle_max);
    f("angle_increment", m.angle_increment);
    f("time_increment", m.time_increment);
    f("scan_time", m.scan_time);
    f("range_min", m.range_min);
    f("range_max", m.range_max);
    f("ranges", m.ranges);
    f("intensities", m.intensities);
  }
};

struct Imu {
  static constexpr const char* kType = "sensor_msgs/Imu";
  static constexpr const char* kMd5 = "6a62c6daae103f4ff57a132d6f95cec2";
  Header header;
  Quaternion orientation;
  std::array<double, 9> orientation_covariance{};
  Vector3 angular_velocity;
  std::array<double, 9> angular_velocity_covariance{};
  Vector3 linear_acceleration;
  std::array<double, 9> linear_acceleration_covariance{};
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("orientation", m.orientation);
    f("orientation_covariance", m.orientation_covariance);
    f("angular_velocity", m.angular_velocity);
    f("angular_velocity_covariance", m.angular_velocity_covariance);
    f("linear_acceleration", m.linear_acceleration);
    f("linear_acceleration_covariance", m.linear_acceleration_covariance);
  }
};

struct Range {
  static constexpr const char* kType = "sensor_msgs/Range";
  static constexpr const char* kMd5 = "c005c34273dc426c67a020a87bc24148";
  static constexpr std::uint8_t kUltrasound = 0, kInfrared = 1;
  Header header;
  std::uint8_t radiation_type = kUltrasound;
  float field_of_view = 0, min_range = 0, max_range = 0, range = 0;
  static void fields(auto& m, auto& f) {
    f.constant("ULTRASOUND", kUltrasound);
    f.constant("INFRARED", kInfrared);
    f("header", m.header);
    f("radiation_type", m.radiation_type);
    f("field_of_view", m.field_of_view);
    f("min_range", m.min_range);
    f("max_range", m.max_range);
    f("range", m.range);
  }
};

struct MapMetaData {
  static constexpr const char* kType = "nav_msgs/MapMetaData";
  Time map_load_time;
  float resolution = 0;
  std::uint32_t width = 0, height = 0;
  Pose origin;
  static void fields(auto& m, auto& f) {
    f("map_load_time", m.map_load_time);
    f("resolution", m.resolution);
    f("width", m.width);
    f("height", m.height);
    f("origin", m.origin);
  }
};

struct OccupancyGrid {
  static constexpr const char* kType = "nav_msgs/OccupancyGrid";
  static constexpr const char* kMd5 = "3381f2d731d4076ec5c71b0759edbe4e";
  Header header;
  MapMetaData info;
  std::vector<std::int8_t> data;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("info", m.info);
    f("data", m.data);
  }
};

struct Path {
  static constexpr const char* kType = "nav_msgs/Path";
  static constexpr const char* kMd5 = "6227e2b7e9cce15051f669a5e197bbf7";
  Header header;
  std::vector<PoseStamped> poses;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("poses", m.poses);
  }
};

struct PointField {
  static constexpr const char* kType = "sensor_msgs/PointField";
  static constexpr std::uint8_t kUint32 = 6, kFloat32 = 7;
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = kFloat32;
  std::uint32_t count = 1;
  static void fields(auto& m, auto& f) {
    f("name", m.name);
    f("offset", m.offset);
    f("datatype", m.datatype);
    f("count", m.count);
  }
};

struct PointCloud2 {
  static constexpr const char* kType = "sensor_msgs/PointCloud2";
  static constexpr const char* kMd5 = "1158d486dd51d683ce2f1be655c3c181";
  Header header;
  std::uint32_t height = 1, width = 0;
  std::vector<PointField> points;  ///< what a point consists of
  bool is_bigendian = false;
  std::uint32_t point_step = 0, row_step = 0;
  Bytes data;
  bool is_dense = true;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("height", m.height);
    f("width", m.width);
    f("fields", m.points);
    f("is_bigendian", m.is_bigendian);
    f("point_step", m.point_step);
    f("row_step", m.row_step);
    f("data", m.data);
    f("is_dense", m.is_dense);
  }
};

}  // namespace mh::ros
