// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/seven_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/recordings/matrix_poses.hpp"
#include "scenes/recordings/numbered_images.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr double kSevenScenesRate_hz = 30;   // of the Kinect; the files have no stamps
constexpr Stamp kPause_ns = 10'000'000'000;  // between two sequences, which are unconnected

/// The folders that a split file names: "sequence7" means the folder seq-07 next to the file.
std::vector<fs::path> folders_of(const fs::path& split) {
  std::istringstream words(read_text(split));
  std::vector<fs::path> folders;
  for (std::string word; words >> word;) {
    std::string_view digits = word;
    for (const std::string_view start : {"sequence", "seq-"})
      if (digits.starts_with(start)) digits.remove_prefix(start.size());
    const auto number = whole_number_of(digits);
    if (!number)
      throw InputError(fmt::format("{}: '{}' is not a sequence such as sequence1", split.string(),
                                   word.substr(0, 40)));
    folders.push_back(split.parent_path() / fmt::format("seq-{:02}", *number));
    if (std::ranges::count(folders, folders.back()) > 1)
      throw InputError(
          fmt::format("{}: '{}': names its sequence a second time", split.string(), word));
    if (!is_folder(folders.back()))
      throw InputError(fmt::format(
          "{}: '{}': {} is not a folder{}", split.string(), word, folders.back().string(),
          is_file(folders.back().string() + ".zip") ? ": unpack the archive of that name" : ""));
  }
  if (folders.empty()) throw InputError(fmt::format("{}: names no sequence", split.string()));
  return folders;
}

/// Collects the frames of sequences, one sequence after another.
class Reading {
 public:
  void add(const fs::path& folder) {
    const auto color = numbered_images(folder, "frame-", ".color.png");
    if (color.empty())
      throw InputError(fmt::format("{}: holds no frame-XXXXXX.color.png", folder.string()));
    const auto depth = numbered_images(folder, "frame-", ".depth.png");
    offered_ += color.size();
    Stamp last_ns = start_ns_;
    for (const auto& [number, file] : color) {
      if (!depth.contains(number)) {
        without_depth_.add(file);
        continue;
      }
      last_ns = start_ns_ + static_cast<Stamp>(std::llround(1e9 * number / kSevenScenesRate_hz));
      frames_.push_back({last_ns, file, depth.at(number), fs::path()});
      const fs::path pose = folder / fmt::format("frame-{:06}.pose.txt", number);
      if (is_file(pose))
        poses_.add(last_ns, read_file(pose), pose.string());
      else
        poses_.add_absent(pose.string());
    }
    start_ns_ = last_ns + kPause_ns;
  }

  const std::vector<RecordedFrame>& frames() const { return frames_; }
  /// Poses of the color camera.
  Trajectory truth(const SE3& depth_from_color) const {
    Trajectory truth;
    for (const TimedPose& pose : poses_.poses())
      truth.push_back({pose.stamp_ns, pose.world_from_camera * depth_from_color});
    return truth;
  }
  std::vector<std::string> notes(const fs::path& path) const {
    std::vector<std::string> notes;
    without_depth_.note(path, offered_, notes);
    poses_.note(path.string(), notes);
    return notes;
  }

 private:
  std::vector<RecordedFrame> frames_;
  MatrixPoses poses_;
  Stamp start_ns_ = 0;
  std::size_t offered_ = 0;
  LeftOut without_depth_;
};

bool is_seven_scenes(const fs::path& path) {
  if (!is_folder(path))
    return (path.filename() == "TrainSplit.txt" || path.filename() == "TestSplit.txt") &&
           is_file(path);
  return !list_folder(path, "frame-*.color.png").empty() &&
         !list_folder(path, "frame-*.pose.txt").empty();
}

OpenedRecording open_seven_scenes(const fs::path& path, const RecordingConfig& config) {
  RecordedCamera camera{.camera = seven_scenes_color()};
  if (!config.calibration.empty()) camera = config.read_camera(config.calibration);
  if (!camera.camera.distortion.none())
    throw InputError(fmt::format("{}: the color camera of 7-Scenes must have no distortion",
                                 config.calibration.string()));
  const DepthCamera depth = seven_scenes_depth();
  if (camera.camera.width_px != depth.camera.width_px ||
      camera.camera.height_px != depth.camera.height_px)
    throw InputError(
        fmt::format("{}: has {} x {} pixels; the depth camera of 7-Scenes, from which depth is "
                    "registered, has {} x {}",
                    config.calibration.string(), camera.camera.width_px, camera.camera.height_px,
                    depth.camera.width_px, depth.camera.height_px));
  camera.depth_per_meter = 1000;
  camera.no_depth = 65535;
  Reading reading;
  for (const fs::path& folder : is_folder(path) ? std::vector{path} : folders_of(path))
    reading.add(folder);
  if (reading.frames().empty())
    throw InputError(fmt::format("{}: no color image has a depth image", path.string()));
  Trajectory truth = reading.truth(depth.color_from_depth.inverse());
  ListedFrames listed{.camera = camera,
                      .frames = reading.frames(),
                      .classes = {},
                      .truth = {},
                      .depth_camera = depth};
  if (!truth.empty()) listed.truth = std::move(truth);
  return open_listed(std::move(listed), config, reading.notes(path));
}

Camera camera_of_kinect(double focal_px) {
  Camera camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = camera.fy_px = focal_px;
  camera.cx_px = 320;
  camera.cy_px = 240;
  camera.rate_hz = kSevenScenesRate_hz;
  return camera;
}

}  // namespace

Camera seven_scenes_color() {
  return camera_of_kinect(525);
}

DepthCamera seven_scenes_depth() {
  Eigen::Matrix3d rotation;
  rotation << 0.99996518012567637, 0.0026765126468950343, -0.0079041012313000904,  //
      -0.0027409311281316700, 0.99996302803027592, -0.0081504520778013286,         //
      0.0078819942130445332, 0.0081718328771890631, 0.99993554558014031;
  const Eigen::Vector3d translation_m(-0.025558943178152542, 0.00010109636268061706,
                                      0.0020318321729487039);
  return {camera_of_kinect(585), SE3(rotation, translation_m).normalized()};
}

const SequenceReader kSevenScenesReader{"seven_scenes", "FOLDER, seven_scenes:SPLIT.txt",
                                        is_seven_scenes, open_seven_scenes, nullptr};

}  // namespace mh
