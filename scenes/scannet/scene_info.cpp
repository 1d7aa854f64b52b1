// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/scene_info.hpp"

#include <sstream>

#include <fmt/format.h>

#include "scenes/scannet/recording.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

Eigen::Matrix4d read_matrix(const std::string& text) {
  std::istringstream numbers(text);
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i)
    if (!(numbers >> matrix(i / 4, i % 4)))
      throw InputError(
          fmt::format("16 numbers are needed, number {} is missing or not a number", i + 1));
  std::string more;
  if (numbers >> more) throw InputError(fmt::format("'{}' follows the 16th number", more));
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw InputError("the last row must be 0 0 0 1");
  if (!is_rotation(matrix.topLeftCorner<3, 3>()))
    throw InputError("the upper left 3 x 3 is not a rotation: it squeezes, stretches or mirrors");
  return matrix;
}

}  // namespace

ScannetInfo parse_scannet_info(std::string_view text, const std::string& name) {
  ScannetInfo info;
  std::istringstream lines{std::string(text)};
  std::string line;
  bool any = text.empty();
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t equals = line.find('=');
    if (equals == line.npos) continue;
    any = true;
    const std::string key = trimmed(line.substr(0, equals));
    const std::string value = trimmed(line.substr(equals + 1));
    if (key == "sceneType") info.scene_type = value;
    if (key != "axisAlignment") continue;
    try {
      info.aligned_from_scan = read_matrix(value);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}:{}: axisAlignment: {}", name, number, error.what()));
    }
  }
  if (!any) throw InputError(fmt::format("{}:1: no line is 'key = value'", name));
  return info;
}

}  // namespace mh
