// SPDX-License-Identifier: Apache-2.0
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "scenes/recordings/messages/byte_reader.hpp"
#include "scenes/recordings/messages/decompress.hpp"
#include "scenes/recordings/messages/mcap_format.hpp"
#include "scenes/recordings/messages/message_writer.hpp"
#include "scenes/recordings/messages/output_file.hpp"

namespace mh {
namespace {

using mcap::Opcode;

constexpr std::array kCompressionNames = {"", "lz4", "zstd"};

std::uint32_t checksum(std::uint32_t before, std::string_view bytes) {
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

/// A chunk's entry in the summary.
struct ChunkEntry {
  std::uint64_t first_ns = UINT64_MAX, last_ns = 0, at = 0, size = 0, indexes_size = 0,
                stored_size = 0, content_size = 0;
  std::vector<std::pair<std::uint16_t, std::uint64_t>> indexes;  ///< channel, place
};

class McapWriter : public MessageWriter {
 public:
  McapWriter(const std::filesystem::path& file, ChunkCompression compression)
      : file_(file), compression_(kCompressionNames.at(static_cast<std::size_t>(compression))) {
    put(mcap::kMagic);
    ByteWriter header;
    header.text("ros2");
    header.text("modelhouse");
    put_record(Opcode::kHeader, header.bytes());
  }

  ros::Wire wire() const override { return ros::Wire::kCdr; }

  std::uint16_t add_topic(const TopicSpec& topic) override {
    const auto [schema, is_new] =
        schema_ids_.emplace(topic.type, static_cast<std::uint16_t>(schema_ids_.size() + 1));
    if (is_new) {
      ByteWriter record;  // id 0 stands for no schema
      record.number(schema->second);
      record.text(ros::type_name(topic.type, ros::Wire::kCdr));
      record.text("ros2msg");
      record.text(topic.definition);
      define(Opcode::kSchema, schemas_, record.bytes());
    }
    const auto id = static_cast<std::uint16_t>(channels_.size());
    ByteWriter quality;  // latched topics: durability "transient local", as written by rosbag2
    quality.text("offered_qos_profiles");
    quality.text(quality_of_service(topic.latched));
    ByteWriter record;
    record.number(id);
    record.number(schema->second);
    record.text(topic.name);
    record.text("cdr");
    record.text(quality.bytes());
    define(Opcode::kChannel, channels_, record.bytes());
    counts_.push_back(0);
    return id;
  }

  void write(std::uint16_t topic, Stamp stamp_ns, std::string_view message) override {
    const auto time = static_cast<std::uint64_t>(stamp_ns);
    index_[topic].emplace_back(time, chunk_.size());
    chunk_.number(static_cast<std::uint8_t>(Opcode::kMessage));
    chunk_.number(std::uint64_t{22} + message.size());
    chunk_.number(topic);
    chunk_.number(static_cast<std::uint32_t>(counts_[topic]++));
    chunk_.number(time);
    chunk_.number(time);
    chunk_.raw(message);
    entry_.first_ns = std::min(entry_.first_ns, time);
    entry_.last_ns = std::max(entry_.last_ns, time);
    if (chunk_.size() >= kChunkBytes) end_chunk();
  }

  void finish() override {
    if (chunk_.size() > 0) end_chunk();
    ByteWriter end;
    end.number(crc_);  // checksum of everything before this record
    put_record(Opcode::kDataEnd, end.bytes());
    write_summary();
    put(mcap::kMagic);
    file_.finish();
  }

 private:
  static std::string quality_of_service(bool latched) {
    // History: keep last; the depth; reliable; durability: 1 transient local, 2 volatile.
    return fmt::format(
        "- history: 1\n  depth: {}\n  reliability: 1\n  durability: {}\n  deadline:\n    sec: 0\n  "
        "  nsec: 0\n  lifespan:\n    sec: 0\n    nsec: 0\n  liveliness: 0\n  "
        "liveliness_lease_duration:\n    sec: 0\n    nsec: 0\n  "
        "avoid_ros_namespace_conventions: false",
        latched ? 1 : 10, latched ? 1 : 2);
  }

  void put(std::string_view bytes) {
    crc_ = checksum(crc_, bytes);
    file_.append(bytes);
  }
  static void append_record(ByteWriter& to, Opcode opcode, std::string_view content) {
    to.number(static_cast<std::uint8_t>(opcode));
    to.number(static_cast<std::uint64_t>(content.size()));
    to.raw(content);
  }
  void put_record(Opcode opcode, std::string_view content) {
    ByteWriter record;
    append_record(record, opcode, content);
    put(record.bytes());
  }
  /// Schemas and channels are written in the chunk before their first message, and in the summary.
  void define(Opcode opcode, std::vector<std::string>& kept, const std::string& content) {
    append_record(chunk_, opcode, content);
    kept.push_back(content);
  }

  void end_chunk() {
    const std::string stored =
        compression_.empty() ? std::string() : compress(chunk_.bytes(), compression_);
    const std::string_view content = compression_.empty() ? chunk_.bytes() : stored;
    if (entry_.first_ns > entry_.last_ns) entry_.first_ns = 0;  // no message in it
    entry_.at = file_.size();
    entry_.content_size = chunk_.size();
    entry_.stored_size = content.size();
    ByteWriter head;
    head.number(entry_.first_ns);
    head.number(entry_.last_ns);
    head.number(entry_.content_size);
    head.number(checksum(0, chunk_.bytes()));
    head.text(compression_);
    head.number(entry_.stored_size);
    ByteWriter start;
    start.number(static_cast<std::uint8_t>(Opcode::kChunk));
    start.number(static_cast<std::uint64_t>(head.size() + content.size()));
    start.raw(head.bytes());
    put(start.bytes());
    put(content);
    entry_.size = file_.size() - entry_.at;
    for (auto& [channel, places] : index_) {
      std::ranges::stable_sort(places, {}, &std::pair<std::uint64_t, std::uint64_t>::first);
      ByteWriter list;
      for (const auto& [time, at] : places) {
        list.number(time);
        list.number(at);
      }
      ByteWriter record;
      record.number(channel);
      record.text(list.bytes());
      entry_.indexes.emplace_back(channel, file_.size());
      put_record(Opcode::kMessageIndex, record.bytes());
    }
    entry_.indexes_size = file_.size() - entry_.at - entry_.size;
    chunks_.push_back(std::exchange(entry_, {}));
    chunk_.clear();
    index_.clear();
  }

  std::string chunk_index(const ChunkEntry& chunk) const {
    ByteWriter indexes;
    for (const auto& [channel, at] : chunk.indexes) {
      indexes.number(channel);
      indexes.number(at);
    }
    ByteWriter record;
    record.number(chunk.first_ns);
    record.number(chunk.last_ns);
    record.number(chunk.at);
    record.number(chunk.size);
    record.text(indexes.bytes());
    record.number(chunk.indexes_size);
    record.text(compression_);
    record.number(chunk.stored_size);
    record.number(chunk.content_size);
    return record.bytes();
  }

  std::string statistics() const {
    std::uint64_t messages = 0, first_ns = UINT64_MAX, last_ns = 0;
    ByteWriter counts;
    for (std::size_t id = 0; id < counts_.size(); ++id) {
      messages += counts_[id];
      counts.number(static_cast<std::uint16_t>(id));
      counts.number(counts_[id]);
    }
    for (const ChunkEntry& chunk : chunks_) {
      first_ns = std::min(first_ns, chunk.first_ns);
      last_ns = std::max(last_ns, chunk.last_ns);
    }
    ByteWriter record;
    record.number(messages);
    record.number(static_cast<std::uint16_t>(schemas_.size()));
    record.number(static_cast<std::uint32_t>(channels_.size()));
    record.number(std::uint32_t{0});  // attachments
    record.number(std::uint32_t{0});  // metadata
    record.number(static_cast<std::uint32_t>(chunks_.size()));
    record.number(chunks_.empty() ? 0 : first_ns);
    record.number(last_ns);
    record.text(counts.bytes());
    return record.bytes();
  }

  void write_summary() {
    const std::uint64_t start = file_.size();
    ByteWriter summary, offsets;
    const auto add_group = [&](Opcode opcode, const std::vector<std::string>& records) {
      const std::uint64_t at = start + summary.size();
      for (const std::string& record : records) append_record(summary, opcode, record);
      if (records.empty()) return;
      ByteWriter offset;
      offset.number(static_cast<std::uint8_t>(opcode));
      offset.number(at);
      offset.number(start + summary.size() - at);
      append_record(offsets, Opcode::kSummaryOffset, offset.bytes());
    };
    std::vector<std::string> indexes;
    for (const ChunkEntry& chunk : chunks_) indexes.push_back(chunk_index(chunk));
    add_group(Opcode::kSchema, schemas_);
    add_group(Opcode::kChannel, channels_);
    add_group(Opcode::kStatistics, {statistics()});
    add_group(Opcode::kChunkIndex, indexes);
    const std::uint64_t offsets_at = start + summary.size();
    summary.raw(offsets.bytes());
    summary.number(static_cast<std::uint8_t>(Opcode::kFooter));
    summary.number(std::uint64_t{20});
    summary.number(start);
    summary.number(offsets_at);
    const std::uint32_t crc = checksum(0, summary.bytes());  // up to here
    summary.number(crc);
    file_.append(summary.bytes());
  }

  OutputFile file_;
  std::string compression_;
  std::uint32_t crc_ = 0;  ///< of the file so far
  std::map<std::string, std::uint16_t> schema_ids_;
  std::vector<std::string> schemas_, channels_;  ///< records, by id
  std::vector<std::uint64_t> counts_;            ///< messages by channel
  ByteWriter chunk_;
  /// Stamp and position of each message in the open chunk, by channel.
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;
  ChunkEntry entry_;  ///< of the open chunk
  std::vector<ChunkEntry> chunks_;
};

}  // namespace

std::unique_ptr<MessageWriter> write_mcap(const std::filesystem::path& file,
                                          ChunkCompression compression) {
  return std::make_unique<McapWriter>(file, compression);
}

}  // namespace mh
