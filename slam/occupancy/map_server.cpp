// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <yaml-cpp/emitter.h>

#include "slam/io/counted.hpp"
#include "slam/io/files.hpp"
#include "slam/io/lower_case.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/suggest.hpp"
#include "slam/io/yaml.hpp"
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
constexpr double kFurthest_m = 1e8;  // farthest origin; UTM coordinates are nearer

/// A word as YAML writes it: in quotes if it could be read as anything else.
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

/// The numbers in a PGM's header, and where its pixels begin.
struct PgmHeader {
  bool is_text = false;
  int width = 0, height = 0, brightest = 0;
  std::size_t end = 0;
};

PgmHeader read_pgm_header(const std::string& content, const std::string& file) {
  std::istringstream in(content);
  std::string magic;
  PgmHeader header;
  in >> magic;
  for (int* number : {&header.width, &header.height, &header.brightest}) {
    while ((in >> std::ws).peek() == '#') in.ignore(1 << 20, '\n');
    in >> *number;
  }
  if (!in || header.brightest < 1 || header.brightest > 65535)
    throw InputError(
        file +
        ": is not a PGM image: it must begin with width, height and a maximum of 1 to 65535");
  if (header.width < 1 || header.height < 1 || header.width > 65536 || header.height > 65536)
    throw InputError(
        fmt::format("{}: {} x {} pixels, not 1 to 65536 each", file, header.width, header.height));
  header.is_text = magic == "P2";
  header.end = in.get() == std::istringstream::traits_type::eof()
                   ? content.size()
                   : static_cast<std::size_t>(in.tellg());
  return header;
}

/// The pixels of a text PGM; '#' starts a comment.
std::vector<int> text_pixels(std::string_view text, std::size_t size, const std::string& file) {
  std::vector<int> pixels;
  if (text.size() + 1 < 2 * size) throw InputError(file + ": is truncated");
  pixels.reserve(size);
  while (pixels.size() < size) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n\v\f");
    if (begin == std::string_view::npos) throw InputError(file + ": is truncated");
    text.remove_prefix(begin);
    if (text.starts_with('#')) {
      text.remove_prefix(std::min(text.find('\n'), text.size()));
      continue;
    }
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n\v\f#"));
    int value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size())
      throw InputError(fmt::format("{}: pixel {} is '{}', not a number", file, pixels.size() + 1,
                                   printable(std::string(word.substr(0, 20)))));
    pixels.push_back(value);
    text.remove_prefix(word.size());
  }
  return pixels;
}

std::vector<int> binary_pixels(const std::string& content, const PgmHeader& header,
                               const std::string& file, std::vector<std::string>* warnings) {
  std::string_view bytes = std::string_view(content).substr(header.end);
  const std::size_t size =
      static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
  const std::size_t width = header.brightest > 255 ? 2 : 1;
  if (bytes.size() < width * size) throw InputError(file + ": is truncated");
  // One whitespace character separates header and pixels. CR LF is two, but is accepted.
  if (bytes.size() == width * size + 1 && bytes[0] == '\n' && content[header.end - 1] == '\r')
    bytes.remove_prefix(1);
  const std::size_t left = bytes.size() - width * size;
  if (left > 0 && warnings != nullptr)
    warnings->push_back(fmt::format("{}: {} after its {} x {} pixels {} ignored", file,
                                    counted(left, "byte"), header.width, header.height,
                                    left == 1 ? "is" : "are"));
  std::vector<int> pixels(size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
    pixels[i] = width == 1 ? byte(i) : byte(2 * i) << 8 | byte(2 * i + 1);  // high byte first
  }
  return pixels;
}

/// Reads a PGM, binary or text, its levels scaled to 0 to 255.
GrayImage read_pgm(const std::string& content, const std::string& file,
                   std::vector<std::string>* warnings) {
  const PgmHeader header = read_pgm_header(content, file);
  GrayImage image{Grid2d<std::uint8_t>(), {}};
  const std::size_t size =
      static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
  const std::vector<int> pixels =
      header.is_text ? text_pixels(std::string_view(content).substr(header.end), size, file)
                     : binary_pixels(content, header, file, warnings);
  image.levels = Grid2d<std::uint8_t>(header.width, header.height);
  std::ranges::transform(pixels, image.levels.begin(), [&](int value) {
    if (value < 0 || value > header.brightest)
      throw InputError(
          fmt::format("{}: a pixel is {}, its maximum {}", file, value, header.brightest));
    return static_cast<std::uint8_t>((255 * value + header.brightest / 2) / header.brightest);
  });
  return image;
}

GrayImage read_image_levels(const std::filesystem::path& file, std::vector<std::string>* warnings,
                            const ImageDecoder& decode) {
  const std::string content = read_file(file);
  if (content.starts_with("P5") || content.starts_with("P2"))
    return read_pgm(content, file.string(), warnings);
  if (!decode) throw InputError(file.string() + ": is not a PGM image (P5 or P2)");
  try {
    return decode(content);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

/// x, y (m), yaw (rad). map_saver writes a yaw of -nan where a mapper gave no valid quaternion.
std::vector<double> read_origin(const YamlReader& node, const std::filesystem::path& yaml_file,
                                std::vector<std::string>* warnings) {
  const auto warn = [&](const std::string& what) {
    if (warnings != nullptr)
      warnings->push_back(fmt::format("{}:{}: origin: {}", yaml_file.string(), node.line(), what));
  };
  const std::vector<YamlReader> items = node.items();
  if (items.size() == 3 && items[2].is_scalar() && items[2].as_string().ends_with("nan")) {
    warn(fmt::format("its yaw '{}' is taken as 0", items[2].as_string()));
    return {items[0].as_double(), items[1].as_double(), 0};
  }
  std::vector<double> origin = node.as_numbers(3);
  if (std::abs(origin[2]) > 2 * std::numbers::pi)
    warn(fmt::format("its yaw of {} is read in radians", origin[2]));
  return origin;
}

std::filesystem::path image_named(YamlReader& yaml, const std::filesystem::path& yaml_file) {
  return yaml_file.parent_path() / yaml.string("image");  // an absolute path stays absolute
}

}  // namespace

std::filesystem::path image_of_map(const std::filesystem::path& yaml_file) {
  YamlReader yaml = YamlReader::load(yaml_file);
  return image_named(yaml, yaml_file);
}

std::optional<Eigen::Vector2i> OccupancyGrid::cell_of(const Eigen::Vector2d& place_m) const {
  const Eigen::Vector2d p = Eigen::Rotation2Dd(-yaw_rad) * (place_m - origin_m) / resolution_m;
  if (!(p.array() >= 0).all() || p.x() >= cells.width() || p.y() >= cells.height())
    return std::nullopt;
  return p.array().floor().cast<int>().matrix();
}

void save_map_server(const OccupancyGrid& grid, const std::filesystem::path& stem, GridMode mode) {
  Grid2d<std::uint8_t> image(grid.cells.width(), grid.cells.height());
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) image(x, y) = gray(grid.cells(x, y), mode);
  write_map_image({image, grid.resolution_m, grid.origin_m, grid.yaw_rad, {}}, stem,
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
  throw InputError(fmt::format("{}: already exists and was not written by modelhouse: name another",
                               (is_there(yaml) ? yaml : pgm).string()));
}

void write_map_image(const MapImage& map, const std::filesystem::path& stem, const char* mode) {
  const auto [pgm, yaml] = map_image_files(stem);
  const int width = map.levels.width(), height = map.levels.height();
  std::string image = fmt::format("P5\n{} {}\n255\n", width, height);
  for (int y = height - 1; y >= 0; --y)
    for (const std::uint8_t level : map.levels.row(y)) image.push_back(static_cast<char>(level));
  write_atomically(pgm, image);
  write_atomically(yaml, fmt::format("{}\nimage: {}\nmode: {}\nresolution: {}\n"
                                     "origin: [{}, {}, {}]\nnegate: 0\noccupied_thresh: {}\n"
                                     "free_thresh: {}\n",
                                     kOurs, yaml_word(pgm.filename().string()), mode,
                                     map.resolution_m, map.origin_m.x(), map.origin_m.y(),
                                     map.yaw_rad, kOccupiedThreshold, kFreeThreshold));
}

MapImage read_map_image(YamlReader& yaml, const std::filesystem::path& yaml_file,
                        std::vector<std::string>* warnings, const ImageDecoder& decode) {
  const std::filesystem::path file = image_named(yaml, yaml_file);
  if (!is_there(file)) yaml.at("image").fail(fmt::format("{}: no such file", file.string()));
  MapImage map;
  map.resolution_m = yaml.number("resolution", 1e-4, 100.0);
  const std::vector<double> origin = read_origin(yaml.at("origin"), yaml_file, warnings);
  map.origin_m = {origin[0], origin[1]};
  map.yaw_rad = origin[2];
  if (map.origin_m.cwiseAbs().maxCoeff() > kFurthest_m)
    yaml.at("origin").fail(
        fmt::format("({}, {}) m is farther than {} m", origin[0], origin[1], kFurthest_m));
  const GrayImage image = read_image_levels(file, warnings, decode);
  const int width = image.levels.width(), height = image.levels.height();
  map.levels = Grid2d<std::uint8_t>(width, height);
  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) map.levels(x, height - 1 - y) = image.levels(x, y);
    if (image.clear.empty()) continue;
    const auto row = image.clear.begin() + static_cast<std::ptrdiff_t>(y) * width;
    map.clear.insert(map.clear.end(), row, row + width);
  }
  return map;
}

OccupancyGrid load_map_server(const std::filesystem::path& yaml_file,
                              std::vector<std::string>* warnings, const ImageDecoder& decode) {
  YamlReader yaml = YamlReader::load(yaml_file);
  for (const auto& [key, value] : yaml.entries())
    if (warnings != nullptr && std::ranges::find(kKeys, key) == kKeys.end())
      warnings->push_back(fmt::format("{}:{}: key '{}' is not one of map_server's and is ignored{}",
                                      yaml_file.string(), value.line(), key,
                                      did_you_mean(key, words_of(kKeys))));
  const std::string mode = lower_case(yaml.string("mode", "trinary"));  // as in nav2_map_server
  if (mode != "trinary" && mode != "raw" && mode != "scale")
    yaml.at("mode").fail("'" + mode + "' is not supported, only trinary, scale and raw are");
  const MapImage map = read_map_image(yaml, yaml_file, warnings, decode);
  const std::string negated = lower_case(yaml.string("negate"));
  const bool negate = negated == "1" || negated == "true";  // map_server accepts both
  if (!negate && negated != "0" && negated != "false")
    yaml.at("negate").fail("'" + negated + "' is not 0, 1, true or false");
  const double occupied = yaml.number("occupied_thresh", 0, 1);
  const double free = yaml.number("free_thresh", 0, 1);
  if (free > occupied)
    yaml.at("free_thresh").fail(fmt::format("{} is above occupied_thresh, {}", free, occupied));
  OccupancyGrid grid{.cells = Grid2d<std::int8_t>(map.levels.width(), map.levels.height()),
                     .resolution_m = map.resolution_m,
                     .origin_m = map.origin_m,
                     .yaw_rad = map.yaw_rad};
  std::size_t out_of_range = 0, pixel = 0;
  for (int y = 0; y < grid.cells.height(); ++y)
    for (int x = 0; x < grid.cells.width(); ++x, ++pixel) {
      const std::uint8_t level = map.levels(x, y);
      if (mode == "raw") {  // as in nav2_map_server: values outside 0 to 100 are unknown
        out_of_range += level > kOccupiedCell && level != kUnknownRaw ? 1 : 0;
        grid.cells(x, y) = level <= kOccupiedCell ? static_cast<std::int8_t>(level) : kUnknownCell;
        continue;
      }
      const double p = negate ? level / 255.0 : 1.0 - level / 255.0;
      // As in nav2_map_server, a level equal to a threshold counts as free or occupied, and as free
      // if it equals both thresholds.
      grid.cells(x, y) =
          !map.clear.empty() && map.clear[pixel] ? kUnknownCell
          : p <= free                            ? kFreeCell
          : p >= occupied                        ? kOccupiedCell
          : mode == "scale"
              ? static_cast<std::int8_t>(std::lround(100 * (p - free) / (occupied - free)))
              : kUnknownCell;
    }
  if (out_of_range > 0 && warnings != nullptr)
    warnings->push_back(
        fmt::format("{}: {} from 101 to 254, which mode raw reads as unknown (a cost map? "
                    "`map cost` writes what can be read as NAME_published)",
                    yaml_file.string(), counted(out_of_range, "cell is", "cells are")));
  return grid;
}

}  // namespace mh
