// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// What a ScanNet-like PLY holds. Vertices and faces keep the order of the file.
struct PlyMesh {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Rgb8> colours;          ///< sRGB, one per vertex; empty if the file has none
  std::vector<std::uint16_t> labels;  ///< vertex property `label`; empty if the file has none
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< larger polygons become fans
  std::size_t bytes_left = 0;  ///< behind the last element, blanks apart; a whole file has none
};

/// What to read of it.
struct PlyParts {
  bool geometry = true;  ///< positions, colours, triangles
  bool labels = true;
};

/// Whether these bytes begin a PLY that parse_ply reads: binary, little-endian, without texture
/// coordinates. Whatever else is assimp's to read.
bool is_plain_binary_ply(std::string_view bytes);

/// Reads such a PLY in one pass over its bytes, some 15 times as fast as a general reader, and
/// keeps `label`, which assimp drops. Properties may have any type and order; unknown properties
/// and elements are passed over.
/// @param name  stands for the file in messages
/// @throws InputError naming file, element and value: a header that is none, fewer bytes than it
/// announces, positions that are not finite, faces of fewer than 3 corners or that name a vertex
/// that is not there.
PlyMesh parse_ply(std::string_view bytes, const std::string& name, const PlyParts& parts = {});
PlyMesh read_ply(const std::filesystem::path& file, const PlyParts& parts = {});

/// Appends a warning where bytes are left: the header may announce too little.
void warn_of_bytes_left(const PlyMesh& mesh, const std::filesystem::path& file,
                        std::vector<std::string>* warnings);

/// The bytes of a PLY as ScanNet's: x y z (float), red green blue alpha (uchar), `label` (ushort)
/// where there are labels, faces as `uchar int vertex_indices`.
/// @pre colours (and labels, if any) are as many as positions.
std::string ply_bytes(const PlyMesh& mesh);

}  // namespace mh
