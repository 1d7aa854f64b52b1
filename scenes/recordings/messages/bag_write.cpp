// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "scenes/recordings/messages/bag_format.hpp"
#include "scenes/recordings/messages/byte_reader.hpp"
#include "scenes/recordings/messages/decompress.hpp"
#include "scenes/recordings/messages/message_writer.hpp"
#include "scenes/recordings/messages/output_file.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using bag::Op;

constexpr std::size_t kBagHeaderBytes = 4096;  // padded, so that it can be rewritten

/// Fields of a record's header.
class HeaderFields {
 public:
  explicit HeaderFields(Op op) { add("op", static_cast<std::uint8_t>(op)); }
  HeaderFields() = default;
  template <class T>
  requires std::is_integral_v<T> HeaderFields& add(std::string_view name, T number) {
    ByteWriter value;
    value.number(number);
    return add(name, std::string_view(value.bytes()));
  }
  HeaderFields& add(std::string_view name, std::string_view value) {
    fields_.number(static_cast<std::uint32_t>(name.size() + 1 + value.size()));
    fields_.raw(name);
    fields_.raw("=");
    fields_.raw(value);
    return *this;
  }
  const std::string& bytes() const { return fields_.bytes(); }

 private:
  ByteWriter fields_;
};

void append_record(ByteWriter& to, const HeaderFields& header, std::string_view data) {
  to.text(header.bytes());
  to.text(data);
}

/// Seconds and nanoseconds as two u32, packed into one number.
std::uint64_t time_of(Stamp stamp_ns) {
  constexpr Stamp kSecond_ns = 1'000'000'000;
  return static_cast<std::uint64_t>(stamp_ns / kSecond_ns) |
         static_cast<std::uint64_t>(stamp_ns % kSecond_ns) << 32;
}

class BagWriter : public MessageWriter {
 public:
  BagWriter(const std::filesystem::path& file, ChunkCompression compression)
      : file_(file), lz4_(compression == ChunkCompression::kLz4) {
    file_.append(bag::kMagic);
    file_.append(bag_header(0));  // marks a bag that is not closed
  }

  ros::Wire wire() const override { return ros::Wire::kRos1; }

  std::uint16_t add_topic(const TopicSpec& topic) override {
    const auto id = static_cast<std::uint32_t>(connections_.size());
    HeaderFields header(Op::kConnection), of_sender;
    header.add("conn", id).add("topic", topic.name);
    of_sender.add("topic", topic.name)
        .add("type", topic.type)
        .add("md5sum", topic.md5)
        .add("message_definition", topic.definition)
        .add("callerid", "/modelhouse")
        .add("latching", topic.latched ? "1" : "0");
    ByteWriter record;
    append_record(record, header, of_sender.bytes());
    connections_.push_back(record.bytes());
    is_sent_.push_back(false);
    return static_cast<std::uint16_t>(id);
  }

  void write(std::uint16_t topic, Stamp stamp_ns, std::string_view message) override {
    const Stamp received_ns = std::max<Stamp>(stamp_ns, 1);
    if (!is_sent_[topic]) chunk_.raw(connections_[topic]);
    is_sent_[topic] = true;
    index_[topic].emplace_back(received_ns, static_cast<std::uint32_t>(chunk_.size()));
    HeaderFields header(Op::kMessage);
    header.add("conn", std::uint32_t{topic}).add("time", time_of(received_ns));
    append_record(chunk_, header, message);
    if (chunk_.size() >= kChunkBytes) end_chunk();
  }

  void finish() override {
    if (chunk_.size() > 0) end_chunk();
    const std::uint64_t index_at = file_.size();
    for (const std::string& connection : connections_) file_.append(connection);
    file_.append(chunk_infos_.bytes());
    file_.replace(bag::kMagic.size(), bag_header(index_at));
    file_.finish();
  }

 private:
  std::string bag_header(std::uint64_t index_at) const {
    HeaderFields header(Op::kBagHeader);
    header.add("index_pos", index_at)
        .add("conn_count", static_cast<std::uint32_t>(connections_.size()))
        .add("chunk_count", chunks_);
    ByteWriter record;
    append_record(
        record, header,
        std::string(kBagHeaderBytes - 2 * sizeof(std::uint32_t) - header.bytes().size(), ' '));
    return record.bytes();
  }

  void end_chunk() {
    const std::string stored = lz4_ ? compress(chunk_.bytes(), "lz4") : std::string();
    const std::string_view content = lz4_ ? stored : chunk_.bytes();
    const std::uint64_t at = file_.size();
    HeaderFields header(Op::kChunk);
    header.add("compression", lz4_ ? "lz4" : "none")
        .add("size", static_cast<std::uint32_t>(chunk_.size()));
    ByteWriter record;
    record.text(header.bytes());
    record.number(static_cast<std::uint32_t>(content.size()));
    file_.append(record.bytes());
    file_.append(content);

    ByteWriter indexes, counts;
    Stamp first_ns = INT64_MAX, last_ns = 0;
    for (const auto& [topic, places] : index_) {
      ByteWriter list;
      for (const auto& [stamp_ns, place] : places) {
        list.number(time_of(stamp_ns));
        list.number(place);
        first_ns = std::min(first_ns, stamp_ns);
        last_ns = std::max(last_ns, stamp_ns);
      }
      const auto count = static_cast<std::uint32_t>(places.size());
      HeaderFields index(Op::kIndex);
      index.add("ver", std::uint32_t{1}).add("conn", std::uint32_t{topic}).add("count", count);
      append_record(indexes, index, list.bytes());
      counts.number(std::uint32_t{topic});
      counts.number(count);
    }
    file_.append(indexes.bytes());
    HeaderFields info(Op::kChunkInfo);
    info.add("ver", std::uint32_t{1})
        .add("chunk_pos", at)
        .add("start_time", time_of(first_ns))
        .add("end_time", time_of(last_ns))
        .add("count", static_cast<std::uint32_t>(index_.size()));
    append_record(chunk_infos_, info, counts.bytes());
    ++chunks_;
    chunk_.clear();
    index_.clear();
  }

  OutputFile file_;
  bool lz4_;
  std::vector<std::string> connections_;  ///< records, by id
  std::vector<bool> is_sent_;             ///< by id: written in a chunk
  ByteWriter chunk_, chunk_infos_;
  std::uint32_t chunks_ = 0;
  /// Stamp and position of each message in the open chunk, by topic.
  std::map<std::uint16_t, std::vector<std::pair<Stamp, std::uint32_t>>> index_;
};

}  // namespace

std::unique_ptr<MessageWriter> write_bag(const std::filesystem::path& file,
                                         ChunkCompression compression) {
  if (compression == ChunkCompression::kZstd)
    throw InputError("a ROS 1 bag has no zstd chunks; lz4 or none");
  return std::make_unique<BagWriter>(file, compression);
}

}  // namespace mh
