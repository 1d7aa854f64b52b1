// SPDX-License-Identifier: Apache-2.0
#include <libdeflate.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/recordings/messages/byte_reader.hpp"
#include "scenes/recordings/messages/decompress.hpp"
#include "scenes/recordings/messages/mcap_format.hpp"
#include "scenes/recordings/messages/message_file.hpp"
#include "scenes/recordings/messages/message_writer.hpp"
#include "scenes/recordings/messages/robot_types.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

struct Read {
  std::unique_ptr<MessageFile> file;
  std::vector<std::pair<std::string, std::string>> messages;  ///< topic, bytes
  std::vector<MessagePlace> places;
};

Read read_all(const std::string& bytes) {
  Read read;
  const auto open = bytes.starts_with("#ROSBAG") ? open_bag : open_mcap;
  read.file = open(hold(bytes), "file",
                   [&](const MessageChannel& channel, std::string_view m, const MessagePlace& p) {
                     read.messages.emplace_back(channel.topic, m);
                     read.places.push_back(p);
                   });
  return read;
}

/// A text that compression does not shorten.
std::string noise(int seed) {
  const RandomStream random(static_cast<std::uint64_t>(seed));
  std::string text(900'000, '\0');
  for (std::size_t i = 0; i < text.size(); ++i) text[i] = static_cast<char>(random.bits(i));
  return text;
}

enum class Kind { kMcap, kBag };

/// Files with 40 messages on two topics, in chunks of about ten.
class MessageFiles : public testing::TestWithParam<std::tuple<Kind, ChunkCompression>> {
 protected:
  std::unique_ptr<MessageWriter> writer() const {
    const auto [kind, compression] = GetParam();
    return kind == Kind::kMcap ? write_mcap(file(), compression) : write_bag(file(), compression);
  }
  fs::path folder() const { return work_.path() / "out"; }
  fs::path file() const { return folder() / "file"; }

  std::vector<std::pair<std::string, std::string>> write() const {
    const auto out = writer();
    const std::uint16_t text = out->add_topic(topic_spec<ros::String>("/text", out->wire(), true));
    const std::uint16_t flag = out->add_topic(topic_spec<ros::Bool>("/flag", out->wire()));
    std::vector<std::pair<std::string, std::string>> written;
    for (int i = 0; i < 20; ++i) {
      written.emplace_back("/text", ros::serialized(ros::String{noise(i)}, out->wire()));
      written.emplace_back("/flag", ros::serialized(ros::Bool{i % 2 == 0}, out->wire()));
      out->write(text, 1000 * i, written[written.size() - 2].second);
      out->write(flag, 1000 * i, written.back().second);
    }
    EXPECT_FALSE(fs::exists(file())) << "an unfinished file looks finished";
    out->finish();
    return written;
  }

  TemporaryFolder work_{fs::temp_directory_path()};
};

TEST_P(MessageFiles, ReadBackAsWritten) {
  const auto written = write();
  const Read read = read_all(read_file(file()));
  EXPECT_EQ(read.messages, written);
  EXPECT_TRUE(read.file->notes().empty()) << read.file->notes().front();
  EXPECT_EQ(read.file->message_count(), written.size());
  ASSERT_EQ(read.file->channels().size(), 2u);
  EXPECT_EQ(read.file->channels()[0].type, "std_msgs/String");
  for (std::size_t i : {0U, 39U, 1U, 20U}) {
    const HeldBytes again = read.file->read(read.places[i]);
    EXPECT_EQ(again.view, written[i].second) << "in any order";
  }
}

TEST_P(MessageFiles, WithoutFinishNothingIsLeft) {
  {
    const auto out = writer();
    out->write(out->add_topic(topic_spec<ros::Bool>("/flag", out->wire())), 1, "\1");
  }
  EXPECT_TRUE(fs::is_empty(folder()));
}

TEST_P(MessageFiles, CutAnywhereWhatCameBeforeIsRead) {
  const auto written = write();
  const std::string whole = read_file(file());
  std::size_t most = 0;
  for (std::size_t k = 1; k < 40; ++k) {
    const Read read = read_all(whole.substr(0, 100 + (whole.size() - 101) * k / 40));
    ASSERT_LE(read.messages.size(), written.size());
    EXPECT_TRUE(std::equal(read.messages.begin(), read.messages.end(), written.begin()));
    EXPECT_FALSE(read.file->notes().empty());
    EXPECT_GE(read.messages.size(), most);
    most = read.messages.size();
  }
  EXPECT_GT(most, 25u);
}

TEST_P(MessageFiles, AWrongByteCostsNoMoreThanItsChunk) {
  const auto written = write();
  std::string bytes = read_file(file());
  bytes[bytes.size() / 2] ^= 0x55;
  const auto [kind, compression] = GetParam();
  const Read read = read_all(bytes);
  if (kind == Kind::kMcap || compression != ChunkCompression::kNone) {  // with checksums
    EXPECT_LT(read.messages.size(), written.size());
    ASSERT_EQ(read.file->notes().size(), 1u);
    EXPECT_NE(read.file->notes()[0].find("is damaged"), std::string::npos) << read.file->notes()[0];
  }
  EXPECT_GE(read.messages.size(), 20u);
}

TEST_P(MessageFiles, TheFirstChunksDamageDoesNotTakeTheOthersTopics) {
  const auto written = write();
  std::string bytes = read_file(file());
  const std::size_t name = bytes.find("/text");  // not found if it is compressed
  if (name == std::string::npos) {
    bytes[bytes.size() / 10] ^= 0x55;
  } else {
    for (std::size_t i = 0; i < 5; ++i)
      bytes[name - 1 - i] ^= 0x55;  // the bytes that store where the name begins
  }
  const Read read = read_all(bytes);
  ASSERT_GE(read.messages.size(), 20u);
  ASSERT_FALSE(read.file->notes().empty());
  EXPECT_EQ(read.messages.back(), written.back());
  EXPECT_EQ(read.messages.end()[-2], written.end()[-2]);
  for (const std::string& note : read.file->notes())
    EXPECT_EQ(note.find("messages left out"), std::string::npos) << note;
}

INSTANTIATE_TEST_SUITE_P(All, MessageFiles,
                         testing::Values(std::tuple(Kind::kMcap, ChunkCompression::kNone),
                                         std::tuple(Kind::kMcap, ChunkCompression::kLz4),
                                         std::tuple(Kind::kMcap, ChunkCompression::kZstd),
                                         std::tuple(Kind::kBag, ChunkCompression::kNone),
                                         std::tuple(Kind::kBag, ChunkCompression::kLz4)));

/// Builds an MCAP record by record.
class Mcap {
 public:
  Mcap() { bytes_.raw(mcap::kMagic); }
  Mcap& record(mcap::Opcode opcode, const std::string& content) {
    bytes_.number(static_cast<std::uint8_t>(opcode));
    bytes_.number(static_cast<std::uint64_t>(content.size()));
    bytes_.raw(content);
    return *this;
  }
  Mcap& channel(std::uint16_t id, const char* topic, const char* type, const char* encoding) {
    ByteWriter schema, entry;
    schema.number(static_cast<std::uint16_t>(id + 1));
    schema.text(type);
    schema.text("ros2msg");
    schema.text("");
    record(mcap::Opcode::kSchema, schema.bytes());
    entry.number(id);
    entry.number(static_cast<std::uint16_t>(id + 1));
    entry.text(topic);
    entry.text(encoding);
    entry.text("");
    return record(mcap::Opcode::kChannel, entry.bytes());
  }
  Mcap& message(std::uint16_t channel, const std::string& data) {
    ByteWriter m;
    m.number(channel);
    m.number(std::uint32_t{0});
    m.number(std::uint64_t{1});
    m.number(std::uint64_t{1});
    m.raw(data);
    return record(mcap::Opcode::kMessage, m.bytes());
  }
  Mcap& chunk(const std::string& records, const char* compression, std::uint64_t claimed,
              std::uint32_t crc) {
    ByteWriter c;
    c.number(std::uint64_t{1});
    c.number(std::uint64_t{1});
    c.number(claimed);
    c.number(crc);
    c.text(compression);
    c.number(static_cast<std::uint64_t>(records.size()));
    c.raw(records);
    return record(mcap::Opcode::kChunk, c.bytes());
  }
  /// Adds the end of the data, the footer and the magic bytes.
  Mcap& end(std::uint32_t crc_of_data = 0) {
    ByteWriter data_end;
    data_end.number(crc_of_data);
    record(mcap::Opcode::kDataEnd, data_end.bytes());
    record(mcap::Opcode::kFooter, std::string(20, '\0'));
    bytes_.raw(mcap::kMagic);
    return *this;
  }
  std::string records() const { return bytes_.bytes().substr(mcap::kMagic.size()); }
  std::string bytes() const { return bytes_.bytes(); }

 private:
  ByteWriter bytes_;
};

std::string note_of(const Read& read) {
  return read.file->notes().empty() ? "" : read.file->notes().front();
}

TEST(McapByHand, WithoutChunksAndSummaryIsRead) {
  Mcap file;
  file.channel(0, "/a", "std_msgs/msg/Bool", "cdr").message(0, "m");
  const Read read = read_all(file.end().bytes());
  ASSERT_EQ(read.messages.size(), 1u);
  EXPECT_EQ(read.messages[0], std::pair(std::string("/a"), std::string("m")));
  EXPECT_EQ(read.file->channels()[0].type, "std_msgs/Bool");
  EXPECT_EQ(note_of(read), "");
}

TEST(McapByHand, UnknownRecordsAndEncodingsArePassedOver) {
  Mcap file;
  file.record(static_cast<mcap::Opcode>(0x99), "of tomorrow");
  file.channel(3, "/json", "Anything", "json").message(3, "{}");
  const Read read = read_all(file.end().bytes());
  ASSERT_EQ(read.file->channels().size(), 1u);
  EXPECT_FALSE(read.file->channels()[0].wire.has_value());
  EXPECT_EQ(note_of(read), "");
}

TEST(McapByHand, AnEndThatIsAnotherIsTold) {
  Mcap file;
  file.channel(0, "/a", "std_msgs/msg/Bool", "cdr").message(0, "m");
  const auto expect_told = [](const std::string& bytes, const char* part) {
    const Read read = read_all(bytes);
    EXPECT_EQ(read.messages.size(), 1u);
    EXPECT_NE(note_of(read).find(part), std::string::npos) << note_of(read);
  };
  const std::string whole = Mcap(file).end().bytes();
  EXPECT_EQ(note_of(read_all(whole)), "");
  expect_told(Mcap(file).record(mcap::Opcode::kDataEnd, std::string(4, '\0')).bytes(),
              "it has no footer");
  expect_told(whole.substr(0, whole.size() - 20), "it has no footer");
  expect_told(whole.substr(0, whole.size() - 1), "is not followed by MCAP's closing bytes");
  expect_told(whole + whole,
              fmt::format("{} bytes after its end are left out", whole.size()).c_str());
  expect_told(Mcap(file).end(1).bytes(), "its data's CRC does not match");
  const std::string data = file.bytes();
  EXPECT_EQ(
      note_of(read_all(Mcap(file).end(libdeflate_crc32(0, data.data(), data.size())).bytes())), "");
}

TEST(McapByHand, LiesAreCounted) {
  Mcap inside;
  inside.channel(0, "/a", "std_msgs/msg/Bool", "cdr").message(0, "m");
  const std::string records = inside.records(), zstd = compress(records, "zstd");
  const auto expect_left_out = [&](const Mcap& file, const char* part) {
    const Read read = read_all(Mcap(file).end().bytes());
    EXPECT_TRUE(read.messages.empty());
    EXPECT_NE(note_of(read).find(part), std::string::npos) << note_of(read);
  };
  expect_left_out(Mcap().chunk(records, "", records.size(), 1), "its CRC does not match");
  expect_left_out(Mcap().chunk(records, "", 5, 0), "claims 5 bytes");
  expect_left_out(Mcap().chunk(zstd, "zstd", 1, 0), "it holds more bytes, not 1");
  expect_left_out(Mcap().chunk(zstd, "zstd", records.size() + 1, 0), "bytes, not");
  expect_left_out(Mcap().chunk(zstd, "zstd", std::uint64_t{1} << 50, 0), "claims 1125899906842624");
  expect_left_out(Mcap().chunk(zstd, "lz4", records.size(), 0), "its lz4 data");
  expect_left_out(Mcap().chunk(zstd, "snappy", records.size(), 0),
                  "with 'snappy', which is not supported");
  expect_left_out(Mcap().message(7, "m"), "a message belongs to no channel");
  expect_left_out(Mcap().record(mcap::Opcode::kChannel, "x"), "ends too early");
}

TEST(Bag, OfWhichSomethingFollowsOrARecordIsOfNoKindSaysSo) {
  const std::string whole = read_file(std::string(MH_SOURCE_DIR) + "/tests/fuzz/seeds/bag/bz2.bag");
  const Read longer = read_all(whole + whole);
  EXPECT_EQ(longer.messages.size(), 6u);
  EXPECT_NE(note_of(longer).find(fmt::format("{} bytes after its end are left out", whole.size())),
            std::string::npos)
      << note_of(longer);
  std::string unknown = whole;
  unknown[unknown.find("op=\x07", unknown.find("op=\x05")) + 3] = '\x1f';
  EXPECT_NE(note_of(read_all(unknown)).find("'op' is 31, an unknown kind of record"),
            std::string::npos)
      << note_of(read_all(unknown));
}

// Other programs look for the keys in either of the two places.
TEST(Bag, NamesATopicInItsConnectionsHeaderAndData) {
  const TemporaryFolder work(fs::temp_directory_path());
  const auto out = write_bag(work.path() / "out/file", ChunkCompression::kNone);
  out->write(out->add_topic(topic_spec<ros::Bool>("/flag", out->wire())), 1, "x");
  out->finish();
  const std::string bag = read_file(work.path() / "out/file");
  const std::string field{"\x0b\0\0\0topic=/flag", 15};
  int found = 0;
  for (auto at = bag.find(field); at != std::string::npos; at = bag.find(field, at + 1)) ++found;
  EXPECT_EQ(found, 4) << "in the chunk and in the index, each with header and data";
  // The bag header record takes 4096 bytes, so that it can be written last.
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;
    std::memcpy(&number, bag.data() + at, sizeof number);
    return number;
  };
  constexpr std::size_t kMagic = 13;  // "#ROSBAG V2.0" and its newline
  const std::uint32_t header_bytes = number_at(kMagic);
  EXPECT_EQ(4 + header_bytes + 4 + number_at(kMagic + 4 + header_bytes), 4096u);
}

TEST(Bag, ThatIsEncryptedIsRefused) {
  const TemporaryFolder work(fs::temp_directory_path());
  const auto out = write_bag(work.path() / "out/file", ChunkCompression::kNone);
  out->write(out->add_topic(topic_spec<ros::Bool>("/flag", out->wire())), 1, "x");
  out->finish();
  std::string bag = read_file(work.path() / "out/file");
  const std::string header{"\x21\0\0\0\x04\0\0\0op=\x03\x15\0\0\0encryptor=rosbag/None", 37};
  bag.replace(13, 4096, header + std::string(4, '\0'));
  try {
    read_all(bag);
    ADD_FAILURE() << "was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("encrypted"), std::string::npos) << error.what();
  }
}

TEST(Bag, OfBz2ByRosIsRead) {
  const Read read =
      read_all(read_file(std::string(MH_SOURCE_DIR) + "/tests/fuzz/seeds/bag/bz2.bag"));
  ASSERT_EQ(read.messages.size(), 6u);
  EXPECT_EQ(read.messages[0].first, "/depth");
  EXPECT_EQ(note_of(read), "");
}

TEST(Bag, OfAnotherKindIsRefusedByName) {
  const auto expect_refused = [](const std::string& bytes, const char* part) {
    try {
      open_bag(hold(bytes), "x.bag", [](const auto&, auto, const auto&) {});
      FAIL() << part;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  expect_refused("#ROSBAG V1.2\n", "x.bag: is a bag of version 1.2, not 2.0");
  expect_refused("#ROSBAG V2.0\r\n", "its first line ends in CR LF");
  expect_refused("SQLite format 3", "a ROS 2 bag in SQLite");
  expect_refused("", "x.bag: is not a ROS 1 bag");
  EXPECT_THROW(open_mcap(hold("MCAP"), "x.mcap", [](const auto&, auto, const auto&) {}),
               InputError);
}

}  // namespace
}  // namespace mh
