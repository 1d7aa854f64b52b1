// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scenes/recordings/messages/bag_format.hpp"
#include "scenes/recordings/messages/byte_reader.hpp"
#include "scenes/recordings/messages/message_file.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using bag::Op;

/// The fields of a record's header. Each is stored as its length, then "name=value".
using Fields = std::map<std::string_view, std::string_view>;

Fields fields_of(std::string_view header) {
  Fields fields;
  for (ByteReader from(header); !from.done();) {
    const std::string_view field = from.text();
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) throw InputError("a field of its header has no name");
    fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

std::string_view value(const Fields& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end()) throw InputError(fmt::format("field '{}' is missing", name));
  return found->second;
}

template <class T>
T number(const Fields& fields, std::string_view name) {
  const std::string_view bytes = value(fields, name);
  if (bytes.size() != sizeof(T))
    throw InputError(fmt::format("field '{}' has {} bytes", name, bytes.size()));
  return ByteReader(bytes).number<T>();
}

/// The time of receipt, which is stored as seconds, then nanoseconds.
std::int64_t received_ns(const Fields& fields) {
  if (!fields.contains("time")) return 0;
  const auto time = number<std::uint64_t>(fields, "time");
  return ros::kSecond_ns * static_cast<std::int64_t>(time & UINT32_MAX) +
         static_cast<std::int64_t>(time >> 32);
}

Op op_of(const Fields& fields) {
  return static_cast<Op>(number<std::uint8_t>(fields, "op"));
}

class BagFile : public MessageFile {
 public:
  BagFile(HeldBytes bytes, const std::string& name, const Visit& visit)
      : MessageFile(std::move(bytes), name), visit_(visit) {
    const std::string_view all = this->bytes();
    if (!all.starts_with(bag::kMagic)) refuse(all);
    read_records({all, bag::kMagic.size(), MessagePlace::kFile, 0});
    if (index_at_ == 0 && !leaves_out(kCut))
      leave_out("ends", all.size(), "it was not closed: its messages are used up to its end");
  }

 private:
  [[noreturn]] void refuse(std::string_view all) const {
    if (all.starts_with("#ROSBAG V2.0\r"))
      throw InputError(fmt::format(
          "{}: its first line ends in CR LF: it was transferred as text, which destroys a bag",
          name()));
    if (all.starts_with("#ROSBAG V"))
      throw InputError(fmt::format("{}: is a bag of version {}, not 2.0: `rosbag fix` converts it",
                                   name(), all.substr(9, all.find('\n', 9) - 9).substr(0, 8)));
    throw InputError(fmt::format("{}: is not a ROS 1 bag{}", name(),
                                 all.starts_with("SQLite format 3")
                                     ? ", but a ROS 2 bag in SQLite: `ros2 bag convert` to MCAP"
                                     : ""));
  }

  struct Records {
    std::string_view bytes;
    std::size_t begin = 0;
    std::uint32_t chunk = MessagePlace::kFile;
    std::uint64_t chunk_at = 0;  ///< position in the file
  };

  struct Record {
    std::string_view header, data;
    std::size_t end = 0;  ///< position in the bytes that hold it
  };

  /// nullopt if there is no whole record at this position.
  static std::optional<Record> record_at(std::string_view bytes, std::size_t at) {
    ByteReader from(bytes.substr(at));
    try {
      const std::string_view header = from.text(), data = from.text();
      return Record{header, data, bytes.size() - from.left()};
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  void read_records(const Records& records) {
    const bool in_chunk = records.chunk != MessagePlace::kFile;
    for (std::size_t at = records.begin; at < records.bytes.size();) {
      const std::uint64_t place = in_chunk ? records.chunk_at : at;
      const std::optional<Record> record = record_at(records.bytes, at);
      if (!record) {
        if (in_chunk) throw InputError("ends within a record");
        if (index_at_ != 0 && at >= index_at_)
          leave_out("ends", place,
                    fmt::format("{} bytes after its end are left out", records.bytes.size() - at));
        else
          leave_out(kCut, place, "a record is cut short; what came before is used");
        return;
      }
      const std::string_view data = record->data;
      at = record->end;
      try {
        const Fields fields = fields_of(record->header);
        const Op op = op_of(fields);
        if (op == Op::kMessage)
          read_message(fields, data,
                       {.chunk = records.chunk,
                        .at = at - data.size(),
                        .size = data.size(),
                        .received_ns = received_ns(fields)},
                       place);
        else if (op == Op::kConnection)
          read_connection(fields, data);
        else if (op == Op::kChunk && !in_chunk)
          read_chunk(fields, data, place);
        else if (op == Op::kBagHeader && !in_chunk)
          read_bag_header(fields);
        else if (op != Op::kIndex && op != Op::kChunkInfo)
          throw InputError(
              fmt::format("'op' is {}, an unknown kind of record", static_cast<int>(op)));
      } catch (const Encrypted&) {
        throw InputError(fmt::format("{}: is an encrypted bag, which is not read", name()));
      } catch (const InputError& error) {
        leave_out("damaged records left out", place, error.what());
      }
    }
  }

  /// From this position on, reads the connections that are stored outside of chunks, in case the
  /// only chunk that holds them is damaged: bags repeat connections after the last chunk.
  void read_connections_from(std::uint64_t at) {
    if (std::exchange(connections_are_read_, true)) return;
    while (const std::optional<Record> record = record_at(bytes(), at)) {
      at = record->end;
      try {
        const Fields fields = fields_of(record->header);
        if (op_of(fields) == Op::kConnection) read_connection(fields, record->data);
      } catch (const InputError&) {  // reported when reading gets there
      }
    }
  }

  struct Encrypted {};

  void read_bag_header(const Fields& fields) {
    if (const auto encryptor = fields.find("encryptor");
        encryptor != fields.end() && !encryptor->second.empty())
      throw Encrypted();
    index_at_ = number<std::uint64_t>(fields, "index_pos");
  }

  void read_connection(const Fields& fields, std::string_view data) {
    const auto id = number<std::uint32_t>(fields, "conn");
    const Fields of_sender = fields_of(data);
    channels_by_id_[id] = channel({.topic = std::string(value(fields, "topic")),
                                   .type = std::string(value(of_sender, "type")),
                                   .wire = ros::Wire::kRos1});
  }

  void read_message(const Fields& fields, std::string_view data, const MessagePlace& place,
                    std::uint64_t file_at) {
    const auto id = number<std::uint32_t>(fields, "conn");
    if (!channels_by_id_.contains(id)) read_connections_from(file_at);
    const auto channel = channels_by_id_.find(id);
    if (channel == channels_by_id_.end())
      return leave_out("messages left out", file_at, "a message belongs to no connection");
    count_message();
    visit_(channels()[channel->second], data, place);
  }

  void read_chunk(const Fields& fields, std::string_view data, std::uint64_t at) {
    Chunk chunk{.at = at,
                .stored = data,
                .size = number<std::uint32_t>(fields, "size"),
                .compression = std::string(value(fields, "compression")),
                .crc = {}};
    const std::uint32_t number = add_chunk(std::move(chunk));
    const HeldBytes records = open_chunk(number);
    read_records({records.view, 0, number, at});
  }

  const Visit& visit_;
  std::map<std::uint32_t, std::size_t> channels_by_id_;
  bool connections_are_read_ = false;  ///< by read_connections_from()
  std::uint64_t index_at_ = 0;         ///< 0 if the bag was not closed
};

}  // namespace

std::unique_ptr<MessageFile> open_bag(HeldBytes bytes, const std::string& name,
                                      const MessageFile::Visit& visit) {
  return std::make_unique<BagFile>(std::move(bytes), name, visit);
}

}  // namespace mh
