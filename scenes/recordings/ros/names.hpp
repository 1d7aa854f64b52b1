// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "scenes/recordings/messages/types.hpp"
#include "slam/core/se3.hpp"

namespace mh::ros {

// Topics that we write, and by which we recognize our own files when reading them.
inline constexpr const char* kColorTopic = "/camera/color/image_raw";
inline constexpr const char* kColorInfoTopic = "/camera/color/camera_info";
inline constexpr const char* kDepthTopic = "/camera/depth_registered/image";
inline constexpr const char* kDepthInfoTopic = "/camera/depth_registered/camera_info";
/// As published by drivers of structured-light cameras: P holds -fx * baseline.
inline constexpr const char* kProjectorInfoTopic = "/camera/projector/camera_info";
inline constexpr const char* kLabelTopic = "/camera/labels/image";
inline constexpr const char* kLabelNamesTopic = "/camera/labels/names";
inline constexpr const char* kInstanceTopic = "/camera/instances/image";
inline constexpr const char* kDetectionTopic = "/camera/detections";
inline constexpr const char* kCameraTruthTopic = "/ground_truth/camera_pose";
inline constexpr const char* kBaseTruthTopic = "/ground_truth/pose";
inline constexpr const char* kTfTopic = "/tf";
inline constexpr const char* kTfStaticTopic = "/tf_static";

// Frames of reference, as REP 105 and REP 103 name them.
inline constexpr const char* kMapFrame = "map";
inline constexpr const char* kOdomFrame = "odom";
inline constexpr const char* kFootprintFrame = "base_footprint";
inline constexpr const char* kBaseFrame = "base_link";
inline constexpr const char* kCameraFrame = "camera_link";
inline constexpr const char* kOpticalFrame = "camera_optical_frame";

/// From the optical frame (x right, y down, z forward) to the body frame (x forward, y left, z up),
/// REP 103.
inline SE3 link_from_optical() {
  Eigen::Matrix3d rotation;
  rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {rotation, Eigen::Vector3d::Zero()};
}

inline Quaternion to_message(const Eigen::Quaterniond& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}
inline Pose pose_message(const SE3& pose) {
  const Eigen::Vector3d& t = pose.translation();
  return {{t.x(), t.y(), t.z()}, to_message(pose.quaternion())};
}
/// The pose of `child` in `parent`.
inline TransformStamped transform_message(std::int64_t stamp_ns, const char* parent,
                                          const std::string& child, const SE3& parent_from_child) {
  const Eigen::Vector3d& t = parent_from_child.translation();
  return {{0, {stamp_ns}, parent},
          child,
          {{t.x(), t.y(), t.z()}, to_message(parent_from_child.quaternion())}};
}

inline SE3 pose_of(const Quaternion& q, double x, double y, double z) {
  return {Eigen::Quaterniond(q.w, q.x, q.y, q.z), {x, y, z}};
}
inline SE3 pose_of(const Pose& pose) {
  return pose_of(pose.orientation, pose.position.x, pose.position.y, pose.position.z);
}
inline SE3 pose_of(const Transform& t) {
  return pose_of(t.rotation, t.translation.x, t.translation.y, t.translation.z);
}

}  // namespace mh::ros
