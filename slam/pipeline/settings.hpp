// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "slam/config/slam.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

/// What a settings file says: the camera, how its pictures are stored, and SLAM's parameters.
struct Settings {
  Camera camera;
  bool has_camera = false;        ///< a file without one serves sources that bring their own
  double depth_per_meter = 5000;  ///< value of a depth pixel one meter away
  bool exchange_red_blue = false;
  SlamConfig slam;
  std::vector<std::string> notes;  ///< what was passed over or needs telling, one line each
};

/// Reads our own settings (sections camera, pictures and those of SlamConfig, all optional; a
/// camera needs its focal lengths and center), a settings file of ORB-SLAM2 (`Camera.fx: ...`), or
/// a ROS camera_info (`camera_matrix: ...`), which are told by their keys.
/// @param base  what SLAM's parameters are where the file is silent
/// @throws InputError "file:line: place: value".
Settings load_settings(const std::filesystem::path& file, const SlamConfig& base = {});
Settings parse_settings(std::string text, const std::string& name, const SlamConfig& base = {});

/// Camera, pictures and every setting of SLAM, as a file that load_settings() takes back bit for
/// bit.
std::string format_settings(const Settings& settings);

/// Every setting of SLAM with its value, as YAML that read_slam_config takes back bit for bit; with
/// notes each line ends in a comment that says what it means and which values it may take.
std::string format_slam_config(const SlamConfig& config, bool notes = false);
/// Reads sections of SLAM settings; what is absent keeps its value in `config`. Leaves keys that
/// are no section of SLAM's to the caller, who calls yaml.finish(). @throws InputError.
SlamConfig read_slam_config(YamlReader& yaml, SlamConfig config = {});

}  // namespace mh
