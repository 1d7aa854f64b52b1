// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "scenes/recordings/messages/message_log.hpp"
#include "scenes/recordings/messages/message_writer.hpp"
#include "scenes/recordings/ros/camera_messages.hpp"
#include "scenes/recordings/sequence_writer.hpp"

namespace mh {

/// Writes a camera's frames as ROS messages (CameraMessages), in the order of the frames,
/// regardless of the order in which threads add them.
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
  void write(const CameraMessages::Entries& entries);
  void write_robot_until(Stamp stamp_ns);

  std::unique_ptr<MessageWriter> file_;
  MessageLog all_;  ///< all topics; its entries stay empty
  CameraMessages camera_;
  std::optional<MessageLog> robot_;
  std::vector<std::uint16_t> topics_;      ///< of the file, by topic of all_
  std::vector<std::size_t> robot_topics_;  ///< of all_, by topic of the robot's log
  std::mutex mutex_;                       ///< guards the file and the members below
  std::size_t next_ = 0;                   ///< frame to be written
  std::size_t next_robot_ = 0;             ///< entry of the robot's log
  /// Frames that wait until earlier ones arrive.
  std::map<std::size_t, std::pair<Stamp, CameraMessages::Entries>> waiting_;
};

/// Writes a log as the only content of a file.
void write_log(MessageWriter& file, const MessageLog& log);

}  // namespace mh
