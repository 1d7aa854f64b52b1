// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenes/recordings/messages/message_writer.hpp"
#include "scenes/recordings/messages/wire.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Serialized messages of several topics, in memory, to be merged with others by stamp when they
/// are written.
class MessageLog {
 public:
  struct Entry {
    Stamp stamp_ns = 0;
    std::size_t topic = 0;  ///< index into topics()
    std::string message;
  };

  explicit MessageLog(ros::Wire wire) : wire_(wire) {}

  template <class M>
  std::size_t add_topic(std::string name, bool latched = false) {
    return add_topic(topic_spec<M>(std::move(name), wire_, latched));
  }
  /// @returns the topic of that name, if there is one already
  std::size_t add_topic(TopicSpec topic) {
    const auto known = std::ranges::find(topics_, topic.name, &TopicSpec::name);
    if (known != topics_.end()) return static_cast<std::size_t>(known - topics_.begin());
    topics_.push_back(std::move(topic));
    return topics_.size() - 1;
  }
  template <class M>
  void add(std::size_t topic, Stamp stamp_ns, const M& message) {
    entries_.push_back({stamp_ns, topic, ros::serialized(message, wire_)});
  }
  /// Sorts the messages by stamp; messages with the same stamp stay in the order in which they were
  /// added.
  void sort() { std::ranges::stable_sort(entries_, {}, &Entry::stamp_ns); }

  ros::Wire wire() const { return wire_; }
  const std::vector<TopicSpec>& topics() const { return topics_; }
  const std::vector<Entry>& entries() const { return entries_; }
  /// Returns the messages and forgets them.
  std::vector<Entry> take_entries() { return std::exchange(entries_, {}); }

 private:
  ros::Wire wire_;
  std::vector<TopicSpec> topics_;
  std::vector<Entry> entries_;
};

}  // namespace mh
