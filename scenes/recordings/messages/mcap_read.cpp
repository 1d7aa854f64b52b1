// SPDX-License-Identifier: Apache-2.0
#include <libdeflate.h>

#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scenes/recordings/messages/byte_reader.hpp"
#include "scenes/recordings/messages/mcap_format.hpp"
#include "scenes/recordings/messages/message_file.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using mcap::Opcode;

constexpr std::size_t kRecordHead = 9;  // opcode, length

/// "sensor_msgs/Image" for either spelling.
std::string common_type(std::string_view type) {
  std::string common(type);
  if (const auto at = common.find("/msg/"); at != std::string::npos) common.erase(at, 4);
  return common;
}

class McapFile : public MessageFile {
 public:
  McapFile(HeldBytes bytes, const std::string& name, const Visit& visit)
      : MessageFile(std::move(bytes), name), visit_(visit) {
    const std::string_view all = this->bytes();
    if (!all.starts_with(mcap::kMagic))
      throw InputError(fmt::format("{}: is not an MCAP file", name));
    const std::size_t data_end = read_records({all, mcap::kMagic.size(), MessagePlace::kFile, 0});
    if (ended_)
      check_end(data_end);
    else if (!leaves_out(kCut))
      leave_out("ends", all.size(), "it was cut short: what came before is used");
  }

 private:
  /// A sequence of records: those of the file, or of a chunk.
  struct Records {
    std::string_view bytes;
    std::size_t begin = 0;
    std::uint32_t chunk = MessagePlace::kFile;
    std::uint64_t chunk_at = 0;  ///< position in the file
  };

  struct Record {
    Opcode opcode{};
    std::size_t content_at = 0;  ///< position in the bytes that hold it
    std::string_view content;
    std::size_t end() const { return content_at + content.size(); }
  };

  /// nullopt if there is no whole record at this position.
  static std::optional<Record> record_at(std::string_view bytes, std::size_t at) {
    ByteReader from(bytes.substr(at));
    if (from.left() < kRecordHead) return std::nullopt;
    const auto opcode = static_cast<Opcode>(from.number<std::uint8_t>());
    const auto size = from.number<std::uint64_t>();
    if (size > from.left()) return std::nullopt;
    return Record{opcode, at + kRecordHead, from.take(size)};
  }

  /// Reads until the data ends. @returns where the last record that was read ends
  std::size_t read_records(const Records& records) {
    const bool in_chunk = records.chunk != MessagePlace::kFile;
    std::size_t at = records.begin;
    while (at < records.bytes.size() && !ended_) {
      const std::uint64_t place = in_chunk ? records.chunk_at : at;
      const std::optional<Record> record = record_at(records.bytes, at);
      if (!record) {
        if (in_chunk) throw InputError("ends within a record");
        leave_out(kCut, place, "a record is cut short; what came before is used");
        break;
      }
      try {
        if (record->opcode == Opcode::kMessage)
          read_message(
              record->content,
              {.chunk = records.chunk, .at = record->content_at, .size = record->content.size()},
              place);
        else if (record->opcode == Opcode::kChunk && !in_chunk)
          read_chunk(record->content, place);
        else
          read_other(*record, in_chunk);
      } catch (const InputError& error) {
        leave_out("damaged records left out", place, error.what());
      }
      at = record->end();
    }
    return at;
  }

  /// From this position on, reads the channels that are stored outside of chunks, in case the only
  /// chunk that holds them is damaged: a summary repeats channels.
  void read_channels_from(std::uint64_t at) {
    if (std::exchange(channels_are_read_, true)) return;
    while (const std::optional<Record> record = record_at(bytes(), at)) {
      try {
        if (record->opcode == Opcode::kSchema) read_schema(record->content);
        if (record->opcode == Opcode::kChannel) read_channel(record->content);
      } catch (const InputError&) {  // reported when reading gets there
      }
      at = record->end();
    }
  }

  /// Checks that the file ends like one that was closed: with a summary, a footer, the magic bytes.
  void check_end(std::size_t at) {
    const std::string_view all = bytes();
    for (bool footer = footer_; !footer;) {
      const std::optional<Record> record = record_at(all, at);
      if (!record) return leave_out("ends", at, "it has no footer: it was not closed");
      footer = record->opcode == Opcode::kFooter;
      at = record->end();
    }
    if (all.substr(at, mcap::kMagic.size()) != mcap::kMagic)
      return leave_out("ends", at, "its footer is not followed by MCAP's closing bytes");
    at += mcap::kMagic.size();
    if (at < all.size())
      leave_out("ends", at, fmt::format("{} bytes after its end are left out", all.size() - at));
  }

  void read_message(std::string_view content, MessagePlace place, std::uint64_t file_at) {
    constexpr std::size_t kHead = 22;  // channel, sequence, two stamps
    ByteReader from(content);
    const auto id = from.number<std::uint16_t>();
    if (content.size() < kHead) throw InputError("a message ends too early");
    if (!channels_by_id_.contains(id)) read_channels_from(file_at);
    const auto channel = channels_by_id_.find(id);
    if (channel == channels_by_id_.end())
      return leave_out("messages left out", file_at, "a message belongs to no channel");
    from.number<std::uint32_t>();  // its number in the sequence
    place.received_ns = from.number<std::int64_t>();
    place.at += kHead;
    place.size -= kHead;
    count_message();
    visit_(channels()[channel->second], content.substr(kHead), place);
  }

  void read_chunk(std::string_view content, std::uint64_t at) {
    ByteReader from(content);
    from.take(16);  // stamps of the first and the last message
    Chunk chunk;
    chunk.at = at;
    chunk.size = from.number<std::uint64_t>();
    const auto crc = from.number<std::uint32_t>();
    if (crc != 0) chunk.crc = crc;
    chunk.compression = from.text();
    chunk.stored = from.take(from.number<std::uint64_t>());
    const std::uint32_t number = add_chunk(std::move(chunk));
    const HeldBytes records = open_chunk(number);
    read_records({records.view, 0, number, at});
  }

  void read_other(const Record& record, bool in_chunk) {
    const Opcode opcode = record.opcode;
    if (opcode == Opcode::kSchema) {
      read_schema(record.content);
    } else if (opcode == Opcode::kChannel) {
      read_channel(record.content);
    } else if (!in_chunk && opcode == Opcode::kDataEnd) {
      ended_ = true;
      const std::string_view data = bytes().substr(0, record.content_at - kRecordHead);
      const auto crc = ByteReader(record.content).number<std::uint32_t>();
      // Damage that was already reported would explain a wrong checksum.
      if (crc != 0 && notes().empty() && libdeflate_crc32(0, data.data(), data.size()) != crc)
        leave_out("checksums", data.size(), "its data's CRC does not match: some of it is damaged");
    } else if (!in_chunk && opcode == Opcode::kFooter) {
      ended_ = footer_ = true;
    }
  }

  void read_schema(std::string_view content) {
    ByteReader from(content);
    const auto id = from.number<std::uint16_t>();
    schemas_[id] = common_type(from.text());
  }

  void read_channel(std::string_view content) {
    ByteReader from(content);
    const auto id = from.number<std::uint16_t>();
    const auto schema = schemas_.find(from.number<std::uint16_t>());
    MessageChannel channel{.topic = std::string(from.text()), .type = {}, .wire = {}};
    if (schema != schemas_.end()) channel.type = schema->second;
    const std::string_view encoding = from.text();
    if (encoding == "cdr") channel.wire = ros::Wire::kCdr;
    if (encoding == "ros1") channel.wire = ros::Wire::kRos1;
    channels_by_id_[id] = this->channel(std::move(channel));
  }

  const Visit& visit_;
  std::map<std::uint16_t, std::string> schemas_;  ///< types by id
  std::map<std::uint16_t, std::size_t> channels_by_id_;
  bool channels_are_read_ = false;  ///< by read_channels_from()
  bool ended_ = false;              ///< the data section has ended
  bool footer_ = false;             ///< a footer was found without a DataEnd record before it
};

}  // namespace

std::unique_ptr<MessageFile> open_mcap(HeldBytes bytes, const std::string& name,
                                       const MessageFile::Visit& visit) {
  return std::make_unique<McapFile>(std::move(bytes), name, visit);
}

}  // namespace mh
