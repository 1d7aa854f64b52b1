// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "scenes/recordings/messages/definition.hpp"
#include "scenes/recordings/messages/wire.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// A topic to write.
struct TopicSpec {
  std::string name;
  std::string type;        ///< as in ROS 1: "sensor_msgs/Image"
  std::string definition;  ///< in the language of .msg files
  std::string md5;         ///< checksum of the definition in ROS 1
  bool latched = false;    ///< kept for later subscribers
};

template <class M>
TopicSpec topic_spec(std::string name, ros::Wire wire, bool latched = false) {
  return {std::move(name), M::kType, ros::definition<M>(wire), M::kMd5, latched};
}

/// Compression of a file's chunks.
enum class ChunkCompression { kNone, kLz4, kZstd };

/// A chunk ends once it has this many bytes, before compression.
inline constexpr std::size_t kChunkBytes = std::size_t{4} << 20;

/// Writes a file of messages, MCAP or a ROS 1 bag. The file appears under its name when it is
/// finished; an unfinished file leaves nothing behind.
class MessageWriter {
 public:
  virtual ~MessageWriter() = default;
  /// How messages have to be serialized.
  virtual ros::Wire wire() const = 0;
  /// @returns the topic's number
  virtual std::uint16_t add_topic(const TopicSpec& topic) = 0;
  /// @param stamp_ns  when it was received; readers of bags reject time 0, so a message with that
  /// time counts as received 1 ns later
  virtual void write(std::uint16_t topic, Stamp stamp_ns, std::string_view message) = 0;
  virtual void finish() = 0;
};

/// An MCAP file with ROS 2's messages: chunks of a few MB with their indexes, summary, checksums.
/// @throws MachineError, InputError if it cannot be written, as do the writer's functions.
std::unique_ptr<MessageWriter> write_mcap(const std::filesystem::path& file,
                                          ChunkCompression compression = ChunkCompression::kNone);

/// A ROS 1 bag of version 2.0. @throws InputError also on zstd, which bags do not support.
std::unique_ptr<MessageWriter> write_bag(const std::filesystem::path& file,
                                         ChunkCompression compression = ChunkCompression::kNone);

}  // namespace mh
