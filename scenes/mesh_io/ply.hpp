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

/// Content of a ScanNet-like PLY. Vertices and faces keep the order of the file.
struct PlyMesh {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Rgb8> colors;           ///< sRGB, one per vertex; empty if the file has none
  std::vector<std::uint16_t> labels;  ///< vertex property `label`; empty if the file has none
  // From other data sets; empty if the file has none.
  std::vector<std::uint16_t> nyu40{};         ///< vertex property `NYU40` (3RScan)
  std::vector<std::uint32_t> objects{};       ///< vertex property `objectId` (3RScan)
  std::vector<std::uint32_t> face_objects{};  ///< face property `object_id` (Replica), per triangle
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< larger polygons are split into fans
  std::size_t bytes_left = 0;  ///< bytes after the last element, except whitespace; 0 if intact
};

/// Value in face_objects for a face that belongs to no object.
inline constexpr std::uint32_t kNoObject = 0xffffffffU;

/// Which parts to read.
struct PlyParts {
  bool geometry = true;  ///< positions, colors, triangles and their objects
  bool labels = true;
};

/// Whether parse_ply should read a PLY that starts with these bytes (or report what is wrong with
/// its header). PLYs with texture coordinates or triangle strips are left to assimp.
bool is_plain_ply(std::string_view bytes);

/// Reads a PLY, text or binary of either byte order. Little-endian PLYs are read in one pass over
/// their bytes, some 15 times as fast as by a general reader; the others are converted to that form
/// first. Labels, which assimp drops, are kept. Properties may have any type and order; unknown
/// properties and elements are skipped.
/// @param name  names the file in messages
/// @throws InputError naming file, element and value: a malformed header, fewer bytes than
/// declared, positions that are not finite, faces with fewer than 3 corners or with a vertex index
/// out of range.
PlyMesh parse_ply(std::string_view bytes, const std::string& name, const PlyParts& parts = {});
PlyMesh read_ply(const std::filesystem::path& file, const PlyParts& parts = {});

/// Appends a warning if bytes are left over: the header may declare too few elements.
void warn_of_bytes_left(const PlyMesh& mesh, const std::filesystem::path& file,
                        std::vector<std::string>* warnings);

/// The bytes of a PLY like ScanNet's: x y z (float), red green blue alpha (uchar), `label` (ushort)
/// if there are labels, faces as `uchar int vertex_indices`.
/// @pre there are as many colors (and labels, if any) as positions.
std::string ply_bytes(const PlyMesh& mesh);

}  // namespace mh
