// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mh::ros {

// The ROS messages that are written and read, as ROS 1 (Noetic) and ROS 2 (Humble) define them. A
// message lists its fields once, in order, to a visitor `f`: f(name, member) for a field in both
// versions, f(name in ROS 1, name in ROS 2, member) where the names differ, f.ros1() and f.ros2()
// for a field in only one version. Serialization, parsing and the text of the definition follow
// from this list (wire.hpp, definition.hpp). kMd5 is the published checksum of the definition in
// ROS 1, for types that are sent.

struct Time {
  std::int64_t ns = 0;
};

struct Duration {
  std::int64_t ns = 0;
};

/// uint8[], as a view of bytes stored elsewhere, so that an image's bytes are not copied.
using Bytes = std::string_view;

struct Header {
  static constexpr const char* kType = "std_msgs/Header";
  std::uint32_t seq = 0;
  Time stamp;
  std::string frame_id;
  static void fields(auto& m, auto& f) {
    f.ros1("seq", m.seq);
    f("stamp", m.stamp);
    f("frame_id", m.frame_id);
  }
};

struct String {
  static constexpr const char* kType = "std_msgs/String";
  static constexpr const char* kMd5 = "992ce8a1687cec8c8bd883ec73ca41d1";
  std::string data;
  static void fields(auto& m, auto& f) { f("data", m.data); }
};

struct Float32 {
  static constexpr const char* kType = "std_msgs/Float32";
  static constexpr const char* kMd5 = "73fcbf46b49191e672908e50842a83d4";
  float data = 0;
  static void fields(auto& m, auto& f) { f("data", m.data); }
};

struct Image {
  static constexpr const char* kType = "sensor_msgs/Image";
  static constexpr const char* kMd5 = "060021388200f6f0f447d0fcd9c64743";
  Header header;
  std::uint32_t height = 0, width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;  ///< bytes of a row
  Bytes data;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("height", m.height);
    f("width", m.width);
    f("encoding", m.encoding);
    f("is_bigendian", m.is_bigendian);
    f("step", m.step);
    f("data", m.data);
  }
};

struct CompressedImage {
  static constexpr const char* kType = "sensor_msgs/CompressedImage";
  static constexpr const char* kMd5 = "8f7a12909da2c9d3332d540a0977563f";
  Header header;
  std::string format;
  Bytes data;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("format", m.format);
    f("data", m.data);
  }
};

struct RegionOfInterest {
  static constexpr const char* kType = "sensor_msgs/RegionOfInterest";
  std::uint32_t x_offset = 0, y_offset = 0, height = 0, width = 0;
  bool do_rectify = false;
  static void fields(auto& m, auto& f) {
    f("x_offset", m.x_offset);
    f("y_offset", m.y_offset);
    f("height", m.height);
    f("width", m.width);
    f("do_rectify", m.do_rectify);
  }
};

struct CameraInfo {
  static constexpr const char* kType = "sensor_msgs/CameraInfo";
  static constexpr const char* kMd5 = "c9a58c1b0b154e0e6da7578cb991d214";
  Header header;
  std::uint32_t height = 0, width = 0;
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{}, r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0, binning_y = 0;
  RegionOfInterest roi;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("height", m.height);
    f("width", m.width);
    f("distortion_model", m.distortion_model);
    f("D", "d", m.d);
    f("K", "k", m.k);
    f("R", "r", m.r);
    f("P", "p", m.p);
    f("binning_x", m.binning_x);
    f("binning_y", m.binning_y);
    f("roi", m.roi);
  }
};

struct Point {
  static constexpr const char* kType = "geometry_msgs/Point";
  double x = 0, y = 0, z = 0;
  static void fields(auto& m, auto& f) {
    f("x", m.x);
    f("y", m.y);
    f("z", m.z);
  }
};

struct Vector3 {
  static constexpr const char* kType = "geometry_msgs/Vector3";
  double x = 0, y = 0, z = 0;
  static void fields(auto& m, auto& f) {
    f("x", m.x);
    f("y", m.y);
    f("z", m.z);
  }
};

struct Quaternion {
  static constexpr const char* kType = "geometry_msgs/Quaternion";
  double x = 0, y = 0, z = 0, w = 1;
  static void fields(auto& m, auto& f) {
    f("x", m.x);
    f("y", m.y);
    f("z", m.z);
    f("w", m.w);
  }
};

struct Pose {
  static constexpr const char* kType = "geometry_msgs/Pose";
  Point position;
  Quaternion orientation;
  static void fields(auto& m, auto& f) {
    f("position", m.position);
    f("orientation", m.orientation);
  }
};

struct PoseStamped {
  static constexpr const char* kType = "geometry_msgs/PoseStamped";
  static constexpr const char* kMd5 = "d3812c3cbc69362b77dc0b19b345f8f5";
  Header header;
  Pose pose;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("pose", m.pose);
  }
};

struct PoseWithCovariance {
  static constexpr const char* kType = "geometry_msgs/PoseWithCovariance";
  Pose pose;
  std::array<double, 36> covariance{};
  static void fields(auto& m, auto& f) {
    f("pose", m.pose);
    f("covariance", m.covariance);
  }
};

struct Twist {
  static constexpr const char* kType = "geometry_msgs/Twist";
  Vector3 linear, angular;
  static void fields(auto& m, auto& f) {
    f("linear", m.linear);
    f("angular", m.angular);
  }
};

struct TwistWithCovariance {
  static constexpr const char* kType = "geometry_msgs/TwistWithCovariance";
  Twist twist;
  std::array<double, 36> covariance{};
  static void fields(auto& m, auto& f) {
    f("twist", m.twist);
    f("covariance", m.covariance);
  }
};

struct Transform {
  static constexpr const char* kType = "geometry_msgs/Transform";
  static constexpr const char* kMd5 = "ac9eff44abf714214112b05d54a3cf9b";
  Vector3 translation;
  Quaternion rotation;
  static void fields(auto& m, auto& f) {
    f("translation", m.translation);
    f("rotation", m.rotation);
  }
};

/// The transform from one stream of a RealSense to another; in ROS 1, a header precedes it.
struct Extrinsics {
  static constexpr const char* kType = "realsense2_camera_msgs/Extrinsics";
  static constexpr const char* kTypeInRos1 = "realsense2_camera/Extrinsics";
  static constexpr const char* kMd5 = "f30674f1051f678d172dec40a1dbf2aa";  // without a header
  static constexpr std::size_t kBytes = 12 * sizeof(double);
  std::array<double, 9> rotation{};  ///< by columns
  std::array<double, 3> translation{};
  static void fields(auto& m, auto& f) {
    f("rotation", m.rotation);
    f("translation", m.translation);
  }
};

struct TransformStamped {
  static constexpr const char* kType = "geometry_msgs/TransformStamped";
  static constexpr const char* kMd5 = "b5764a33bfeb3588febc2682852579b0";
  Header header;
  std::string child_frame_id;
  Transform transform;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("child_frame_id", m.child_frame_id);
    f("transform", m.transform);
  }
};

struct TfMessage {
  static constexpr const char* kType = "tf2_msgs/TFMessage";
  static constexpr const char* kMd5 = "94810edda583a504dfda3829e70d7eec";
  std::vector<TransformStamped> transforms;
  static void fields(auto& m, auto& f) { f("transforms", m.transforms); }
};

}  // namespace mh::ros
