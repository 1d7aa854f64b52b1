// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/openloris.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/recordings/associations.hpp"
#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/recordings/nearest_stamp.hpp"
#include "scenes/recordings/numbered_images.hpp"
#include "scenes/recordings/tum_list.hpp"
#include "scenes/recordings/valid_poses.hpp"
#include "scenes/scannet/recording.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/lower_case.hpp"
#include "slam/io/text_file.hpp"
#include "slam/io/yaml.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr const char* kColorFrame = "d400_color_optical_frame";
constexpr double kUnitsPerMeter = 1000;  // of the D435i's images

/// Reads OpenCV's dialect of YAML, whose first line is not valid YAML.
YamlReader read_opencv_yaml(const fs::path& file) {
  std::string text = read_text(file);
  if (text.starts_with("%YAML:")) text[0] = '#';
  return YamlReader::parse(text, file.string());
}

RecordedCamera read_sensors(const fs::path& file) {
  YamlReader sensors = read_opencv_yaml(file);
  YamlReader color = sensors.at(kColorFrame);
  RecordedCamera recorded;
  Camera& camera = recorded.camera;
  constexpr std::int64_t kLongestSide_px = 16384;
  camera.width_px = static_cast<int>(color.integer("width", 1, kLongestSide_px));
  camera.height_px = static_cast<int>(color.integer("height", 1, kLongestSide_px));
  camera.rate_hz = color.number_or("fps", camera.rate_hz, 1e-3, 1e6);
  YamlReader intrinsics = color.at("intrinsics");
  const std::vector<double> k = intrinsics.at("data").as_numbers(4);
  camera.fx_px = k[0];  // fx, cx, fy, cy: by columns of the matrix
  camera.cx_px = k[1];
  camera.fy_px = k[2];
  camera.cy_px = k[3];
  if (auto model = color.find("distortion_model")) {
    const std::string name = model->as_string();
    const std::string lower = lower_case(name);
    for (const char* other : {"equidistant", "fisheye", "kannala", "omni", "fov"})
      if (lower.find(other) != std::string::npos)
        model->fail(fmt::format("'{}' is not supported, only radial-tangential lenses are", name));
  }
  if (auto distortion = color.find("distortion_coefficients")) {
    const YamlReader data = distortion->at("data");
    const std::vector<double> d = data.as_numbers();
    if (d.size() != 4 && d.size() != 5 && d.size() != 8)
      data.fail(fmt::format("{}, 4, 5 or 8 are needed", counted(d.size(), "number")));
    camera.distortion = distortion_of(d);
  }
  try {
    validate(camera);
  } catch (const InputError& error) {
    color.fail(error.what());
  }
  return recorded;
}

/// The pose of the color camera on the robot, from a chain of the file's transforms, each of which
/// places a child in its parent.
SE3 base_from_camera(const fs::path& file) {
  struct Link {
    std::string parent, child;
    SE3 parent_from_child;
  };
  YamlReader yaml = read_opencv_yaml(file);
  std::vector<Link> links;
  for (YamlReader& item : yaml.at("trans_matrix").items()) {
    YamlReader matrix = item.at("matrix");
    const YamlReader data = matrix.at("data");
    const std::vector<double> values = data.as_numbers(16);
    const auto pose = pose_of(Eigen::Map<const Eigen::Matrix4d>(values.data()).transpose(),
                              fmt::format("{}:{}", file.string(), data.line()));
    if (!pose) data.fail("a number is not finite");
    links.push_back({item.string("parent_frame"), item.string("child_frame"), *pose});
  }
  std::map<std::string, SE3> base_from = {{"base_link", SE3()}};
  for (std::size_t before = 0; before != base_from.size();) {
    before = base_from.size();
    for (const Link& link : links) {
      const auto parent = base_from.find(link.parent), child = base_from.find(link.child);
      if (parent != base_from.end())
        base_from.try_emplace(link.child, parent->second * link.parent_from_child);
      else if (child != base_from.end())
        base_from.try_emplace(link.parent, child->second * link.parent_from_child.inverse());
    }
  }
  const auto found = base_from.find(kColorFrame);
  if (found == base_from.end())
    throw InputError(
        fmt::format("{}: does not connect {} to base_link", file.string(), kColorFrame));
  return found->second.normalized();
}

std::optional<Trajectory> truth_in(const fs::path& folder, std::vector<std::string>& notes) {
  const fs::path truth = folder / "groundtruth.txt", transforms = folder / "trans_matrix.yaml";
  if (!is_there(truth)) return std::nullopt;
  if (!is_file(truth)) {
    notes.push_back(fmt::format("{}: is not a file: there is no truth", truth.string()));
    return std::nullopt;
  }
  if (!is_file(transforms)) {
    notes.push_back(
        fmt::format("{}: is {}: where the camera is on the robot is unknown, and "
                    "groundtruth.txt is not used",
                    transforms.string(), is_there(transforms) ? "not a file" : "missing"));
    return std::nullopt;
  }
  const SE3 base_from_color = base_from_camera(transforms);
  std::optional<Trajectory> poses = read_truth(truth, notes);
  if (poses)
    for (TimedPose& pose : *poses)
      pose.world_from_camera = pose.world_from_camera * base_from_color;
  return poses;
}

std::vector<RecordedFrame> read_frames(const fs::path& folder, std::vector<std::string>& notes) {
  const auto list = [&](const char* name) {
    const fs::path file = folder / name;
    return parse_tum_list(read_text(file), file.string());
  };
  const auto color = list("color.txt"), depth = list("aligned_depth.txt");
  if (color.empty())
    throw InputError(fmt::format("{}: lists no image", (folder / "color.txt").string()));
  std::vector<Stamp> stamps_ns;
  for (const TumListEntry& entry : depth) stamps_ns.push_back(entry.stamp_ns);
  const StampIndex index(stamps_ns);
  std::vector<RecordedFrame> frames;
  LeftOut without_depth;
  for (const TumListEntry& entry : color)
    if (const auto nearest = index.nearest(entry.stamp_ns))
      frames.push_back({entry.stamp_ns, folder / entry.file, folder / depth[*nearest].file, {}});
    else
      without_depth.add(folder / entry.file);
  if (frames.empty())
    throw InputError(
        fmt::format("{}: no color image has a depth image within 0.02 s", folder.string()));
  without_depth.note(folder, color.size(), notes);
  sort_frames(frames, folder / "color.txt", &notes);
  return frames;
}

bool is_openloris(const fs::path& folder) {
  return is_file(folder / "color.txt") && is_file(folder / "aligned_depth.txt");
}

OpenedRecording open_openloris(const fs::path& folder, const RecordingConfig& config) {
  if (!is_folder(folder)) throw InputError(fmt::format("{}: is not a folder", folder.string()));
  std::vector<std::string> notes;
  RecordedCamera camera = config.calibration.empty() ? read_sensors(folder / "sensors.yaml")
                                                     : config.read_camera(config.calibration);
  camera.depth_per_meter = kUnitsPerMeter;
  ListedFrames listed{.camera = camera,
                      .frames = read_frames(folder, notes),
                      .classes = {},
                      .truth = truth_in(folder, notes),
                      .depth_camera = {}};
  return open_listed(std::move(listed), config, std::move(notes));
}

}  // namespace

const SequenceReader kOpenlorisReader{"openloris", "FOLDER", is_openloris, open_openloris, nullptr};

}  // namespace mh
