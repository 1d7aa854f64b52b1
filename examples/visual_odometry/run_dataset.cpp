// SPDX-License-Identifier: Apache-2.0
// Trajectory mode: reads a folder in TUM's layout, writes a trajectory.
#include <array>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "odometry.hpp"

namespace {

/// The camera's poses from wheel odometry, by stamp; empty if the folder has no odometry.
std::map<std::string, cv::Affine3d> read_wheels(const std::string& file) {
  std::map<std::string, cv::Affine3d> wheels;
  std::ifstream lines(file);
  std::string line, stamp;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::array<double, 7> values{};
    words >> stamp;
    for (double& value : values) words >> value;
    if (words) wheels[stamp] = example::pose_of(values);
  }
  return wheels;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 5) {
    std::cerr << "usage: vo_run_dataset DATASET ASSOCIATIONS SETTINGS TRAJECTORY\n";
    return 2;
  }
  const std::string dataset = argv[1];
  std::ifstream associations(argv[2]);
  std::ofstream trajectory(argv[4]);
  if (!associations || !trajectory) {
    std::cerr << argv[2] << " or " << argv[4] << " cannot be opened\n";
    return 2;
  }
  example::VisualOdometry odometry(example::read_settings(argv[3]));
  const auto wheels = read_wheels(dataset + "/odometry.txt");
  std::string line, stamp, color_file, depth_stamp, depth_file;
  while (std::getline(associations, line)) {
    if (!(std::istringstream(line) >> stamp >> color_file >> depth_stamp >> depth_file)) continue;
    const cv::Mat color = cv::imread(dataset + "/" + color_file);
    const cv::Mat depth = cv::imread(dataset + "/" + depth_file, cv::IMREAD_UNCHANGED);
    if (color.empty() || depth.type() != CV_16UC1) {
      std::cerr << color_file << " or " << depth_file << " is not an image of its kind\n";
      return 2;
    }
    const auto told = wheels.find(stamp);
    const example::Found found = odometry.track(
        color, depth, told == wheels.end() ? std::nullopt : std::optional(told->second));
    if (found.world_from_camera)
      trajectory << stamp << ' ' << example::pose_numbers(*found.world_from_camera, ' ') << '\n';
  }
  return trajectory.flush() ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
