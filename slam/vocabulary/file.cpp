// SPDX-License-Identifier: Apache-2.0
// The vocabulary's file, little-endian:
//   8 bytes   magic "MHVOCAB\n"
//   u32 x 5   version, branching, depth, number of nodes N, number of words W
//   32 x N    centres of the nodes, breadth first (the root's is zero)
//   u8  x N   number of children of each node; children follow in the order of their parents
//   f32 x W   inverse document frequencies; word w is the w-th node without children
//   u64       xxh3-64 of all bytes before
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is read as it lies");

constexpr std::string_view kMagic = "MHVOCAB\n";

struct Header {
  std::uint32_t version, branching, depth, nodes, words;
};
constexpr std::size_t kHeaderSize = kMagic.size() + sizeof(Header);

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Takes values from the front of a byte sequence, which is known to be long enough.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }

 private:
  std::string_view bytes_;
};

std::size_t file_size(const Header& h) {
  return kHeaderSize + std::size_t{h.nodes} * (sizeof(Descriptor) + 1) +
         std::size_t{h.words} * sizeof(float) + sizeof(std::uint64_t);
}

// @throws InputError unless the bytes are a whole vocabulary file of this version.
Header checked_header(std::string_view bytes, const std::string& name) {
  const std::string_view start = bytes.substr(0, kMagic.size());
  if (start.empty() || start != kMagic.substr(0, start.size()))
    throw InputError(fmt::format("{}: is not a Modelhouse vocabulary", name));
  if (bytes.size() < kHeaderSize)
    throw InputError(fmt::format("{}: is cut short: has {} bytes, needs at least {}", name,
                                 bytes.size(), kHeaderSize));
  const auto header = Reader(bytes.substr(kMagic.size())).take<Header>();
  if (header.version != Vocabulary::kFileVersion)
    throw InputError(fmt::format("{}: is a vocabulary of version {}, but this program reads {}",
                                 name, header.version, Vocabulary::kFileVersion));
  const std::size_t needed = file_size(header);
  if (bytes.size() != needed)
    throw InputError(fmt::format("{}: is {}: has {} bytes, needs {}", name,
                                 bytes.size() < needed ? "cut short" : "too long", bytes.size(),
                                 needed));
  const std::string_view content = bytes.substr(0, needed - sizeof(std::uint64_t));
  const auto stored = Reader(bytes.substr(content.size())).take<std::uint64_t>();
  const std::uint64_t actual = XXH3_64bits(content.data(), content.size());
  if (stored != actual)
    throw InputError(
        fmt::format("{}: is damaged: checksum {:016x} instead of {:016x}", name, actual, stored));
  return header;
}

}  // namespace

std::string Vocabulary::encode() const {
  std::string bytes(kMagic);
  append(bytes,
         Header{kFileVersion, static_cast<std::uint32_t>(branching_),
                static_cast<std::uint32_t>(depth_), static_cast<std::uint32_t>(nodes_.size()),
                static_cast<std::uint32_t>(idf_.size())});
  for (const Node& node : nodes_) append(bytes, node.centre);
  for (const Node& node : nodes_) append(bytes, static_cast<std::uint8_t>(node.child_count));
  for (const float weight : idf_) append(bytes, weight);
  append(bytes, std::uint64_t{XXH3_64bits(bytes.data(), bytes.size())});
  return bytes;
}

Vocabulary Vocabulary::decode(const std::string& bytes, const std::string& name) {
  const Header header = checked_header(bytes, name);
  const auto inconsistent = [&](const char* what) {
    return InputError(fmt::format("{}: is no consistent tree: {}", name, what));
  };
  Vocabulary v;
  v.branching_ = static_cast<int>(header.branching);
  v.depth_ = static_cast<int>(header.depth);
  v.nodes_.resize(header.nodes);
  v.idf_.resize(header.words);

  Reader reader(std::string_view(bytes).substr(kHeaderSize));
  for (Node& node : v.nodes_) node.centre = reader.take<Descriptor>();
  std::uint64_t next_child = 1;
  WordId next_word = 0;
  for (std::size_t i = 0; i < v.nodes_.size(); ++i) {
    Node& node = v.nodes_[i];
    node.child_count = reader.take<std::uint8_t>();
    if (node.child_count == 0) {
      node.word = next_word++;
      continue;
    }
    // Children after their parent: no cycles, whatever the file says.
    if (next_child <= i || next_child + node.child_count > v.nodes_.size())
      throw inconsistent("children beyond the last node");
    node.first_child = static_cast<std::uint32_t>(next_child);
    next_child += node.child_count;
  }
  if (next_child != v.nodes_.size() || v.nodes_.size() < 2) throw inconsistent("number of nodes");
  if (next_word != header.words) throw inconsistent("number of words");
  for (float& weight : v.idf_) {
    weight = reader.take<float>();
    if (!std::isfinite(weight) || weight < 0) throw inconsistent("weight of a word");
  }
  return v;
}

Vocabulary Vocabulary::load(const std::filesystem::path& file) {
  return decode(read_file(file), file.string());
}

void Vocabulary::save(const std::filesystem::path& file) const {
  write_atomically(file, encode());
}

std::uint64_t Vocabulary::digest() const {
  const std::string bytes = encode();
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace mh
