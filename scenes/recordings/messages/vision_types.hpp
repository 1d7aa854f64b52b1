// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/recordings/messages/types.hpp"

namespace mh::ros {

/// From vision_msgs 0.0.1 in ROS 1 and 4.1 in ROS 2, which share few fields.
struct ObjectHypothesis {
  static constexpr const char* kType = "vision_msgs/ObjectHypothesis";
  std::string class_id;
  double score = 0;
  static void fields(auto& m, auto& f) {
    f("class_id", m.class_id);
    f("score", m.score);
  }
};

struct ObjectHypothesisWithPose {
  static constexpr const char* kType = "vision_msgs/ObjectHypothesisWithPose";
  std::int64_t id = 0;  ///< of the class, in ROS 1; ROS 2 has its name
  ObjectHypothesis hypothesis;
  PoseWithCovariance pose;
  static void fields(auto& m, auto& f) {
    f.ros1("id", m.id);
    f.ros1("score", m.hypothesis.score);
    f.ros2("hypothesis", m.hypothesis);
    f("pose", m.pose);
  }
};

/// In ROS 1, from geometry_msgs.
struct Pose2D {
  static constexpr const char* kType = "geometry_msgs/Pose2D";
  double x = 0, y = 0, theta = 0;
  static void fields(auto& m, auto& f) {
    f("x", m.x);
    f("y", m.y);
    f("theta", m.theta);
  }
};

struct Point2D {
  static constexpr const char* kType = "vision_msgs/Point2D";
  double x = 0, y = 0;
  static void fields(auto& m, auto& f) {
    f("x", m.x);
    f("y", m.y);
  }
};

/// In ROS 2, from vision_msgs.
struct PlacedPoint2D {
  static constexpr const char* kType = "vision_msgs/Pose2D";
  Point2D position;
  double theta = 0;
  static void fields(auto& m, auto& f) {
    f("position", m.position);
    f("theta", m.theta);
  }
};

struct BoundingBox2D {
  static constexpr const char* kType = "vision_msgs/BoundingBox2D";
  Pose2D center_ros1;  ///< both are filled by box_around()
  PlacedPoint2D center_ros2;
  double size_x = 0, size_y = 0;
  static void fields(auto& m, auto& f) {
    f.ros1("center", m.center_ros1);
    f.ros2("center", m.center_ros2);
    f("size_x", m.size_x);
    f("size_y", m.size_y);
  }
};

struct Detection2D {
  static constexpr const char* kType = "vision_msgs/Detection2D";
  Header header;
  std::vector<ObjectHypothesisWithPose> results;
  BoundingBox2D bbox;
  Image source_img;  ///< only in ROS 1; left empty
  std::string id;    ///< only in ROS 2: the instance
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("results", m.results);
    f("bbox", m.bbox);
    f.ros1("source_img", m.source_img);
    f.ros2("id", m.id);
  }
};

struct Detection2DArray {
  static constexpr const char* kType = "vision_msgs/Detection2DArray";
  static constexpr const char* kMd5 = "402071f61477de256df9f1aa45e6e4c8";
  Header header;
  std::vector<Detection2D> detections;
  static void fields(auto& m, auto& f) {
    f("header", m.header);
    f("detections", m.detections);
  }
};

}  // namespace mh::ros
