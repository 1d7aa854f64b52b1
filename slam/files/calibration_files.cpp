// SPDX-License-Identifier: Apache-2.0
#include "slam/files/calibration_files.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "slam/features/undistort.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr int kMostPixels = 100000;

int pixels_in(const YamlReader& node) {
  return static_cast<int>(node.as_int(1, kMostPixels));
}

/// Marks a key as read, but only if it exists, since messages list the keys that were asked for.
void pass_over(YamlReader& yaml, const std::string& key) {
  if (yaml.has(key)) yaml.find(key);
}

/// The numbers of a matrix: a list, or `data` in a mapping with rows, cols and, from OpenCV, dt
/// (the number type).
YamlReader numbers_of(YamlReader matrix) {
  if (matrix.is_sequence()) return matrix;
  constexpr std::array kKeys{"rows", "cols", "data", "dt"};
  for (const char* key : kKeys) matrix.find(key);
  matrix.finish();
  return matrix.at("data");
}

void read_matrix(const YamlReader& list, Camera& camera) {
  const std::vector<double> k = list.as_numbers(9);
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    list.fail("is not a matrix [fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  camera.fx_px = k[0], camera.fy_px = k[4], camera.cx_px = k[2], camera.cy_px = k[5];
  require_usable(camera, list);
}

/// Coefficients of OpenCV's model, whatever ROS calls it.
void read_coefficients(const YamlReader& list, std::string_view model, Camera& camera) {
  const std::vector<double> d = list.as_numbers();
  const std::size_t most = model == "plumb_bob" ? 5 : 8;
  if (d.size() > most || d.size() == 6 || d.size() == 7)
    list.fail(fmt::format("{} coefficients; {} has {}", d.size(), model, most));
  camera.distortion = distortion_of(d);
  require_usable(camera, list);
}

/// The distortion model, which some drivers call `camera_model`.
std::string model_in(YamlReader& yaml) {
  std::string model = "plumb_bob";
  for (const char* key : {"distortion_model", "camera_model"})
    if (const auto named = yaml.find(key)) {
      model = named->as_string();
      if (model != "plumb_bob" && model != "rational_polynomial")
        named->fail(fmt::format("'{}' is neither plumb_bob nor rational_polynomial", model));
    }
  return model;
}

void read_camera_calibration(YamlReader& yaml, Camera& camera) {
  camera.width_px = pixels_in(yaml.at("image_width"));
  camera.height_px = pixels_in(yaml.at("image_height"));
  read_matrix(numbers_of(yaml.at("camera_matrix")), camera);
  const std::string model = model_in(yaml);
  if (const auto distortion = yaml.find("distortion_coefficients"))
    read_coefficients(numbers_of(*distortion), model, camera);
  // Keys for stereo rigs and for human readers; those from nr_of_frames on are OpenCV's.
  for (const char* key :
       {"camera_name", "rectification_matrix", "projection_matrix", "calibration_time", "nframes",
        "nr_of_frames", "board_width", "board_height", "square_size", "flags", "aspectRatio",
        "fix_aspect_ratio", "avg_reprojection_error", "per_view_reprojection_errors",
        "extrinsic_parameters", "image_points", "grid_points"})
    pass_over(yaml, key);
}

void read_camera_info(YamlReader& yaml, bool ros2, Camera& camera) {
  camera.width_px = pixels_in(yaml.at("width"));
  camera.height_px = pixels_in(yaml.at("height"));
  read_matrix(yaml.at(ros2 ? "k" : "K"), camera);
  const std::string model = model_in(yaml);
  if (const auto distortion = yaml.find(ros2 ? "d" : "D"))
    read_coefficients(*distortion, model, camera);
  for (const char* binning : {"binning_x", "binning_y"}) yaml.integer_or(binning, 0, 0, 1);
  for (const char* key : {"header", "R", "r", "P", "p", "roi"}) pass_over(yaml, key);
}

void read_kalibr(YamlReader& yaml, Camera& camera) {
  YamlReader first = yaml.at("cam0");
  first.entries();  // marks all keys as read, including those for other sensors
  const auto require = [&](const char* key, std::string_view wanted) {
    if (const YamlReader named = first.at(key); named.as_string() != wanted)
      named.fail(fmt::format("'{}' is not {}", named.as_string(), wanted));
  };
  require("camera_model", "pinhole");
  const YamlReader size = first.at("resolution"), lens = first.at("intrinsics");
  const std::vector<YamlReader> sides = size.items();
  if (sides.size() != 2) size.fail("is not [width, height]");
  camera.width_px = pixels_in(sides[0]);
  camera.height_px = pixels_in(sides[1]);
  const std::vector<double> k = lens.as_numbers(4);
  camera.fx_px = k[0], camera.fy_px = k[1], camera.cx_px = k[2], camera.cy_px = k[3];
  require_usable(camera, lens);
  if (const auto model = first.find("distortion_model"); !model || model->as_string() != "none") {
    require("distortion_model", "radtan");
    read_coefficients(first.at("distortion_coeffs"), "plumb_bob", camera);
  }
  for (int i = 1; i < 100; ++i) pass_over(yaml, fmt::format("cam{}", i));
}

}  // namespace

void require_usable(const Camera& camera, const YamlReader& place) {
  try {
    validate(camera);
    require_undistortable(camera);
  } catch (const InputError& error) {
    place.fail(error.what());
  }
}

bool read_calibration(YamlReader& yaml, Camera& camera) {
  if (yaml.has("camera_matrix"))
    read_camera_calibration(yaml, camera);
  else if (yaml.has("width") && (yaml.has("K") || yaml.has("k")))
    read_camera_info(yaml, yaml.has("k"), camera);
  else if (yaml.has("cam0"))
    read_kalibr(yaml, camera);
  else
    return false;
  return true;
}

}  // namespace mh
