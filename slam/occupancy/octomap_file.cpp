// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/octomap_file.hpp"

#include <bit>
#include <cmath>
#include <sstream>

namespace mh {
namespace {

constexpr std::string_view kTreeMagic = "# Octomap OcTree file",
                           kBinaryMagic = "# Octomap OcTree binary file";
constexpr int kWholeSide = 65536;  // of a tree of 16 levels, in voxels

/// The octant of a cube: bit 0 of `child` is x, bit 1 y, bit 2 z.
OctomapLeaf octant(const OctomapLeaf& cube, unsigned child) {
  OctomapLeaf part{.lowest = cube.lowest, .side = cube.side / 2, .occupied = false};
  for (unsigned axis = 0; axis < 3; ++axis)
    if ((child >> axis & 1U) != 0) part.lowest[axis] += part.side;
  return part;
}

class NodeReader {
 public:
  NodeReader(CountsReader& in, const OctomapHeader& header,
             const std::function<void(const OctomapLeaf&)>& visit)
      : in_(in), has_color_(header.type == "ColorOcTree"), visit_(visit) {}

  /// Reads a node of an .ot file and everything below it: log-odds, color in a ColorOcTree, then a
  /// byte with one bit per child, set if the child follows.
  std::size_t full(OctomapLeaf cube) {
    const auto log_odds = in_.get<float>();
    if (has_color_) in_.take(3);
    const auto children = in_.get<std::uint8_t>();
    if (children == 0) {
      if (std::isnan(log_odds)) in_.fail("a leaf's log-odds are not a number");
      cube.occupied = log_odds >= 0;
      visit_(cube);
    }
    std::size_t nodes = 1;
    for (unsigned child = 0; child < 8; ++child)
      if ((children >> child & 1U) != 0) nodes += full(inner_octant(cube, child));
    return nodes;
  }

  /// Reads an inner node of a .bt file and everything below it: two bits per child (1 free, 2
  /// occupied, 3 an inner node), then the children that are inner nodes.
  std::size_t binary(const OctomapLeaf& cube) {
    const auto kinds = in_.get<std::uint16_t>();
    std::size_t nodes = 1;
    for (unsigned child = 0; child < 8; ++child) {
      const unsigned kind = kinds >> 2 * child & 3U;
      if (kind != 1 && kind != 2) continue;
      OctomapLeaf leaf = inner_octant(cube, child);
      leaf.occupied = kind == 2;
      visit_(leaf);
      ++nodes;
    }
    for (unsigned child = 0; child < 8; ++child)
      if ((kinds >> 2 * child & 3U) == 3) nodes += binary(inner_octant(cube, child));
    return nodes;
  }

 private:
  OctomapLeaf inner_octant(const OctomapLeaf& cube, unsigned child) const {
    if (cube.side == 1) in_.fail("its tree is too deep");
    return octant(cube, child);
  }

  CountsReader& in_;
  bool has_color_;
  const std::function<void(const OctomapLeaf&)>& visit_;
};

}  // namespace

OctomapHeader read_octomap_header(std::istream& in, const std::string& name) {
  std::string line, key, word;
  std::getline(in, line);
  OctomapHeader header{.binary = line.starts_with(kBinaryMagic), .type = "", .size = 0};
  if (!header.binary && !line.starts_with(kTreeMagic))
    throw InputError(fmt::format("{}: is not an OctoMap file (.ot, .bt)", name));
  while (in >> key && key != "data") {
    if (key == "id") in >> header.type;
    if (key == "size") in >> header.size;
    if (key == "res" && in >> word && (std::istringstream(word) >> header.resolution_m).fail())
      throw InputError(fmt::format("{}: its resolution '{}' is not a number", name, word));
    if (key[0] == '#') std::getline(in, line);
  }
  in.get();  // the end of the line "data"
  if (!in) throw InputError(fmt::format("{}: is truncated", name));
  if (!(header.resolution_m >= 1e-3 && header.resolution_m <= 10))
    throw InputError(fmt::format("{}: its resolution {} m is not within 0.001 to 10 m", name,
                                 header.resolution_m));
  return header;
}

std::size_t read_octomap_nodes(CountsReader& in, const OctomapHeader& header,
                               const std::function<void(const OctomapLeaf&)>& visit) {
  if (header.size == 0) return 0;
  const OctomapLeaf whole{.lowest = Eigen::Vector3i::Constant(-kWholeSide / 2), .side = kWholeSide};
  NodeReader reader(in, header, visit);
  return header.binary ? reader.binary(whole) : reader.full(whole);
}

}  // namespace mh
