// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/replica.hpp"

#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/recordings/matrix_poses.hpp"
#include "scenes/recordings/numbered_images.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr double kReplicaRate_hz = 30;  // assumed: it is not stated anywhere

/// cam_params.json of the folder, or the one that all scenes share; empty if there is none.
fs::path camera_file(const fs::path& folder) {
  for (const fs::path& place : {folder, folder / ".."})
    if (is_file(place / "cam_params.json")) return (place / "cam_params.json").lexically_normal();
  return {};
}

RecordedCamera read_camera_file(const fs::path& file) {
  const auto json = parse_json_or_discard<nlohmann::json>(read_text(file));
  if (!json.is_object() || !json.contains("camera") || !json["camera"].is_object())
    throw InputError(fmt::format("{}: is not JSON with an object 'camera'", file.string()));
  const auto number = [&](const char* key) {
    const auto found = json["camera"].find(key);
    if (found == json["camera"].end())
      throw InputError(fmt::format("{}: camera: key '{}' is missing", file.string(), key));
    if (!found->is_number() || !(found->get<double>() > 0) || !(found->get<double>() < 1e6))
      throw InputError(fmt::format("{}: camera: {}: {} is not a number between 0 and 1e6",
                                   file.string(), key, found->dump().substr(0, 40)));
    return found->get<double>();
  };
  RecordedCamera recorded;
  Camera& camera = recorded.camera;
  camera.width_px = static_cast<int>(std::lround(number("w")));
  camera.height_px = static_cast<int>(std::lround(number("h")));
  camera.fx_px = number("fx");
  camera.fy_px = number("fy");
  camera.cx_px = number("cx");
  camera.cy_px = number("cy");
  camera.rate_hz = kReplicaRate_hz;
  recorded.depth_per_meter = number("scale");
  try {
    validate(camera);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  return recorded;
}

/// @throws InputError if neither the layout's file nor a calibration exists.
RecordedCamera camera_of(const fs::path& folder, const RecordingConfig& config) {
  const fs::path file = camera_file(folder);
  if (config.calibration.empty()) {
    if (file.empty())
      throw InputError(
          fmt::format("{}: cam_params.json is neither here nor beside this folder; "
                      "name a settings file with --settings, in a suite with `settings:`",
                      folder.string()));
    return read_camera_file(file);
  }
  RecordedCamera camera = config.read_camera(config.calibration);
  if (!file.empty()) camera.depth_per_meter = read_camera_file(file).depth_per_meter;
  return camera;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::istringstream text(read_text(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back(line);
  return lines;
}

bool is_replica(const fs::path& folder) {
  return is_file(folder / "traj.txt") && is_folder(folder / "results");
}

OpenedRecording open_replica(const fs::path& folder, const RecordingConfig& config) {
  if (!is_folder(folder)) throw InputError(fmt::format("{}: is not a folder", folder.string()));
  const RecordedCamera camera = camera_of(folder, config);
  const fs::path images = folder / "results", trajectory = folder / "traj.txt";
  const auto color = numbered_images(images, "frame", ".jpg");
  if (color.empty()) throw InputError(fmt::format("{}: holds no frameXXXXXX.jpg", images.string()));
  const auto depth = numbered_images(images, "depth", ".png");
  const std::vector<std::string> lines = lines_of(trajectory);
  ListedFrames listed{
      .camera = camera, .frames = {}, .classes = {}, .truth = {}, .depth_camera = {}};
  LeftOut without_depth;
  MatrixPoses poses;
  for (const auto& [number, file] : color) {
    if (!depth.contains(number)) {
      without_depth.add(file);
      continue;
    }
    const auto stamp_ns = static_cast<Stamp>(std::llround(1e9 * number / kReplicaRate_hz));
    listed.frames.push_back({stamp_ns, file, depth.at(number), fs::path()});
    const auto line = static_cast<std::size_t>(number);
    const std::string where = fmt::format("{}:{}", trajectory.string(), line + 1);
    if (line < lines.size())
      poses.add(stamp_ns, lines[line], where);
    else
      poses.add_absent(where);
  }
  if (listed.frames.empty())
    throw InputError(fmt::format("{}: no color image has a depth image", images.string()));
  if (!poses.poses().empty()) listed.truth = poses.poses();
  std::vector<std::string> notes;
  without_depth.note(folder, color.size(), notes);
  const auto last = static_cast<std::size_t>(color.rbegin()->first);
  if (lines.size() > last + 1)
    notes.push_back(fmt::format("{}: holds {} poses, and the last frame is number {}",
                                trajectory.string(), lines.size(), last));
  poses.note(folder.string(), notes);
  return open_listed(std::move(listed), config, std::move(notes));
}

}  // namespace

const SequenceReader kReplicaReader{"replica", "FOLDER", is_replica, open_replica, nullptr};

}  // namespace mh
