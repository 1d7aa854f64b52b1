// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <yaml-cpp/emitter.h>

#include "slam/core/counted.hpp"
#include "slam/core/files.hpp"
#include "slam/core/lower_case.hpp"
#include "slam/core/suggest.hpp"
#include "slam/core/yaml.hpp"
#include "slam/occupancy/map_image.hpp"
#include "slam/occupancy/occupancy_grid.hpp"

namespace mh {
namespace {

// Gray levels that map_server itself writes; with p = (255 - gray) / 255 they are on the correct
// sides of both thresholds below.
constexpr std::uint8_t kFreeGray = 254, kOccupiedGray = 0, kUnknownGray = 205;
constexpr double kOccupiedThreshold = 0.65, kFreeThreshold = 0.196;

constexpr std::uint8_t kUnknownRaw = 255;

constexpr std::string_view kOurs = "# Written by modelhouse";
constexpr double kFurthest_m = 1e6;  // of an origin

/// A word as YAML writes it: in quotes if it could be read as anything but itself.
std::string yaml_word(const std::string& word) {
  YAML::Emitter yaml;
  yaml << word;
  return yaml.c_str();
}

std::uint8_t gray(std::int8_t cell, GridMode mode) {
  if (mode == GridMode::kRaw) return cell < 0 ? kUnknownRaw : static_cast<std::uint8_t>(cell);
  return cell == kUnknownCell ? kUnknownGray : cell == kFreeCell ? kFreeGray : kOccupiedGray;
}

/// The keys of a map's YAML file that map_server defines.
constexpr std::array kKeys = {"image",           "mode",       "resolution", "origin", "negate",
                              "occupied_thresh", "free_thresh"};

/// Reads a binary PGM, upper row first.
Grid2d<std::uint8_t> read_pgm(const std::filesystem::path& file,
                              std::vector<std::string>* warnings) {
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
  if (!in || magic != "P5" || brightest != 255)
    throw InputError(fmt::format(
        "{}: is not a binary 8-bit PGM image (P5, maximum 255), the only kind that is read",
        file.string()));
  if (width < 1 || height < 1 || width > 65536 || height > 65536)
    throw InputError(
        fmt::format("{}: {} x {} pixels, not 1 to 65536 each", file.string(), width, height));
  const int blank = in.get();
  const std::string_view pixels = std::string_view(content).substr(
      std::min(content.size(), static_cast<std::size_t>(in.tellg())));
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (pixels.size() < size) throw InputError(fmt::format("{}: is truncated", file.string()));
  // One blank separates header and pixels; a line that ends in CR LF has two.
  const bool two_blanks = pixels.size() == size + 1 && pixels[0] == '\n' && blank == '\r';
  const std::size_t left = pixels.size() - size - (two_blanks ? 1 : 0);
  if (left > 0 && warnings != nullptr)
    warnings->push_back(fmt::format("{}: {} behind its {} x {} pixels {} ignored", file.string(),
                                    counted(left, "byte"), width, height,
                                    left == 1 ? "is" : "are"));
  Grid2d<std::uint8_t> image(width, height);
  std::memcpy(image.data(), pixels.data() + (two_blanks ? 1 : 0), image.size());
  return image;
}

std::filesystem::path image_named(YamlReader& yaml, const std::filesystem::path& yaml_file) {
  return yaml_file.parent_path() / yaml.string("image");  // an absolute path stays one
}

}  // namespace

std::filesystem::path image_of_map(const std::filesystem::path& yaml_file) {
  YamlReader yaml = YamlReader::load(yaml_file);
  return image_named(yaml, yaml_file);
}

std::optional<Eigen::Vector2i> OccupancyGrid::cell_of(const Eigen::Vector2d& place_m) const {
  const Eigen::Vector2d p = (place_m - origin_m) / resolution_m;
  if (!(p.array() >= 0).all() || p.x() >= cells.width() || p.y() >= cells.height())
    return std::nullopt;
  return p.array().floor().cast<int>().matrix();
}

void save_map_server(const OccupancyGrid& grid, const std::filesystem::path& stem, GridMode mode) {
  Grid2d<std::uint8_t> image(grid.cells.width(), grid.cells.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) image(x, y) = gray(grid.cells(x, y), mode);
  write_map_image({image, grid.resolution_m, grid.origin_m}, stem,
                  mode == GridMode::kRaw ? "raw" : "trinary");
}

std::array<std::filesystem::path, 2> map_image_files(const std::filesystem::path& stem) {
  std::array<std::filesystem::path, 2> files{stem, stem};
  files[0] += ".pgm";
  files[1] += ".yaml";
  return files;
}

void require_replaceable_map_image(const std::filesystem::path& stem) {
  if (const auto name = stem.filename(); name.empty() || name == "." || name == "..")
    throw InputError(
        fmt::format("'{}': names no file: a path without extension is needed, to "
                    "which .pgm and .yaml are added",
                    stem.string()));
  if (const auto end = stem.extension(); end == ".pgm" || end == ".yaml")
    throw InputError(fmt::format("{}: .pgm and .yaml are added to it: name it without {}",
                                 stem.string(), end.string()));
  const auto [pgm, yaml] = map_image_files(stem);
  if (is_file(yaml) ? read_file(yaml).starts_with(kOurs) : !is_there(pgm) && !is_there(yaml))
    return;
  throw InputError(fmt::format("{}: is there already, and not from modelhouse: name another",
                               (is_there(yaml) ? yaml : pgm).string()));
}

void write_map_image(const MapImage& map, const std::filesystem::path& stem, const char* mode) {
  const auto [pgm, yaml] = map_image_files(stem);
  const int width = map.levels.width(), height = map.levels.height();
  std::string image = fmt::format("P5\n{} {}\n255\n", width, height);
  for (int y = height - 1; y >= 0; --y)
    for (const std::uint8_t level : map.levels.row(y)) image.push_back(static_cast<char>(level));
  write_atomically(pgm, image);
  write_atomically(
      yaml, fmt::format("{}\nimage: {}\nmode: {}\nresolution: {}\n"
                        "origin: [{}, {}, 0]\nnegate: 0\noccupied_thresh: {}\n"
                        "free_thresh: {}\n",
                        kOurs, yaml_word(pgm.filename().string()), mode, map.resolution_m,
                        map.origin_m.x(), map.origin_m.y(), kOccupiedThreshold, kFreeThreshold));
}

MapImage read_map_image(YamlReader& yaml, const std::filesystem::path& yaml_file,
                        std::vector<std::string>* warnings) {
  const std::filesystem::path file = image_named(yaml, yaml_file);
  MapImage map;
  map.resolution_m = yaml.number("resolution", 1e-4, 100.0);
  const std::vector<double> origin = yaml.at("origin").as_numbers(3);
  if (origin[2] != 0)
    yaml.at("origin").fail(fmt::format("a map turned by {} rad is not supported", origin[2]));
  map.origin_m = {origin[0], origin[1]};
  if (map.origin_m.cwiseAbs().maxCoeff() > kFurthest_m)
    yaml.at("origin").fail(
        fmt::format("({}, {}) m is farther than {} m", origin[0], origin[1], kFurthest_m));
  const Grid2d<std::uint8_t> image = read_pgm(file, warnings);
  map.levels = Grid2d<std::uint8_t>(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) map.levels(x, y) = image(x, image.height() - 1 - y);
  return map;
}

OccupancyGrid load_map_server(const std::filesystem::path& yaml_file,
                              std::vector<std::string>* warnings) {
  YamlReader yaml = YamlReader::load(yaml_file);
  for (const auto& [key, value] : yaml.entries())
    if (warnings != nullptr && std::ranges::find(kKeys, key) == kKeys.end())
      warnings->push_back(fmt::format("{}:{}: key '{}' is none of map_server's and is ignored{}",
                                      yaml_file.string(), value.line(), key,
                                      did_you_mean(key, words_of(kKeys))));
  const std::string mode = lower_case(yaml.string("mode", "trinary"));  // as nav2_map_server
  if (mode != "trinary" && mode != "raw")
    yaml.at("mode").fail("'" + mode + "' is not supported, only trinary and raw are");
  const MapImage map = read_map_image(yaml, yaml_file, warnings);
  const std::string negated = lower_case(yaml.string("negate"));
  const bool negate = negated == "1" || negated == "true";  // map_server takes both
  if (!negate && negated != "0" && negated != "false")
    yaml.at("negate").fail("'" + negated + "' is not 0, 1, true or false");
  const double occupied = yaml.number("occupied_thresh", 0, 1);
  const double free = yaml.number("free_thresh", 0, 1);
  if (free > occupied)
    yaml.at("free_thresh").fail(fmt::format("{} is above occupied_thresh, {}", free, occupied));
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(map.levels.width(), map.levels.height()),
                     .resolution_m = map.resolution_m,
                     .origin_m = map.origin_m};
  std::size_t out_of_range = 0;
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x) {
      const std::uint8_t level = map.levels(x, y);
      if (mode == "raw") {  // as nav2_map_server: what is not 0 to 100 is unknown
        out_of_range += level > kOccupiedCell && level != kUnknownRaw ? 1 : 0;
        grid.cells(x, y) = level <= kOccupiedCell ? static_cast<std::int8_t>(level) : kUnknownCell;
        continue;
      }
      const double p = negate ? level / 255.0 : 1.0 - level / 255.0;
      // A level on a threshold counts as beyond it, on both as free: as nav2_map_server.
      grid.cells(x, y) = p <= free ? kFreeCell : p >= occupied ? kOccupiedCell : kUnknownCell;
    }
  if (out_of_range > 0 && warnings != nullptr)
    warnings->push_back(
        fmt::format("{}: {} from 101 to 254, which mode raw takes for unknown (a cost map? "
                    "`map cost` writes what can be read as NAME_published)",
                    yaml_file.string(), counted(out_of_range, "cell is", "cells are")));
  return grid;
}

}  // namespace mh
