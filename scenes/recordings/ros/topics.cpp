// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/ros/topics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <Eigen/LU>

#include "scenes/image_file.hpp"
#include "scenes/recordings/messages/robot_types.hpp"
#include "scenes/recordings/ros/image.hpp"
#include "scenes/recordings/ros/names.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

/// A frame's name without a leading slash: ROS 1's tf wrote "/map" where tf2 writes "map".
std::string frame_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

/// @throws InputError if it is not a rigid transform.
SE3 rigid(const ros::Quaternion& q, const SE3& pose) {
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(norm - 1) < 0.1) || !pose.translation().allFinite())
    throw InputError("holds a pose that is not a rigid transform");
  return pose;
}
SE3 rigid(const ros::Pose& pose) {
  return rigid(pose.orientation, ros::pose_of(pose));
}
SE3 rigid(const ros::Transform& t) {
  return rigid(t.rotation, ros::pose_of(t));
}
SE3 rigid(const ros::Extrinsics& e) {
  const Eigen::Matrix3d rotation = Eigen::Map<const Eigen::Matrix3d>(e.rotation.data());
  const Eigen::Vector3d translation = Eigen::Map<const Eigen::Vector3d>(e.translation.data());
  const Eigen::Matrix3d off = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  if (!(off.norm() < 1e-3 && rotation.determinant() > 0) || !translation.allFinite())
    throw InputError("holds no rigid transform");
  return {Eigen::Quaterniond(rotation), translation};
}

void set_size(ImageTopic& topic, std::uint32_t width, std::uint32_t height) {
  topic.width_px = static_cast<int>(std::min<std::uint32_t>(width, INT32_MAX));
  topic.height_px = static_cast<int>(std::min<std::uint32_t>(height, INT32_MAX));
}

/// Whether there are several messages and all have the same stamp.
bool stands_still(const auto& stamped) {
  return stamped.size() > 1 && std::ranges::all_of(stamped, [&](const auto& one) {
           return one.stamp_ns == stamped.front().stamp_ns;
         });
}

/// Replaces the stamps of the poses of a topic or an edge with the times of receipt if all stamps
/// are equal.
/// @returns whether it replaced them
bool repair(auto& topic) {
  if (!stands_still(topic.poses)) return false;
  for (std::size_t i = 0; i < topic.poses.size(); ++i)
    topic.poses[i].stamp_ns = topic.received_ns[i];
  return true;
}

}  // namespace

void repair_stamps(RosTopics& topics, const ChosenTopics& chosen, std::vector<std::string>& notes,
                   const std::string& file) {
  const auto note = [&](const std::string& topic) {
    notes.push_back(
        fmt::format("{}: the headers of {} all have the same stamp: the times of receipt are used",
                    file, topic));
  };
  if (stands_still(chosen.color->images) || stands_still(chosen.depth->images)) {
    note(stands_still(chosen.color->images) ? chosen.color->name : chosen.depth->name);
    for (const ImageTopic* topic : {chosen.color, chosen.depth, chosen.labels})
      if (topic != nullptr)
        for (StoredImage& image : topics.images.at(topic->name).images)
          image.stamp_ns = image.place.received_ns;
  }
  for (auto& [name, topic] : topics.poses)
    if (repair(topic)) note(name);
  for (auto& [frame, edge] : topics.tf)
    if (!edge.is_static) repair(edge);
}

void RosTopics::add(const MessageChannel& channel, std::string_view message,
                    const MessagePlace& place) {
  if (!channel.wire) return;
  try {
    add_known(channel, message, place);
  } catch (const InputError& error) {
    if (unreadable++ == 0)
      first_unreadable =
          fmt::format("topic {}: a {} {}", channel.topic, channel.type, error.what());
  }
}

void RosTopics::add_known(const MessageChannel& channel, std::string_view message,
                          const MessagePlace& place) {
  const std::string& type = channel.type;
  const ros::Wire wire = *channel.wire;
  const auto add_pose = [&](const ros::Header& header, const std::string& child, const SE3& pose) {
    PoseTopic& topic = poses[channel.topic];
    topic.parent = frame_name(header.frame_id);
    topic.child = frame_name(child);
    topic.poses.push_back({header.stamp.ns, pose});
    topic.received_ns.push_back(place.received_ns);
  };
  if (type == ros::Image::kType || type == ros::CompressedImage::kType) {
    add_image(channel, message, place);
  } else if (type == ros::CameraInfo::kType) {
    add_calibration(channel.topic, ros::parsed<ros::CameraInfo>(message, wire));
  } else if (type == ros::PoseStamped::kType) {
    const auto m = ros::parsed<ros::PoseStamped>(message, wire);
    add_pose(m.header, "", rigid(m.pose));
  } else if (type == ros::TransformStamped::kType) {
    const auto m = ros::parsed<ros::TransformStamped>(message, wire);
    add_pose(m.header, m.child_frame_id, rigid(m.transform));
  } else if (type == ros::Odometry::kType) {
    const auto m = ros::parsed<ros::Odometry>(message, wire);
    add_pose(m.header, m.child_frame_id, rigid(m.pose.pose));
  } else if (type == ros::TfMessage::kType || type == "tf/tfMessage") {
    const bool is_static = channel.topic.ends_with("tf_static");
    for (const ros::TransformStamped& t : ros::parsed<ros::TfMessage>(message, wire).transforms)
      add_transform(t, is_static, place.received_ns);
  } else if (type == ros::Transform::kType) {
    transforms.try_emplace(channel.topic, rigid(ros::parsed<ros::Transform>(message, wire)));
  } else if (type == ros::Extrinsics::kType || type == ros::Extrinsics::kTypeInRos1) {
    if (wire == ros::Wire::kRos1 && message.size() > ros::Extrinsics::kBytes)
      message.remove_prefix(message.size() - ros::Extrinsics::kBytes);
    transforms.try_emplace(channel.topic, rigid(ros::parsed<ros::Extrinsics>(message, wire)));
  } else if (type == ros::Float32::kType) {
    add_depth_units(channel.topic, ros::parsed<ros::Float32>(message, wire).data);
  }
}

void RosTopics::add_depth_units(const std::string& topic, float meters) {
  for (const std::string_view end : {"/option/Depth_Units/value", "/option/Depth Units/value"}) {
    if (!topic.ends_with(end)) continue;
    if (!(meters > 1e-9F && meters < 1e3F))
      throw InputError(fmt::format("holds {}, which is not a depth unit in meters", meters));
    std::vector<float>& units = depth_units[topic.substr(0, topic.size() - end.size()) + "/"];
    if (std::ranges::find(units, meters) == units.end()) units.push_back(meters);
  }
}

void RosTopics::add_calibration(const std::string& topic, ros::CameraInfo info) {
  const auto [entry, is_new] = calibrations.try_emplace(topic);
  Calibration& known = entry->second;
  if (is_new) {
    known = {topic, std::move(info), {}};
    return;
  }
  const ros::CameraInfo& first = known.info;
  const bool same = info.width == first.width && info.height == first.height &&
                    info.distortion_model == first.distortion_model && info.d == first.d &&
                    info.k == first.k && info.p == first.p;
  if (!same && !known.other_at_ns) known.other_at_ns = info.header.stamp.ns;
}

void RosTopics::add_image(const MessageChannel& channel, std::string_view message,
                          const MessagePlace& place) {
  const auto [entry, is_new] = images.try_emplace(channel.topic);
  ImageTopic& topic = entry->second;
  ros::Header header;
  try {
    if (channel.type == ros::CompressedImage::kType) {
      auto m = ros::parsed<ros::CompressedImage>(message, *channel.wire);
      header = std::move(m.header);
      if (is_new) {
        topic.compressed = true;
        topic.encoding = m.format;
        std::string_view image = m.data;
        if (is_compressed_depth(m.format)) image.remove_prefix(std::min(image.size(), kDepthHead));
        if (const auto size = declared_size(image)) set_size(topic, size->width, size->height);
      }
    } else {
      auto m = ros::parsed<ros::Image>(message, *channel.wire);
      if (m.width == 0 || m.height == 0) throw InputError("has no pixels");
      header = std::move(m.header);
      if (is_new) {
        topic.encoding = m.encoding;
        set_size(topic, m.width, m.height);
      }
    }
  } catch (const InputError&) {
    if (is_new) images.erase(entry);
    throw;
  }
  if (is_new) {
    topic.name = channel.topic;
    topic.frame = frame_name(header.frame_id);
    topic.wire = *channel.wire;
  }
  topic.images.push_back({header.stamp.ns, place});
}

void RosTopics::add_transform(const ros::TransformStamped& t, bool is_static, Stamp received_ns) {
  TfEdge& edge = tf[frame_name(t.child_frame_id)];
  const std::string parent = frame_name(t.header.frame_id);
  if (edge.parent != parent) edge = {parent, is_static, {}, {}};  // it has a new parent from now on
  edge.is_static = is_static;
  edge.poses.push_back({t.header.stamp.ns, rigid(t.transform)});
  edge.received_ns.push_back(received_ns);
}

}  // namespace mh
