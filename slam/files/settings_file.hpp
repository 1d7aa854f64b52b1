// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "slam/config/slam.hpp"
#include "slam/core/camera.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// Content of a settings file: the camera, how its images are stored, and SLAM's parameters.
struct Settings {
  Camera camera;
  bool has_camera = false;           ///< not needed if the recording or scene provides its
                                     ///< camera
  double depth_per_meter = 5000;     ///< value of a depth pixel at one meter
  bool has_depth_per_meter = false;  ///< whether the file sets it
  bool exchange_red_blue = false;
  SlamConfig slam;
  std::vector<std::string> notes;  ///< what was ignored or needs mentioning, one line each
};

/// Reads our own settings (sections camera, images and those of SlamConfig, all optional; a camera
/// needs its focal lengths and center), a settings file of ORB-SLAM2 (`Camera.fx: ...`) or
/// ORB-SLAM3 (`Camera1.fx: ...`), or a calibration (read_calibration()), which may also contain our
/// other sections; the format is recognized by its keys.
/// @param base  SLAM's parameters where the file does not set them
/// @throws InputError "file:line: place: value".
Settings load_settings(const std::filesystem::path& file, const SlamConfig& base = {});
Settings parse_settings(std::string text, const std::string& name, const SlamConfig& base = {});

/// Camera, images and every SLAM setting, as a file that load_settings() reads back bit for bit.
std::string format_settings(const Settings& settings);

/// Every SLAM setting with its value, as YAML that read_slam_config reads back bit for bit; with
/// notes, each line ends in a comment stating the meaning and the allowed values.
std::string format_slam_config(const SlamConfig& config, bool notes = false);
/// Reads sections of SLAM settings; absent keys keep their values from `config`. `base: orb_slam2`
/// sets Acceptance::kOrbSlam2. Leaves keys that are not SLAM sections to the caller, who calls
/// yaml.finish(). @throws InputError.
SlamConfig read_slam_config(YamlReader& yaml, SlamConfig config = {});

}  // namespace mh
