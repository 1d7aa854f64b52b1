// SPDX-License-Identifier: Apache-2.0
// The vocabulary file, little-endian, used in place without copying:
//   8 bytes   magic "MHVOCAB\n"
//   u32 x 6   version, branching, depth, number of nodes N, number of words W, training images
//   u64       training descriptors
//   24 bytes  zero: centers start at a multiple of 64
//   32 x N    centers of the nodes, breadth first (the root's is zero)
//   f32 x W   inverse document frequencies; word w is the w-th node without children
//   u8  x N   number of children of each node; children follow in the order of their parents
//   u64       xxh3-64 of all preceding bytes
#include <bit>
#include <cmath>
#include <cstring>

#define XXH_INLINE_ALL
#include <fmt/format.h>
#include <xxhash.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"
#include "slam/vocabulary/tree.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is read as it lies");

constexpr std::string_view kMagic = "MHVOCAB\n";

struct Header {
  std::uint32_t version, branching, depth, nodes, words, images;
  std::uint64_t descriptors;
  std::uint64_t unused[3] = {0, 0, 0};
};
constexpr std::size_t kHeaderSize = kMagic.size() + sizeof(Header);
static_assert(kHeaderSize == 64);

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T>
T value_at(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

std::size_t checksum_offset(const Header& h) {
  return kHeaderSize + std::size_t{h.nodes} * (sizeof(Descriptor) + 1) +
         std::size_t{h.words} * sizeof(float);
}

// @throws InputError unless the bytes are a complete vocabulary file of this version.
Header checked_header(std::string_view bytes, const std::string& name) {
  const std::string_view start = bytes.substr(0, kMagic.size());
  if (start.empty() || start != kMagic.substr(0, start.size()))
    throw InputError(
        fmt::format("{}: is not a Modelhouse vocabulary, nor one in DBoW2's text format", name));
  constexpr std::size_t kVersionEnd = kMagic.size() + sizeof(std::uint32_t);
  const auto cut_short = [&](std::size_t needed) {
    return InputError(
        fmt::format("{}: is truncated: has {} bytes, needs {}", name, bytes.size(), needed));
  };
  if (bytes.size() < kVersionEnd) throw cut_short(kHeaderSize);
  const auto version = value_at<std::uint32_t>(bytes, kMagic.size());
  if (version != Vocabulary::kFileVersion)
    throw InputError(fmt::format("{}: is a vocabulary of version {}, but this program reads {}",
                                 name, version, Vocabulary::kFileVersion));
  if (bytes.size() < kHeaderSize) throw cut_short(kHeaderSize);
  const auto header = value_at<Header>(bytes, kMagic.size());
  const std::size_t content = checksum_offset(header), needed = content + sizeof(std::uint64_t);
  if (bytes.size() < needed) throw cut_short(needed);
  if (bytes.size() > needed)
    throw InputError(
        fmt::format("{}: is too long: has {} bytes, needs {}", name, bytes.size(), needed));
  const auto stored = value_at<std::uint64_t>(bytes, content);
  const std::uint64_t actual = XXH3_64bits(bytes.data(), content);
  if (stored != actual)
    throw InputError(
        fmt::format("{}: is damaged: checksum {:016x} instead of {:016x}", name, actual, stored));
  return header;
}

}  // namespace

std::string encode(const VocabularyTree& tree) {
  const Header header{.version = Vocabulary::kFileVersion,
                      .branching = tree.branching,
                      .depth = tree.depth,
                      .nodes = static_cast<std::uint32_t>(tree.centers.size()),
                      .words = static_cast<std::uint32_t>(tree.idf.size()),
                      .images = tree.images,
                      .descriptors = tree.descriptors};
  std::string bytes(kMagic);
  bytes.reserve(checksum_offset(header) + sizeof(std::uint64_t));
  bytes.append(reinterpret_cast<const char*>(&header), sizeof header);
  append(bytes, tree.centers);
  append(bytes, tree.idf);
  append(bytes, tree.child_counts);
  append(bytes, std::vector{std::uint64_t{XXH3_64bits(bytes.data(), bytes.size())}});
  return bytes;
}

Vocabulary::Vocabulary(HeldBytes bytes, const std::string& name) : bytes_(std::move(bytes)) {
  const Header header = checked_header(bytes_.view, name);
  const auto inconsistent = [&](const char* what) {
    return InputError(fmt::format("{}: is not a consistent tree: {}", name, what));
  };
  const char* const content = bytes_.view.data();
  const std::size_t idf = kHeaderSize + std::size_t{header.nodes} * sizeof(Descriptor);
  centers_ = {reinterpret_cast<const Descriptor*>(content + kHeaderSize), header.nodes};
  idf_ = {reinterpret_cast<const float*>(content + idf), header.words};
  child_counts_ = reinterpret_cast<const std::uint8_t*>(content + idf + idf_.size_bytes());
  branching_ = static_cast<int>(header.branching);
  depth_ = static_cast<int>(header.depth);
  training_images_ = header.images;
  training_descriptors_ = header.descriptors;
  digest_ = value_at<std::uint64_t>(bytes_.view, checksum_offset(header));

  std::vector<std::uint32_t> links(header.nodes);
  std::uint64_t next_child = 1;
  WordId next_word = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (child_counts_[i] == 0) {
      links[i] = next_word++;
      continue;
    }
    // Children come after their parent: no cycles, even in a malformed file.
    if (next_child <= i || next_child + child_counts_[i] > links.size())
      throw inconsistent("children beyond the last node");
    links[i] = static_cast<std::uint32_t>(next_child);
    next_child += child_counts_[i];
  }
  if (next_child != links.size() || links.size() < 2) throw inconsistent("number of nodes");
  if (next_word != header.words) throw inconsistent("number of words");
  for (const float weight : idf_)
    if (!std::isfinite(weight) || weight < 0) throw inconsistent("weight of a word");
  links_ = std::make_shared<const std::vector<std::uint32_t>>(std::move(links));
}

Vocabulary::Vocabulary(const VocabularyTree& tree) : Vocabulary(hold(encode(tree)), "vocabulary") {}

Vocabulary Vocabulary::load(const std::filesystem::path& file) {
  HeldBytes bytes = map_file(file);
  const std::string_view text = without_mark(bytes.view, file);
  const bool is_text = !text.empty() && text[0] >= '0' && text[0] <= '9';
  if (!is_text) return {std::move(bytes), file.string()};
  return Vocabulary(read_dbow2_text(text, file.string()));
}

void Vocabulary::save(const std::filesystem::path& file) const {
  write_atomically(file, bytes_.view);
}

void Vocabulary::save_dbow2(const std::filesystem::path& file) const {
  const VocabularyTree tree{.branching = static_cast<std::uint32_t>(branching_),
                            .depth = static_cast<std::uint32_t>(depth_),
                            .centers = {centers_.begin(), centers_.end()},
                            .child_counts = {child_counts_, child_counts_ + centers_.size()},
                            .idf = {idf_.begin(), idf_.end()}};
  std::string text;
  try {
    text = dbow2_text(tree);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  write_atomically(file, text);
}

}  // namespace mh
