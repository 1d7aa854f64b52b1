// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/recordings/open_sequence.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/se3.hpp"
#include "slam/io/error.hpp"

namespace mh {

/// A folder for a test, removed after it.
class MadeFolder : public testing::Test {
 protected:
  MadeFolder()
      : folder_(std::filesystem::temp_directory_path() /
                ("mh_made_folder_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~MadeFolder() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }
  /// The error of opening the folder or a file in it; "none" if it is accepted.
  std::string complaint(const std::string& layout, const std::string& name = {},
                        const RecordingConfig& config = {}) const {
    try {
      open_sequence(layout + ":" + (folder_ / name).string(), config);
      return "none";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  std::filesystem::path folder_;
};

/// A room in closed form: the wall z = 3 m, and in front of it the square |x|, |y| <= 0.4 m at
/// z = 1.5 m.
struct WallAndSquare {
  static constexpr double kWall_m = 3.0, kSquare_m = 1.5, kHalf_m = 0.4;

  /// The depth that a camera sees along the ray of a pixel.
  static double depth_m(const Camera& camera, const SE3& world_from_camera, double u, double v) {
    const Eigen::Vector3d ray = world_from_camera.rotation() * camera.unproject(u, v, 1.0);
    const Eigen::Vector3d& eye = world_from_camera.translation();
    const double near_m = (kSquare_m - eye.z()) / ray.z();
    const Eigen::Vector3d hit = eye + near_m * ray;
    return std::abs(hit.x()) <= kHalf_m && std::abs(hit.y()) <= kHalf_m
               ? near_m
               : (kWall_m - eye.z()) / ray.z();
  }
  static Grid2d<std::uint16_t> depth_image(const Camera& camera, const SE3& world_from_camera,
                                           double units_per_meter) {
    Grid2d<std::uint16_t> image(camera.width_px, camera.height_px);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        image(x, y) = static_cast<std::uint16_t>(
            std::lround(units_per_meter * depth_m(camera, world_from_camera, x, y)));
    return image;
  }
};

/// The 16 numbers of a pose, row by row.
inline std::string matrix_text(const SE3& pose, const std::string& between_rows = "\n") {
  std::string text;
  for (int row = 0; row < 3; ++row)
    text += fmt::format("{} {} {} {}{}", pose.rotation()(row, 0), pose.rotation()(row, 1),
                        pose.rotation()(row, 2), pose.translation()[row], between_rows);
  return text + "0 0 0 1\n";
}

}  // namespace mh
