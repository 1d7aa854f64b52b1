// SPDX-License-Identifier: Apache-2.0
#include "slam/detect/darknet_config.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/number_in.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A value in a section, and its line.
struct Stated {
  std::string value;
  int line = 0;
};

struct Section {
  std::string name;  ///< "[yolo]"
  std::map<std::string, Stated> values;
};

std::vector<Section> sections_of(const std::string& config) {
  std::vector<Section> sections;
  std::istringstream lines(config);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::erase_if(line, [](unsigned char c) { return std::isspace(c) != 0; });
    if (line.starts_with('[')) {
      sections.push_back({line, {}});
    } else if (const auto equals = line.find('=');
               !sections.empty() && equals != line.npos && line[0] != '#' && line[0] != ';') {
      sections.back().values[line.substr(0, equals)] = {line.substr(equals + 1), number};
    }
  }
  return sections;
}

[[noreturn]] void refuse(const fs::path& file, const std::string& key, const Stated& stated,
                         const std::string& why) {
  throw InputError(
      fmt::format("{}:{}: {} = {}: {}", file.string(), stated.line, key, stated.value, why));
}

/// The numbers of a list separated by commas. @throws InputError if there is any other word.
std::vector<double> numbers_of(const fs::path& file, const std::string& key, const Stated& stated) {
  std::vector<double> numbers;
  std::istringstream words(stated.value);
  for (std::string word; std::getline(words, word, ',');) {
    const auto value = number_in(word);
    if (!value || !std::isfinite(*value))
      refuse(file, key, stated, fmt::format("'{}' is not a number", word));
    numbers.push_back(*value);
  }
  return numbers;
}

int side_of(const fs::path& file, const Section& net, const std::string& key) {
  const auto found = net.values.find(key);
  if (found == net.values.end()) return 0;
  const std::vector<double> value = numbers_of(file, key, found->second);
  constexpr double kLargest_px = 8192;
  if (value.size() != 1 || value[0] != static_cast<int>(value[0]) || value[0] < 1 ||
      value[0] > kLargest_px)
    refuse(file, key, found->second, "a side is a whole number of pixels up to 8192");
  return static_cast<int>(value[0]);
}

/// Checks that the layer's anchors are positive and that it uses only anchors that it has.
void check_anchors(const fs::path& file, const Section& layer) {
  const auto anchors = layer.values.find("anchors"), mask = layer.values.find("mask");
  if (anchors == layer.values.end()) return;
  const std::vector<double> sides = numbers_of(file, "anchors", anchors->second);
  if (!std::ranges::all_of(sides, [](double side) { return side > 0; }))
    refuse(file, "anchors", anchors->second, "a side of a box is positive");
  if (mask == layer.values.end()) return;
  for (const double index : numbers_of(file, "mask", mask->second))
    if (index < 0 || index != static_cast<int>(index) ||
        2 * static_cast<std::size_t>(index) + 1 >= sides.size())
      refuse(file, "mask", mask->second,
             fmt::format("there is no anchor {} among {}", index, sides.size() / 2));
}

/// Checks that a layer's sources are earlier layers. Their numbers are absolute or, if negative,
/// counted backward.
void check_sources(const fs::path& file, const Section& layer, int number) {
  for (const char* key : {"layers", "from"}) {
    const auto stated = layer.values.find(key);
    if (stated == layer.values.end()) continue;
    for (const double from : numbers_of(file, key, stated->second)) {
      const double index = from < 0 ? number + from : from;
      if (index < 0 || index >= number || from != static_cast<int>(from))
        refuse(file, key, stated->second,
               fmt::format("no layer before this one is number {}", index));
    }
  }
}

}  // namespace

InputSize darknet_input(const std::string& config, const fs::path& file) {
  InputSize size;
  int layers = 0;
  for (const Section& section : sections_of(config)) {
    if (section.name == "[net]" || section.name == "[network]") {
      size = {side_of(file, section, "width"), side_of(file, section, "height")};
      continue;
    }
    check_anchors(file, section);
    check_sources(file, section, layers++);
  }
  return size;
}

}  // namespace mh
