// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/recordings/messages/wire.hpp"
#include "slam/io/held_bytes.hpp"

namespace mh {

/// One of the streams of messages in a file.
struct MessageChannel {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Image", in ROS 2 as well
  /// How its messages are serialized; nullopt if not in a format of ROS.
  std::optional<ros::Wire> wire;
  friend bool operator==(const MessageChannel&, const MessageChannel&) = default;
};

/// Where a message is in a file.
struct MessagePlace {
  static constexpr std::uint32_t kFile = UINT32_MAX;
  std::uint32_t chunk = kFile;  ///< kFile: `at` counts from the file's beginning
  std::uint64_t at = 0, size = 0;
  std::int64_t received_ns = 0;  ///< when the recorder received it; 0 if not stored
  std::size_t part = 0;  ///< index of the file in a recording of several files; set by the visitor
};

/// A file of messages, MCAP or a ROS 1 bag, which stays mapped while it is used. When it is opened,
/// its records are read once from beginning to end, without using the indexes: a truncated file has
/// none, and those of other files may be wrong. After that, messages are read by their places; the
/// last compressed chunk used is cached.
class MessageFile {
 public:
  /// Receives each message: its channel, its bytes (valid during the call), its place.
  using Visit =
      std::function<void(const MessageChannel&, std::string_view message, const MessagePlace&)>;

  virtual ~MessageFile() = default;

  const std::vector<MessageChannel>& channels() const { return channels_; }
  std::size_t message_count() const { return messages_; }
  /// What could not be used, one line per kind.
  std::vector<std::string> notes() const;
  /// The message at a place that was passed to a visitor. Safe to call from several threads.
  /// @throws InputError "NAME: chunk at byte N: ..." if its chunk is damaged.
  HeldBytes read(const MessagePlace& place) const;
  const std::string& name() const { return name_; }

 protected:
  /// A part of the file, compressed or not, that holds records.
  struct Chunk {
    std::uint64_t at = 0;  ///< position of its record, for messages to the user
    std::string_view stored;
    std::uint64_t size = 0;            ///< once decompressed
    std::string compression;           ///< "", "none", "lz4", "zstd", "bz2"
    std::optional<std::uint32_t> crc;  ///< CRC-32 of the decompressed bytes
  };

  MessageFile(HeldBytes bytes, std::string name)
      : file_(std::move(bytes)), name_(std::move(name)) {}

  std::string_view bytes() const { return file_.view; }
  /// Adds a chunk; @returns its number. @throws InputError "claims ..." if it claims more bytes
  /// than its file can hold.
  std::uint32_t add_chunk(Chunk chunk);
  /// The decompressed bytes of a chunk. @throws InputError "is ...", which does not name the chunk.
  HeldBytes open_chunk(std::uint32_t number) const;
  /// Counts something that is left out; the first of its kind is described.
  void leave_out(const std::string& kind, std::uint64_t at, const std::string& why);
  /// The kind, for leave_out(), of data after the last whole record.
  static constexpr const char* kCut = "records cut short";
  /// Whether anything of a kind was left out.
  bool leaves_out(const std::string& kind) const { return left_out_.contains(kind); }
  /// @returns the number of a channel, which is added if no equal one exists
  std::size_t channel(MessageChannel channel);
  void count_message() { ++messages_; }

 private:
  struct LeftOut {
    std::size_t count = 0;
    std::string first;
  };

  HeldBytes file_;
  std::string name_;
  std::vector<MessageChannel> channels_;
  std::size_t messages_ = 0;
  std::map<std::string, LeftOut> left_out_;
  std::vector<Chunk> chunks_;
  std::uint64_t claimed_ = 0;          ///< bytes of all chunks, decompressed
  mutable std::mutex mutex_;           ///< guards the members below
  mutable std::vector<bool> checked_;  ///< by chunk: its CRC was found correct
  mutable std::uint32_t opened_ = MessagePlace::kFile;
  mutable HeldBytes opened_bytes_;
};

/// Opens an MCAP file (https://mcap.dev/spec), whatever its profile; chunks may be uncompressed,
/// lz4 or zstd. Summary, footer and unknown records are not needed.
/// @throws InputError if it is not MCAP.
std::unique_ptr<MessageFile> open_mcap(HeldBytes bytes, const std::string& name,
                                       const MessageFile::Visit& visit);

/// Opens a ROS 1 bag of version 2.0, indexed or not; chunks may be uncompressed, bz2 or lz4.
/// @throws InputError if it is not a bag, of another version, or encrypted.
std::unique_ptr<MessageFile> open_bag(HeldBytes bytes, const std::string& name,
                                      const MessageFile::Visit& visit);

}  // namespace mh
