// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/icl_nuim.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/recordings/associations.hpp"
#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/recordings/valid_poses.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr double kIclNuimRate_hz = 30;  // of the rendered camera, as published

Stamp stamp_of_number(Stamp number_ns) {
  return static_cast<Stamp>(std::llround(static_cast<double>(number_ns) / kIclNuimRate_hz));
}

/// The published calibration, except that fy is published as -480, which fits the world of the
/// poses. Here it is positive, because images of this layout are stored top row first.
Camera icl_nuim_camera() {
  Camera camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx_px = 481.20;
  camera.fy_px = 480.00;
  camera.cx_px = 319.50;
  camera.cy_px = 239.50;
  camera.rate_hz = kIclNuimRate_hz;
  return camera;
}

/// The same pose after a reflection that flips y, in the world frame and in the camera frame.
SE3 reflected(const SE3& pose) {
  const Eigen::DiagonalMatrix<double, 3> turn_y(1, -1, 1);
  return {Eigen::Matrix3d(turn_y * pose.rotation() * turn_y), turn_y * pose.translation()};
}

/// The files of true poses, NAME.gt.freiburg; empty if the folder contains none.
std::vector<std::string> truth_files(const fs::path& folder) {
  return list_folder(folder, "*.gt.freiburg");
}

Trajectory reflected_truth(const fs::path& file, std::vector<std::string>& notes) {
  Trajectory truth = read_truth(file, notes).value_or(Trajectory());
  for (TimedPose& pose : truth)
    pose = {stamp_of_number(pose.stamp_ns), reflected(pose.world_from_camera)};
  return truth;
}

std::vector<RecordedFrame> read_frames(const fs::path& folder, std::vector<std::string>& notes) {
  const fs::path list = folder / "associations.txt";
  std::vector<RecordedFrame> frames = read_associations(list, FirstImage::kDepth);
  for (RecordedFrame& frame : frames) frame.stamp_ns = stamp_of_number(frame.stamp_ns);
  sort_frames(frames, list, &notes);
  return frames;
}

void note_frames_without_pose(const ListedFrames& listed, const std::string& truth,
                              std::vector<std::string>& notes) {
  const auto without = std::ranges::count_if(listed.frames, [&](const RecordedFrame& frame) {
    return !std::ranges::binary_search(*listed.truth, frame.stamp_ns, {}, &TimedPose::stamp_ns);
  });
  if (without > 0)
    notes.push_back(fmt::format("{}: {} of {} frames have no pose: they are used, but not scored",
                                truth, without, listed.frames.size()));
}

bool is_icl_nuim(const fs::path& folder) {
  return is_file(folder / "associations.txt") && !truth_files(folder).empty();
}

OpenedRecording open_icl_nuim(const fs::path& folder, const RecordingConfig& config) {
  if (!is_folder(folder)) throw InputError(fmt::format("{}: is not a folder", folder.string()));
  const std::vector<std::string> truth = truth_files(folder);
  if (truth.size() != 1)
    throw InputError(fmt::format("{}: holds {}, one is needed", folder.string(),
                                 counted(truth.size(), ".gt.freiburg file")));
  std::vector<std::string> notes;
  ListedFrames listed{.camera = {.camera = icl_nuim_camera()},
                      .frames = read_frames(folder, notes),
                      .classes = {},
                      .truth = reflected_truth(folder / truth.front(), notes),
                      .depth_camera = {}};
  if (!config.calibration.empty()) {
    const double depth_per_meter = listed.camera.depth_per_meter;
    listed.camera = config.read_camera(config.calibration);
    listed.camera.depth_per_meter = depth_per_meter;
  }
  note_frames_without_pose(listed, (folder / truth.front()).string(), notes);
  return open_listed(std::move(listed), config, std::move(notes));
}

}  // namespace

const SequenceReader kIclNuimReader{"icl_nuim", "FOLDER", is_icl_nuim, open_icl_nuim, nullptr};

}  // namespace mh
