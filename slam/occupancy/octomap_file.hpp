// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <istream>
#include <string>

#include <Eigen/Core>

#include "slam/occupancy/counts_reader.hpp"

namespace mh {

/// The lines before the tree of an OctoMap file.
struct OctomapHeader {
  bool binary = false;  ///< .bt: each leaf free or occupied; otherwise .ot: with log-odds
  std::string type;     ///< "OcTree", "ColorOcTree", ...
  std::size_t size = 0;
  double resolution_m = 0;
};

/// @throws InputError if it is not an OctoMap file.
OctomapHeader read_octomap_header(std::istream& in, const std::string& name);

/// A cube of voxels in the same state.
struct OctomapLeaf {
  Eigen::Vector3i lowest = Eigen::Vector3i::Zero();  ///< voxel; 0 is at the world's origin
  int side = 1;                                      ///< in voxels
  bool occupied = false;                             ///< log-odds of at least 0
};

/// Reads the nodes after the header. @param visit  receives each leaf @returns how many nodes
/// @pre the type is OcTree or ColorOcTree @throws InputError if they are truncated or too deep.
std::size_t read_octomap_nodes(CountsReader& in, const OctomapHeader& header,
                               const std::function<void(const OctomapLeaf&)>& visit);

}  // namespace mh
