// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/recordings/messages/message_file.hpp"
#include "scenes/recordings/ros/topic_names.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/trajectory.hpp"

namespace mh {

/// An image message of a file: when it was taken, and where it is stored.
struct StoredImage {
  Stamp stamp_ns = 0;
  MessagePlace place;
};

/// A topic of images. Encoding, size and frame are those of its first message.
struct ImageTopic {
  std::string name;
  bool compressed = false;          ///< sensor_msgs/CompressedImage
  std::string encoding;             ///< "rgb8"; of compressed images, the format, "jpeg"
  int width_px = 0, height_px = 0;  ///< 0 for compressed images whose header does not state it
  std::string frame;
  ros::Wire wire = ros::Wire::kRos1;
  std::vector<StoredImage> images;
};

/// A topic of calibrations.
struct Calibration {
  std::string topic;
  ros::CameraInfo info;              ///< the first message's content
  std::optional<Stamp> other_at_ns;  ///< stamp of the first that differs; nullopt if none does
};

/// A topic of poses: PoseStamped, TransformStamped or Odometry.
struct PoseTopic {
  std::string parent, child;  ///< frames; child is empty where the type has none
  std::vector<TimedPose> poses;
  std::vector<Stamp> received_ns;  ///< when each came
};

/// A frame of tf, in its parent frame.
struct TfEdge {
  std::string parent;
  bool is_static = false;
  std::vector<TimedPose> poses;    ///< parent_from_child, in the file's order
  std::vector<Stamp> received_ns;  ///< when each came
};

/// The content of a file of messages that matters for SLAM.
struct RosTopics {
  std::map<std::string, ImageTopic> images;
  std::map<std::string, Calibration> calibrations;
  std::map<std::string, PoseTopic> poses;
  std::map<std::string, TfEdge> tf;  ///< by the name of the child frame
  /// Transforms between two cameras by topic, as RealSense's recorder and driver state them.
  std::map<std::string, SE3> transforms;
  /// Meters per unit of depth, by the prefix of the depth topics' names (RealSense); each value
  /// once, in the file's order.
  std::map<std::string, std::vector<float>> depth_units;
  std::size_t unreadable = 0;    ///< messages of these types that could not be parsed
  std::string first_unreadable;  ///< what was wrong with the first

  /// Adds a message. Types that are not used here are ignored.
  void add(const MessageChannel& channel, std::string_view message, const MessagePlace& place);

 private:
  void add_known(const MessageChannel& channel, std::string_view message,
                 const MessagePlace& place);
  void add_image(const MessageChannel& channel, std::string_view message,
                 const MessagePlace& place);
  void add_calibration(const std::string& topic, ros::CameraInfo info);
  void add_transform(const ros::TransformStamped& t, bool is_static, Stamp received_ns);
  void add_depth_units(const std::string& topic, float meters);
};

/// The topics that a recording is made of.
struct ChosenTopics {
  const ImageTopic* color = nullptr;
  const ImageTopic* depth = nullptr;
  const ImageTopic* labels = nullptr;       ///< may be null
  const Calibration* info = nullptr;        ///< calibration of color; may be null
  const Calibration* depth_info = nullptr;  ///< of depth; may be null
};
/// Chooses by name, otherwise by type and encoding.
/// @throws InputError naming the file and its topics if there is no topic of a kind, or more than
/// one.
ChosenTopics choose_topics(const RosTopics& topics, const TopicNames& names,
                           const std::vector<MessageChannel>& channels, const std::string& file);

/// Some drivers forget to set stamps: if all messages of color or of depth have the same stamp, all
/// images get their times of receipt instead. The same applies to each topic of poses.
/// @param notes  receives a line for each repair
void repair_stamps(RosTopics& topics, const ChosenTopics& chosen, std::vector<std::string>& notes,
                   const std::string& file);

/// The transform to `to` from `from`, composed of tf's transforms that do not change; nullopt if
/// these do not connect the frames.
std::optional<SE3> fixed_transform(const RosTopics& topics, const std::string& to,
                                   const std::string& from);

/// The true trajectory of the camera's optical frame, from a topic of poses (the one in `names`,
/// ours, or one whose name says that it is ground truth), or from tf between "world" or "map" and
/// that frame; nullopt if there is none.
/// @param color   its frame is the optical frame; tf is evaluated at its stamps if more than one of
/// tf's frames moves
/// @param notes   receives where the truth was taken from, unless it is ours
/// @throws InputError if a named topic holds no poses, or cannot be connected to the camera.
std::optional<Trajectory> true_trajectory(const RosTopics& topics, const TopicNames& names,
                                          const ImageTopic& color, std::vector<std::string>& notes,
                                          const std::string& file);

}  // namespace mh
