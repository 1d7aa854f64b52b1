// SPDX-License-Identifier: Apache-2.0
// The counts that follow the tree in an .ot file, little-endian:
//   the line "modelhouse voxel counts 3", or "... 4" if the map's frame has no floor
//   u64  size of the content
//   content: f64 resolution (m)
//     u32       voxels of detected objects; for each, by place: 3 x i16 voxel, u16 object
//     u32       pairs of objects that are apart; for each, ascending: 2 x u16
//     (version 1 has neither of the two)
//   for each block of 8 x 8 x 8 voxels with any known voxel:
//     3 x i16   index of the block
//     8 x u64   known voxels, bit x + 8 y of word z
//     for each of them, by place: hits, misses, number of votes; then class and views of each vote
//     (numbers in groups of 7 bits, the lowest first; the top bit says that another group follows)
//   u64  xxh3-64 of all bytes before it, from the beginning of the file (versions 1 and 2: of the
//        content alone)
#include <bit>
#include <cmath>
#include <iostream>
#include <sstream>

#include <fmt/format.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <xxhash.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/counts_reader.hpp"
#include "slam/occupancy/octomap_file.hpp"
#include "slam/occupancy/voxel_tree.hpp"

namespace mh {
namespace {

/// While in scope, nothing is printed to std::cerr: OctoMap prints " done." there, which would
/// become the last line of a run's log.
class QuietErrors {
 public:
  QuietErrors() : printed_to_(std::cerr.rdbuf(nullptr)) {}
  ~QuietErrors() { std::cerr.rdbuf(printed_to_); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  std::streambuf* printed_to_;
};

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie");

constexpr std::string_view kFloorlessMagic = "modelhouse voxel counts 4\n",
                           kCountsMagic = "modelhouse voxel counts 3\n",
                           kSecondCountsMagic = "modelhouse voxel counts 2\n",
                           kFirstCountsMagic = "modelhouse voxel counts 1\n";

/// A larger full tree would fill the memory of a small machine.
constexpr std::size_t kMostForeignVoxels = 30'000'000;

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put_index(std::string& bytes, const Eigen::Vector3i& index) {
  for (int axis = 0; axis < 3; ++axis) put(bytes, static_cast<std::int16_t>(index[axis]));
}

void put_number(std::string& bytes, unsigned number) {
  for (; number >= 128; number >>= 7U) bytes.push_back(static_cast<char>(number | 128U));
  bytes.push_back(static_cast<char>(number));
}

/// The block of a voxel, and the voxel's place in it.
std::pair<Eigen::Vector3i, unsigned> block_and_place(const octomap::OcTreeKey& key) {
  Eigen::Vector3i block;
  unsigned place = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const unsigned k = key[static_cast<unsigned>(axis)];
    block[axis] = static_cast<int>(k >> 3U) - VoxelTree::kMiddle / 8;
    place = place << 3U | (k & 7U);
  }
  return {block, place};
}

/// Collects a block's voxels, which the octree does not visit in the order of their places.
class BlockWriter {
 public:
  explicit BlockWriter(std::string& bytes) : bytes_(bytes) {}
  void add(const Eigen::Vector3i& block, unsigned place, const VoxelNode& node) {
    if (block != block_) {
      end();
      block_ = block;
    }
    nodes_[place] = &node;
    any_ = true;
  }
  void end() {
    if (!any_) return;
    put_index(bytes_, block_);
    VoxelBlock::Bits known{};
    for (std::size_t place = 0; place < nodes_.size(); ++place)
      if (nodes_[place]) known[place / 64] |= std::uint64_t{1} << place % 64;
    put(bytes_, known);
    for (const VoxelNode*& node : nodes_) {
      if (node == nullptr) continue;
      put_number(bytes_, node->hits);
      put_number(bytes_, node->misses);
      put_number(bytes_, static_cast<unsigned>(node->votes.all().size()));
      for (const ClassVote& vote : node->votes.all()) {
        put_number(bytes_, vote.class_id);
        put_number(bytes_, vote.views);
      }
      node = nullptr;
    }
    any_ = false;
  }

 private:
  std::string& bytes_;
  Eigen::Vector3i block_ = Eigen::Vector3i::Zero();
  std::array<const VoxelNode*, 512> nodes_{};
  bool any_ = false;
};

std::string counts_of(const VoxelTree& tree, const DetectedObjects& detected) {
  std::string bytes;
  put(bytes, tree.getResolution());
  put(bytes, static_cast<std::uint32_t>(detected.entries().size()));
  for (const DetectedObjects::Entry& entry : detected.entries()) {
    put_index(bytes, entry.voxel);
    put(bytes, entry.object);
  }
  put(bytes, static_cast<std::uint32_t>(detected.apart().size()));
  for (const auto& [a, b] : detected.apart()) put(bytes, a), put(bytes, b);
  BlockWriter writer(bytes);
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    const auto [block, place] = block_and_place(leaf.getKey());
    writer.add(block, place, *leaf);
  }
  writer.end();
  return bytes;
}

void read_votes(CountsReader& in, VoxelNode& node) {
  const unsigned count = in.number();
  if (count > classes().size()) in.fail("a voxel has too many votes");
  std::vector<ClassVote> votes(count);
  for (std::size_t i = 0; i < votes.size(); ++i) {
    const unsigned class_id = in.number();
    votes[i] = {static_cast<ClassId>(class_id), in.number()};
    if (class_id == kVoid || class_id >= classes().size() || votes[i].views == 0 ||
        (i > 0 && votes[i].class_id <= votes[i - 1].class_id))
      in.fail("a voxel's votes");
  }
  node.votes.assign(votes);
}

Eigen::Vector3i read_index(CountsReader& in) {
  Eigen::Vector3i index;
  for (int axis = 0; axis < 3; ++axis) index[axis] = in.get<std::int16_t>();
  return index;
}

DetectedObjects read_detected(CountsReader& in) {
  using Id = DetectedObjects::Id;
  std::vector<DetectedObjects::Entry> entries;
  for (auto left = in.get<std::uint32_t>(); left > 0; --left) {
    const Eigen::Vector3i voxel = read_index(in);
    entries.push_back({voxel, in.get<Id>()});
    if (entries.back().object == 0) in.fail("a voxel of no object");
  }
  std::set<std::pair<Id, Id>> apart;
  for (auto left = in.get<std::uint32_t>(); left > 0; --left) {
    const Id a = in.get<Id>(), b = in.get<Id>();
    if (a >= b) in.fail("a pair of objects");
    apart.emplace(a, b);
  }
  return {std::move(entries), std::move(apart)};
}

void read_block(CountsReader& in, VoxelTree& tree) {
  const Eigen::Vector3i index = read_index(in);
  if (!VoxelTree::holds(index)) in.fail("a block is outside of an octree");
  const auto known = in.get<VoxelBlock::Bits>();
  VoxelNode& block = tree.block(index);
  for (unsigned place = 0; place < 512; ++place) {
    if ((known[place / 64] >> place % 64U & 1U) == 0) continue;
    VoxelNode& node = tree.voxel(block, place);
    if (node.is_known()) in.fail("a block appears twice");
    node.hits = in.number();
    node.misses = in.number();
    if (!node.is_known()) in.fail("a voxel without views");
    read_votes(in, node);
    node.follow_counts();
  }
  if (!tree.nodeHasChildren(&block)) in.fail("an empty block");
}

/// Adds a leaf of another program's tree: each of its voxels counts as seen once.
void add_leaf(VoxelTree& tree, const OctomapLeaf& leaf) {
  const int across = std::min(leaf.side, 8);  // voxels within a block
  const Eigen::Vector3i first = leaf.lowest.array() + VoxelTree::kMiddle;
  for (int z = 0; z < leaf.side; z += across)
    for (int y = 0; y < leaf.side; y += across)
      for (int x = 0; x < leaf.side; x += across) {
        const Eigen::Vector3i at = first + Eigen::Vector3i(x, y, z);
        VoxelNode& block = tree.block(at / 8 - Eigen::Vector3i::Constant(VoxelTree::kMiddle / 8));
        for (int i = 0; i < across * across * across; ++i) {
          const Eigen::Vector3i in_leaf(i % across, i / across % across, i / (across * across));
          const Eigen::Vector3i v = (at + in_leaf).unaryExpr([](int k) { return k % 8; });
          VoxelNode& node =
              tree.voxel(block, static_cast<unsigned>(v.x() + 8 * v.y() + 64 * v.z()));
          (leaf.occupied ? node.hits : node.misses) = 1;
          node.follow_counts();
        }
      }
}

}  // namespace

void VoxelMap::write_bt(std::ostream& out) const {
  octomap::OcTree tree(resolution_m());
  for (auto leaf = impl_->tree.begin_leafs(), end = impl_->tree.end_leafs(); leaf != end; ++leaf)
    tree.setNodeValue(leaf.getKey(), leaf->getLogOdds() >= 0 ? kMostLogOdds : kLeastLogOdds, true);
  const QuietErrors quiet;
  tree.writeBinary(out);
}

void VoxelMap::write_ot(std::ostream& out) const {
  octomap::ColorOcTree tree(resolution_m());
  for (auto leaf = impl_->tree.begin_leafs(), end = impl_->tree.end_leafs(); leaf != end; ++leaf) {
    tree.setNodeValue(leaf.getKey(), leaf->getLogOdds(), true);
    ClassVote best;
    for (const ClassVote& vote : leaf->votes.all())
      if (vote.views > best.views) best = vote;
    if (leaf->getLogOdds() < 0) continue;
    const ClassInfo& info = classes()[best.class_id];
    if (best.class_id == kVoid)
      tree.setNodeColor(leaf.getKey(), 160, 160, 160);
    else
      tree.setNodeColor(leaf.getKey(), info.r, info.g, info.b);
  }
  if (tree.size() > 0) tree.updateInnerOccupancy();
  tree.prune();
  std::ostringstream whole;
  {
    const QuietErrors quiet;
    tree.write(whole);
  }
  std::string bytes = std::move(whole).str();
  const std::string counts = counts_of(impl_->tree, impl_->detected);
  bytes += on_floor() ? kCountsMagic : kFloorlessMagic;
  put(bytes, static_cast<std::uint64_t>(counts.size()));
  bytes += counts;
  put(bytes, static_cast<std::uint64_t>(XXH3_64bits(bytes.data(), bytes.size())));
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

VoxelMap VoxelMap::read_ot(std::istream& in, const std::string& name) {
  const auto begin = in.tellg();
  const OctomapHeader header = read_octomap_header(in, name);
  if (header.binary || header.type != "ColorOcTree")
    throw InputError(
        fmt::format("{}: holds a tree of type '{}' without classes, not map.ot of "
                    "`map build`",
                    name, header.type));
  const auto header_size = static_cast<std::size_t>(in.tellg() - begin);
  in.seekg(begin);  // the checksum covers the header, too
  std::ostringstream whole;
  whole << in.rdbuf();
  const std::string bytes = std::move(whole).str();
  CountsReader reader(std::string_view(bytes).substr(header_size), name);
  if (read_octomap_nodes(reader, header, [](const OctomapLeaf&) {}) != header.size)
    reader.fail(fmt::format("its tree does not have the {} nodes that it declares", header.size));
  if (reader.at_end())
    throw InputError(fmt::format(
        "{}: has no counts after its tree: it was written by another program, or was edited",
        name));
  const std::string_view magic = reader.take(kCountsMagic.size());
  const bool old = magic == kSecondCountsMagic || magic == kFirstCountsMagic;
  if (magic != kCountsMagic && magic != kFloorlessMagic && !old)
    reader.fail("its counts do not begin");
  const std::string_view content = reader.take(reader.get<std::uint64_t>());
  const std::string_view summed =
      old ? content : std::string_view(bytes.data(), content.data() + content.size());
  if (XXH3_64bits(summed.data(), summed.size()) != reader.get<std::uint64_t>())
    reader.fail("its checksum is wrong");
  if (!reader.at_end()) reader.fail("it has data after its end");
  CountsReader counts(content, name);
  const auto resolution_m = counts.get<double>();  // the header's is rounded
  if (!(std::abs(resolution_m - header.resolution_m) <= 1e-4 * header.resolution_m))
    counts.fail("its counts have a different resolution");
  VoxelMap map(resolution_m);
  map.set_on_floor(magic != kFloorlessMagic);
  if (magic != kFirstCountsMagic) map.set_detected(read_detected(counts));
  while (!counts.at_end()) read_block(counts, map.impl_->tree);
  return map;
}

void VoxelMap::save_bt(const std::filesystem::path& file) const {
  std::ostringstream out;
  write_bt(out);
  write_atomically(file, out.view());
}

void VoxelMap::save_ot(const std::filesystem::path& file) const {
  std::ostringstream out;
  write_ot(out);
  write_atomically(file, out.view());
}

VoxelMap VoxelMap::load_ot(const std::filesystem::path& file) {
  std::istringstream in(read_file(file));
  return read_ot(in, file.string());
}

VoxelMap VoxelMap::load_octree(const std::filesystem::path& file, std::vector<std::string>& notes) {
  const std::string name = file.string(), bytes = read_file(file);
  std::istringstream in(bytes);
  const OctomapHeader header = read_octomap_header(in, name);
  if (header.type != "OcTree" && header.type != "ColorOcTree")
    throw InputError(fmt::format("{}: holds a tree of type '{}': OcTree and ColorOcTree are read",
                                 name, header.type));
  VoxelMap map(header.resolution_m);
  CountsReader reader(std::string_view(bytes).substr(static_cast<std::size_t>(in.tellg())), name);
  std::size_t voxels = 0;
  const auto count = [&](const OctomapLeaf& leaf) {
    const auto side = static_cast<std::size_t>(leaf.side);
    voxels += side * side * side;
  };
  CountsReader ahead = reader;
  read_octomap_nodes(ahead, header, count);
  if (header.type == "ColorOcTree" && !header.binary && !ahead.at_end()) return load_ot(file);
  if (voxels > kMostForeignVoxels)
    throw InputError(fmt::format("{}: holds {} voxels of {} m, at most {} are read", name, voxels,
                                 header.resolution_m, kMostForeignVoxels));
  read_octomap_nodes(reader, header,
                     [&](const OctomapLeaf& leaf) { add_leaf(map.impl_->tree, leaf); });
  notes.push_back(fmt::format(
      "{}: was written by another program: it has no classes, and its z axis is taken as up",
      name));
  return map;
}

}  // namespace mh
