// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenes/recordings/messages/message_log.hpp"
#include "scenes/recordings/messages/message_writer.hpp"
#include "scenes/recordings/messages/vision_types.hpp"
#include "scenes/recordings/sequence_writer.hpp"

namespace mh {

/// Writes a camera's frames as ROS messages: color (rgb8), depth (32FC1, m), the calibration of
/// both, class and instance images, detections, the true pose, and the camera's pose in tf. Depth
/// is rounded to 0.2 mm as in TUM's files, so that a frame has the same bits whether it is read
/// from messages or from TUM's files. Messages are written in the order of the frames, regardless
/// of the order in which threads add them.
class RosRecorder : public SequenceWriter {
 public:
  /// @param robot  messages of the robot that carries the camera, including its pose in tf, sorted;
  ///               nullopt if there is no robot. Messages after the last frame are left out
  RosRecorder(std::unique_ptr<MessageWriter> file, const Camera& camera,
              std::optional<MessageLog> robot);

  void add(std::size_t index, const ExactFrame& frame) override;
  /// A file that is written in one pass cannot be resumed.
  bool resume(std::size_t, Stamp, const SE3&) override { return false; }
  void finish() override;

 private:
  struct Message {
    std::uint16_t topic = 0;
    std::string bytes;
  };
  using Messages = std::vector<Message>;

  template <class M>
  std::uint16_t topic(const char* name, bool latched = false) {
    return file_->add_topic(topic_spec<M>(name, file_->wire(), latched));
  }
  template <class M>
  Message message(std::uint16_t topic, const M& message) const {
    return {topic, ros::serialized(message, file_->wire())};
  }
  Messages messages_of(std::size_t index, const ExactFrame& frame) const;
  void write_once();
  void write_robot_until(Stamp stamp_ns);

  struct Topics {
    std::uint16_t color, color_info, depth, depth_info, projector_info, labels, names, instances,
        detections, truth, tf, tf_static;
  };

  std::unique_ptr<MessageWriter> file_;
  Camera camera_;
  std::optional<MessageLog> robot_;
  Topics topics_{};
  std::vector<std::uint16_t> robot_topics_;  ///< topics of the file, by topic of the log
  std::mutex mutex_;                         ///< guards the file and the members below
  std::size_t next_ = 0;                     ///< frame to be written
  std::size_t next_robot_ = 0;               ///< entry of the log
  std::map<std::size_t, std::pair<Stamp, Messages>> waiting_;  ///< until earlier frames arrive
};

/// The calibration as a message.
ros::CameraInfo camera_info_message(const Camera& camera);

/// A box around each instance that has a class, with its most frequent class.
std::vector<ros::Detection2D> detections_of(const Grid2d<ClassId>& classes,
                                            const Grid2d<InstanceId>& instances);

/// Writes a log as the only content of a file.
void write_log(MessageWriter& file, const MessageLog& log);

}  // namespace mh
