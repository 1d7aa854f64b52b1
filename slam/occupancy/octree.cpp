// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <octomap/octomap.h>

#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/occupancy/occupancy.hpp"

namespace mh {
namespace {

constexpr const char* kMagic = "# Octomap OcTree binary file";

octomap::point3d point(const Eigen::Vector3d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

/// Traverses the nodes of a binary tree as OctoMap would, which accepts any depth.
void check_depth(std::istream& in, unsigned deepest, const std::string& name) {
  std::vector<int> children_left{1};  // by level: the number that have children themselves
  while (!children_left.empty()) {
    if (children_left.back()-- == 0) {
      children_left.pop_back();
      continue;
    }
    if (children_left.size() > deepest)
      throw InputError(fmt::format("{}: its tree is deeper than {} levels", name, deepest));
    unsigned char bytes[2];
    if (!in.read(reinterpret_cast<char*>(bytes), sizeof bytes)) return;       // is truncated
    const unsigned pairs = bytes[0] | static_cast<unsigned>(bytes[1]) << 8U;  // 11: has children
    children_left.push_back(std::popcount(pairs & pairs >> 1U & 0x5555U));
  }
}

/// A leaf of the octree as a block of whole voxels: [low, high) along each axis, counted from the
/// world's origin.
struct Block {
  Eigen::Vector3i low, high;
  bool occupied;
};

Block block_of(const octomap::OcTree& tree, const octomap::OcTree::leaf_iterator& leaf) {
  const double half_m = 0.5 * leaf.getSize();
  const Eigen::Vector3d center(leaf.getX(), leaf.getY(), leaf.getZ());
  const auto voxel = [&](double meters) {
    return static_cast<int>(std::lround(meters / tree.getResolution()));
  };
  Block block{.low = {}, .high = {}, .occupied = tree.isNodeOccupied(*leaf)};
  for (int axis = 0; axis < 3; ++axis) {
    block.low[axis] = voxel(center[axis] - half_m);
    block.high[axis] = voxel(center[axis] + half_m);
  }
  return block;
}

/// What one image shows of the voxels around the camera: free, or occupied, which takes precedence.
class SeenVoxels {
 public:
  /// @param reach  voxels from the center that may be recorded, along each axis
  explicit SeenVoxels(int reach)
      : reach_(reach),
        side_(2 * static_cast<std::size_t>(reach) + 1),
        reported_(side_ * side_ * side_) {}

  void begin(const octomap::OcTreeKey& middle) {
    for (const Voxel& voxel : voxels_) reported_[voxel.place] = kNothing;
    voxels_.clear();
    middle_ = middle;
  }
  void tell_free(const octomap::OcTreeKey& key) { report(key, kFreeVoxel); }
  void tell_occupied(const octomap::OcTreeKey& key) { report(key, kOccupiedVoxel); }

  /// Calls f(key, occupied) once for each voxel.
  template <class F>
  void for_each(F f) const {
    for (const Voxel& voxel : voxels_) f(voxel.key, reported_[voxel.place] == kOccupiedVoxel);
  }

 private:
  enum Told : std::uint8_t { kNothing, kFreeVoxel, kOccupiedVoxel };
  struct Voxel {
    octomap::OcTreeKey key;
    std::size_t place;
  };

  void report(const octomap::OcTreeKey& key, Told reported) {
    std::size_t place = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int from_low = int{key[axis]} - int{middle_[axis]} + reach_;
      assert(from_low >= 0 && from_low <= 2 * reach_);
      place = place * side_ + static_cast<std::size_t>(from_low);
    }
    if (reported_[place] == kNothing) voxels_.push_back({key, place});
    reported_[place] = std::max(reported_[place], reported);
  }

  int reach_;
  std::size_t side_;
  octomap::OcTreeKey middle_;
  std::vector<Told> reported_;  // of a cube around the camera
  std::vector<Voxel> voxels_;
};

int voxels_within(const OccupancyConfig& config) {
  return static_cast<int>(std::ceil(config.max_range_m / config.resolution_m)) + 2;
}

}  // namespace

struct OccupancyMapper::Impl {
  explicit Impl(const OccupancyConfig& c)
      : config(c), tree(c.resolution_m), seen(voxels_within(c)) {}

  /// Same final result as tree.updateNode(), with one descent of the tree instead of two.
  void update(const octomap::OcTreeKey& key, bool occupied) {
    octomap::OcTreeNode* const leaf = pruned ? nullptr : tree.search(key);
    if (leaf != nullptr)
      tree.updateNodeLogOdds(leaf, occupied ? tree.getProbHitLog() : tree.getProbMissLog());
    else
      tree.updateNode(key, occupied, true);
  }

  OccupancyConfig config;
  octomap::OcTree tree;
  bool pruned = false;  ///< a leaf may stand for many voxels
  SeenVoxels seen;
};

OccupancyMapper::OccupancyMapper(const OccupancyConfig& config)
    : impl_(std::make_unique<Impl>(config)) {
  assert(config.resolution_m > 0 && config.max_range_m > 0 && config.stride_px > 0 &&
         config.max_range_m <= 250 * config.resolution_m);
}

OccupancyMapper::~OccupancyMapper() = default;
OccupancyMapper::OccupancyMapper(OccupancyMapper&&) noexcept = default;
OccupancyMapper& OccupancyMapper::operator=(OccupancyMapper&&) noexcept = default;

void OccupancyMapper::insert(const Grid2d<float>& depth_m, const Camera& camera,
                             const SE3& world_from_camera) {
  // Equivalent to OctoMap's insertPointCloud() with `discretize` (rays end at voxel centers, one
  // for each) and `lazy_eval` (inner nodes are not updated: all queries are answered by leaves),
  // without its sets of keys, which took most of the time.
  octomap::OcTree& tree = impl_->tree;
  const octomap::point3d eye = point(world_from_camera.translation());
  octomap::OcTreeKey key;
  if (!tree.coordToKeyChecked(eye, key)) return;  // outside the range of an octree
  impl_->seen.begin(key);

  octomap::KeySet ends;
  octomap::KeyRay ray;
  const int stride = impl_->config.stride_px;
  for (int y = stride / 2; y < depth_m.height(); y += stride)
    for (int x = stride / 2; x < depth_m.width(); x += stride) {
      const double z = depth_m(x, y);
      if (!(z > 0)) continue;
      key = tree.coordToKey(point(world_from_camera * camera.unproject(x, y, z)));
      if (!ends.insert(key).second) continue;
      const octomap::point3d end = tree.keyToCoord(key);
      const double max_range_m = impl_->config.max_range_m;
      const bool within = (end - eye).norm() <= max_range_m;
      const octomap::point3d last =
          within ? end : eye + (end - eye).normalized() * static_cast<float>(max_range_m);
      if (tree.computeRayKeys(eye, last, ray))
        for (const octomap::OcTreeKey& passed : ray) impl_->seen.tell_free(passed);
      if (within) impl_->seen.tell_occupied(key);
    }
  impl_->seen.for_each(
      [&](const octomap::OcTreeKey& voxel, bool occupied) { impl_->update(voxel, occupied); });
}

OccupancyGrid OccupancyMapper::project(double min_z_m, double max_z_m) const {
  const octomap::OcTree& tree = impl_->tree;
  const double r = tree.getResolution();
  std::vector<Block> blocks;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const Block block = block_of(tree, leaf);
    if (block.high.z() * r > min_z_m && block.low.z() * r < max_z_m) blocks.push_back(block);
  }
  OccupancyGrid grid;
  grid.resolution_m = r;
  if (blocks.empty()) return grid;

  Eigen::Vector3i low = blocks.front().low, high = blocks.front().high;
  for (const Block& block : blocks) {
    low = low.cwiseMin(block.low);
    high = high.cwiseMax(block.high);
  }
  grid.origin_m = r * low.head<2>().cast<double>();
  grid.cells = Grid2d<std::int8_t>(high.x() - low.x(), high.y() - low.y(), kUnknownCell);
  for (const Block& block : blocks)
    for (int y = block.low.y() - low.y(); y < block.high.y() - low.y(); ++y)
      for (int x = block.low.x() - low.x(); x < block.high.x() - low.x(); ++x)
        grid.cells(x, y) = std::max(grid.cells(x, y), block.occupied ? kOccupiedCell : kFreeCell);
  return grid;
}

std::size_t OccupancyMapper::leaf_count() const {
  return impl_->tree.getNumLeafNodes();
}

// The file's header is written and read here, and only the data by OctoMap, which would print to
// stderr for each file.
void OccupancyMapper::write_bt(std::ostream& out) const {
  octomap::OcTree tree(impl_->tree);
  tree.toMaxLikelihood();  // as the format does, so that equal neighbors can be merged first
  tree.prune();
  out << kMagic << "\n"
      << fmt::format("id {}\nsize {}\nres {}\ndata\n", tree.getTreeType(), tree.size(),
                     tree.getResolution());
  if (tree.size() > 0) tree.writeBinaryData(out);
}

void OccupancyMapper::save_bt(const std::filesystem::path& file) const {
  std::ostringstream out;
  write_bt(out);
  write_atomically(file, out.view());
}

OccupancyMapper OccupancyMapper::load_bt(const std::filesystem::path& file) {
  std::istringstream in(read_file(file));
  return read_bt(in, file.string());
}

OccupancyMapper OccupancyMapper::read_bt(std::istream& in, const std::string& name) {
  std::string line, key, type;
  std::size_t size = 0;
  OccupancyConfig config{.resolution_m = 0};
  std::getline(in, line);
  const bool has_magic = line == kMagic;
  while (in >> key && key != "data") {
    if (key == "id") in >> type;
    if (key == "size") in >> size;
    if (key == "res") in >> config.resolution_m;
    if (key[0] == '#') std::getline(in, line);
  }
  in.get();  // the end of the line "data"
  if (!in || !has_magic || type != "OcTree" || !(config.resolution_m > 0))
    throw InputError(fmt::format("{}: is not a binary OctoMap file of an OcTree", name));
  OccupancyMapper mapper(config);
  if (size > 0) {
    const std::istream::pos_type begin = in.tellg();
    check_depth(in, mapper.impl_->tree.getTreeDepth(), name);
    in.clear();
    in.seekg(begin);
    mapper.impl_->tree.readBinaryData(in);
  }
  mapper.impl_->pruned = true;
  if (!in || mapper.impl_->tree.size() != size)
    throw InputError(fmt::format("{}: is truncated", name));
  return mapper;
}

}  // namespace mh
