// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/ros/recorder.hpp"

#include <utility>

namespace mh {

RosRecorder::RosRecorder(std::unique_ptr<MessageWriter> file, const Camera& camera,
                         std::optional<MessageLog> robot)
    : file_(std::move(file)),
      all_(file_->wire()),
      camera_(all_, camera, robot.has_value()),
      robot_(std::move(robot)) {
  if (robot_)
    for (const TopicSpec& topic : robot_->topics()) robot_topics_.push_back(all_.add_topic(topic));
  for (const TopicSpec& topic : all_.topics()) topics_.push_back(file_->add_topic(topic));
}

void RosRecorder::write(const CameraMessages::Entries& entries) {
  for (const MessageLog::Entry& entry : entries)
    file_->write(topics_[entry.topic], entry.stamp_ns, entry.message);
}

void RosRecorder::write_robot_until(Stamp stamp_ns) {
  if (!robot_) return;
  const std::vector<MessageLog::Entry>& entries = robot_->entries();
  for (; next_robot_ < entries.size() && entries[next_robot_].stamp_ns <= stamp_ns; ++next_robot_)
    file_->write(topics_[robot_topics_[entries[next_robot_].topic]], entries[next_robot_].stamp_ns,
                 entries[next_robot_].message);
}

void RosRecorder::add(std::size_t index, const ExactFrame& frame) {
  CameraMessages::Entries entries = camera_.of(index, frame);
  const std::scoped_lock lock(mutex_);
  waiting_.emplace(index, std::pair(frame.seen.stamp_ns, std::move(entries)));
  for (auto next = waiting_.find(next_); next != waiting_.end(); next = waiting_.find(next_)) {
    const auto& [stamp_ns, ready] = next->second;
    if (next_ == 0) write(camera_.once(stamp_ns));
    write_robot_until(stamp_ns);
    write(ready);
    waiting_.erase(next);
    ++next_;
  }
}

void RosRecorder::finish() {
  file_->finish();
}

void write_log(MessageWriter& file, const MessageLog& log) {
  std::vector<std::uint16_t> topics;
  for (const TopicSpec& spec : log.topics()) topics.push_back(file.add_topic(spec));
  for (const MessageLog::Entry& entry : log.entries())
    file.write(topics[entry.topic], entry.stamp_ns, entry.message);
  file.finish();
}

}  // namespace mh
