// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "slam/core/files.hpp"
#include "slam/core/yaml.hpp"
#include "slam/occupancy/occupancy.hpp"

namespace mh {
namespace {

// Gray levels that map_server itself writes; with p = (255 - gray) / 255 they are on the correct
// sides of both thresholds below.
constexpr std::uint8_t kFreeGray = 254, kOccupiedGray = 0, kUnknownGray = 205;
constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;

std::uint8_t gray(std::int8_t cell) {
  return cell == kUnknownCell ? kUnknownGray : cell == kFreeCell ? kFreeGray : kOccupiedGray;
}

/// Reads a binary PGM, upper row first.
Grid2d<std::uint8_t> read_pgm(const std::filesystem::path& file) {
  const std::string content = read_file(file);
  std::istringstream in(content);
  std::string magic;
  int numbers[3] = {0, 0, 0};  // width, height, brightest
  in >> magic;
  for (int& number : numbers) {
    while ((in >> std::ws).peek() == '#') in.ignore(1 << 20, '\n');
    in >> number;
  }
  const auto [width, height, brightest] = numbers;
  if (!in || magic != "P5" || width < 0 || height < 0 || width > 65536 || height > 65536 ||
      brightest != 255)
    throw InputError(fmt::format("{}: is not a binary 8-bit PGM image", file.string()));
  in.get();
  const std::string_view pixels = std::string_view(content).substr(
      std::min(content.size(), static_cast<std::size_t>(in.tellg())));
  if (pixels.size() < static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw InputError(fmt::format("{}: is truncated", file.string()));
  Grid2d<std::uint8_t> image(width, height);
  std::memcpy(image.data(), pixels.data(), image.size());
  return image;
}

}  // namespace

void save_map_server(const OccupancyGrid& grid, const std::filesystem::path& stem) {
  std::filesystem::path pgm = stem, yaml = stem;
  pgm += ".pgm";
  yaml += ".yaml";
  const int width = grid.cells.width(), height = grid.cells.height();
  std::string image = fmt::format("P5\n{} {}\n255\n", width, height);
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x) image.push_back(static_cast<char>(gray(grid.cells(x, y))));
  write_atomically(pgm, image);
  write_atomically(yaml, fmt::format("image: {}\nmode: trinary\nresolution: {}\n"
                                     "origin: [{}, {}, 0]\nnegate: 0\noccupied_thresh: {}\n"
                                     "free_thresh: {}\n",
                                     pgm.filename().string(), grid.resolution_m, grid.origin_m.x(),
                                     grid.origin_m.y(), kOccupiedThreshold, kFreeThreshold));
}

OccupancyGrid load_map_server(const std::filesystem::path& yaml_file) {
  YamlReader yaml = YamlReader::load(yaml_file);
  const std::filesystem::path file = yaml.string("image");
  if (const std::string mode = yaml.string("mode", "trinary"); mode != "trinary")
    yaml.at("mode").fail("'" + mode + "' is not supported, only trinary is");
  OccupancyGrid grid;
  grid.resolution_m = yaml.number("resolution", 1e-4, 100.0);
  const std::vector<double> origin = yaml.at("origin").as_numbers(3);
  if (origin[2] != 0) yaml.at("origin").fail("a turned map is not supported");
  grid.origin_m = {origin[0], origin[1]};
  const bool negate = yaml.integer("negate", 0, 1) == 1;
  const double occupied = yaml.number("occupied_thresh", 0, 1);
  const double free = yaml.number("free_thresh", 0, 1);
  yaml.finish();

  const Grid2d<std::uint8_t> image =
      read_pgm(file.is_absolute() ? file : yaml_file.parent_path() / file);
  grid.cells = Grid2d<std::int8_t>(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const double level = image(x, image.height() - 1 - y) / 255.0;
      const double p = negate ? level : 1.0 - level;
      grid.cells(x, y) = p > occupied ? kOccupiedCell : p < free ? kFreeCell : kUnknownCell;
    }
  return grid;
}

}  // namespace mh
