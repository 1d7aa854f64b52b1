// SPDX-License-Identifier: Apache-2.0
#pragma once

// The file format of grids and costs: a PGM image beside a YAML file, as map_server reads them.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "slam/core/grid2d.hpp"
#include "slam/io/yaml.hpp"
#include "slam/occupancy/occupancy_grid.hpp"

namespace mh {

/// Gray levels of a map; row 0 is the southernmost.
struct MapImage {
  Grid2d<std::uint8_t> levels;
  double resolution_m = 0.05;
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
  double yaw_rad = 0;       ///< rotation of the rows about the origin
  std::vector<bool> clear;  ///< pixels that are not opaque, in the order of levels; empty: none
};

/// The paths stem.pgm and stem.yaml.
std::array<std::filesystem::path, 2> map_image_files(const std::filesystem::path& stem);

/// @throws InputError if one of the two exists but was not written by write_map_image(), or if the
/// stem names no file or ends in .pgm or .yaml.
void require_replaceable_map_image(const std::filesystem::path& stem);

/// Writes stem.pgm (upper row = north) and stem.yaml. @throws InputError naming the file.
void write_map_image(const MapImage& map, const std::filesystem::path& stem, const char* mode);

/// The image that a map's YAML file names.
std::filesystem::path image_of_map(const std::filesystem::path& yaml_file);

/// Reads the keys image, resolution and origin, and the image: a PGM, binary or text, whose levels
/// are scaled to 0 to 255, or a format that `decode` reads. The caller reads the other keys.
/// @param warnings  receives what was ignored; may be null
/// @throws InputError naming file, line, field and value.
MapImage read_map_image(YamlReader& yaml, const std::filesystem::path& yaml_file,
                        std::vector<std::string>* warnings = nullptr,
                        const ImageDecoder& decode = nullptr);

}  // namespace mh
