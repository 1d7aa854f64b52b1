// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/bonn.hpp"

#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/SVD>

#include "scenes/recordings/class_map.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/recordings/valid_poses.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

Camera bonn_camera() {
  Camera camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = 542.822841;
  camera.fy_px = 542.576870;
  camera.cx_px = 315.593520;
  camera.cy_px = 237.756098;
  camera.distortion = {
      .k1 = 0.039903, .k2 = -0.099343, .p1 = -0.000730, .p2 = -0.000144, .k3 = 0.0};
  return camera;
}

/// T_ros from the data set's page: it converts between the axes of the file's poses and those of
/// the laser scan. It is its own inverse.
SE3 exchanged_axes() {
  Eigen::Matrix3d rotation;
  rotation << -1, 0, 0, 0, 0, 1, 0, 1, 0;
  return {rotation, Eigen::Vector3d::Zero()};
}

/// T_m from the data set's page. Its 3x3 part is a rotation times 1.0593; a camera is rigid, so
/// only the rotation is used.
SE3 markers_from_camera() {
  Eigen::Matrix3d scaled;
  scaled << 1.0157, 0.1828, -0.2389,  //
      0.0009, -0.8431, -0.6413,       //
      -0.3009, 0.6147, -0.8085;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(scaled, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose()),
          Eigen::Vector3d(0.0113, -0.0098, 0.0111)};
}

bool is_bonn(const fs::path& folder) {
  std::error_code error;
  const fs::path place = without_trailing_slash(fs::absolute(folder, error).lexically_normal());
  return place.filename().string().starts_with("rgbd_bonn_") && is_file(folder / "rgb.txt") &&
         is_file(folder / "depth.txt") && !is_file(folder / "camera.yaml") &&
         !is_file(folder / "camera_info.yaml");
}

OpenedRecording open_bonn(const fs::path& folder, const RecordingConfig& config) {
  if (!is_folder(folder)) throw InputError(fmt::format("{}: is not a folder", folder.string()));
  RecordedCamera camera{.camera = bonn_camera()};
  if (!config.calibration.empty()) camera = config.read_camera(config.calibration);
  camera.depth_per_meter = kDepthPerMeter;
  std::vector<std::string> notes;
  ListedFrames listed{.camera = camera,
                      .frames = load_tum_folder(folder, &notes),
                      .classes = {},
                      .truth = {},
                      .depth_camera = {}};
  if (const fs::path file = folder / "groundtruth.txt"; is_file(file)) {
    listed.truth = read_truth(file, notes);
    if (listed.truth)
      for (TimedPose& pose : *listed.truth)
        pose.world_from_camera =
            exchanged_axes() * pose.world_from_camera * exchanged_axes() * markers_from_camera();
  } else {
    note_no_file(file, notes);
  }
  return open_listed(std::move(listed), config, std::move(notes));
}

}  // namespace

const SequenceReader kBonnReader{"bonn", "FOLDER", is_bonn, open_bonn, nullptr};

}  // namespace mh
