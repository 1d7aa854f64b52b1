// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/recordings/messages/message_log.hpp"
#include "scenes/recordings/sequence_writer.hpp"

namespace mh {

/// A camera's frames as ROS messages: color (rgb8), depth (32FC1, m), the calibration of both,
/// class and instance images, detections, the true pose, and the camera's pose in tf. Depth is
/// rounded to 0.2 mm as in TUM's files, so that a frame has the same bits whether it is read from
/// messages or from TUM's files.
class CameraMessages {
 public:
  using Entries = std::vector<MessageLog::Entry>;

  /// @param log       receives the topics
  /// @param on_robot  whether tf is left to the messages of the robot that carries the camera
  CameraMessages(MessageLog& log, const Camera& camera, bool on_robot);

  /// What is said once, with the first frame: the classes' names, the projector, fixed frames of
  /// reference.
  Entries once(Stamp stamp_ns) const;
  /// The messages of a frame, in the order in which they are written.
  Entries of(std::size_t index, const ExactFrame& frame) const;

 private:
  template <class M>
  MessageLog::Entry entry(std::size_t topic, Stamp stamp_ns, const M& message) const {
    return {stamp_ns, topic, ros::serialized(message, wire_)};
  }

  struct Topics {
    std::size_t color, color_info, depth, depth_info, projector_info, labels, names, instances,
        detections, truth, tf, tf_static;
  };

  Camera camera_;
  bool on_robot_;
  ros::Wire wire_;
  Topics topics_{};
};

}  // namespace mh
