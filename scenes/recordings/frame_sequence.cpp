// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/frame_sequence.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/core/mat.hpp>

#include "scenes/image_file.hpp"
#include "scenes/recordings/class_map.hpp"
#include "scenes/recordings/euroc.hpp"
#include "scenes/recordings/nearest_stamp.hpp"
#include "scenes/recordings/valid_poses.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class ListedSequence : public Sequence {
 public:
  explicit ListedSequence(ListedFrames listed) : listed_(std::move(listed)) {}
  const Camera& camera() const override { return listed_.camera.camera; }
  std::size_t size() const override { return listed_.frames.size(); }
  Stamp stamp_ns(std::size_t index) const override { return listed_.frames[index].stamp_ns; }
  RgbdFrame frame(std::size_t index, RandomStream) const override {
    RgbdFrame frame = read_frame(listed_.frames[index], listed_.camera,
                                 listed_.classes ? &*listed_.classes : nullptr);
    if (listed_.depth_camera)
      frame.depth_m = registered_depth(frame.depth_m, *listed_.depth_camera, camera());
    return frame;
  }
  const Trajectory* truth() const override { return listed_.truth ? &*listed_.truth : nullptr; }
  std::span<const ImuReading> imu() const override { return listed_.imu; }

 private:
  ListedFrames listed_;
};

class FramesInMemory : public Sequence {
 public:
  FramesInMemory(const Camera& camera, std::vector<RgbdFrame> frames)
      : camera_(camera), frames_(std::move(frames)) {}
  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return frames_.size(); }
  Stamp stamp_ns(std::size_t index) const override { return frames_[index].stamp_ns; }
  RgbdFrame frame(std::size_t index, RandomStream) const override { return frames_[index]; }
  const Trajectory* truth() const override { return nullptr; }

 private:
  Camera camera_;
  std::vector<RgbdFrame> frames_;
};

ListedFrames list_tum_folder(std::vector<RecordedFrame> frames, const fs::path& folder,
                             const RecordedCamera& camera, std::vector<std::string>& notes) {
  ListedFrames listed{camera, std::move(frames), {}, {}, {}};
  for (const char* name : {"groundtruth.txt", "groundtruth.csv"})
    if (!listed.truth && is_file(folder / name))
      listed.truth = read_truth(folder / name, notes);
    else if (!listed.truth)
      note_no_file(folder / name, notes);
  if (is_file(folder / "imu.csv")) listed.imu = read_euroc_imu(folder / "imu.csv", notes);
  return listed;
}

bool is_tum_folder(const fs::path& folder) {
  return is_file(folder / "rgb.txt") || is_file(associations_in(folder));
}

/// ETH3D's calibration.txt: fx fy cx cy, pixel centers at integers, no distortion. The size is that
/// of the first image that can be read.
/// @throws InputError naming the file.
RecordedCamera eth3d_camera(const fs::path& file, const std::vector<RecordedFrame>& frames) {
  std::istringstream words(read_text(file));
  std::vector<double> k;
  for (double number = 0; words >> number;) k.push_back(number);
  if (k.size() != 4 || !words.eof())
    throw InputError(fmt::format("{}: is not 'fx fy cx cy'", file.string()));
  RecordedCamera recorded;
  Camera& camera = recorded.camera;
  camera.fx_px = k[0], camera.fy_px = k[1], camera.cx_px = k[2], camera.cy_px = k[3];
  std::vector<Stamp> stamps_ns;
  for (const RecordedFrame& frame : frames) stamps_ns.push_back(frame.stamp_ns);
  camera.rate_hz = rate_of_hz(stamps_ns);
  for (const RecordedFrame& frame : frames) {
    try {
      const cv::Mat image = read_image(frame.color);
      camera.width_px = image.cols, camera.height_px = image.rows;
      break;
    } catch (const InputError&) {  // reported when the frame is skipped
    }
  }
  try {
    validate(camera);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  return recorded;
}

/// @throws InputError if no calibration is specified and the folder has none.
RecordedCamera camera_of(const fs::path& folder, const std::vector<RecordedFrame>& frames,
                         const RecordingConfig& config) {
  if (!config.calibration.empty()) return config.read_camera(config.calibration);
  for (const char* name : {"camera.yaml", "camera_info.yaml"})
    if (is_file(folder / name)) return config.read_camera(folder / name);
  if (is_file(folder / "calibration.txt")) return eth3d_camera(folder / "calibration.txt", frames);
  throw InputError(fmt::format(
      "{}: holds neither camera.yaml nor camera_info.yaml nor ETH3D's "
      "calibration.txt; name a settings file with --settings, in a suite with `settings:`",
      folder.string()));
}

OpenedRecording open_tum(const fs::path& folder, const RecordingConfig& config) {
  if (!is_folder(folder)) throw InputError(fmt::format("{}: is not a folder", folder.string()));
  if (!is_tum_folder(folder))
    throw InputError(
        fmt::format("{}: holds neither rgb.txt nor associations.txt", folder.string()));
  std::vector<std::string> notes;
  std::vector<RecordedFrame> frames = load_tum_folder(folder, &notes);
  const RecordedCamera camera = camera_of(folder, frames, config);
  ListedFrames listed = list_tum_folder(std::move(frames), folder, camera, notes);
  return open_listed(std::move(listed), config, std::move(notes));
}

}  // namespace

const SequenceReader kTumReader{"tum", "FOLDER", is_tum_folder, open_tum, nullptr};

void note_depth_scale(double depth_per_meter, const RecordingConfig& config,
                      std::vector<std::string>& notes) {
  if (config.calibration.empty() || !config.depth_per_meter) return;
  const std::optional<double> stated = config.depth_per_meter(config.calibration);
  if (stated && *stated != depth_per_meter)
    notes.push_back(
        fmt::format("{}: its depth per meter, {:g}, is replaced by {:g}, the recording's own",
                    config.calibration.string(), *stated, depth_per_meter));
}

OpenedRecording open_listed(ListedFrames listed, const RecordingConfig& config,
                            std::vector<std::string> notes) {
  OpenedRecording opened;
  opened.notes = std::move(notes);
  note_depth_scale(listed.camera.depth_per_meter, config, opened.notes);
  // Read even if labels are ignored, so that what is read depends only on the recording.
  if (!config.classes.empty()) listed.classes = load_class_map(config.classes);
  for (const RecordedFrame& frame : listed.frames) {
    for (const fs::path* file : {&frame.color, &frame.depth, &frame.classes})
      if (!file->empty()) opened.files.push_back(*file);
    opened.images.push_back(frame.color);
    opened.has_labels = opened.has_labels || !frame.classes.empty();
  }
  if (!config.classes.empty() && !opened.has_labels)
    opened.notes.push_back(no_labels_note(config.classes));
  else if (!config.classes.empty())
    note_foreign_ids({.frames = listed.frames.size(),
                      .read =
                          [&](std::size_t i) {
                            const fs::path& file = listed.frames[i].classes;
                            return file.empty() ? std::nullopt : decode_gray16(read_file(file));
                          },
                      .place = [&](std::size_t i) { return listed.frames[i].classes.string(); }},
                     *listed.classes, config.classes, opened.notes);
  if (!config.labels)
    for (RecordedFrame& frame : listed.frames) frame.classes.clear();
  opened.sequence = std::make_unique<ListedSequence>(std::move(listed));
  return opened;
}

std::unique_ptr<Sequence> open_tum_folder(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          std::vector<std::string>* notes) {
  std::vector<std::string> ignored;
  return std::make_unique<ListedSequence>(list_tum_folder(
      load_tum_folder(folder, notes), folder, camera, notes == nullptr ? ignored : *notes));
}

std::unique_ptr<Sequence> frames_in_memory(const Camera& camera, std::vector<RgbdFrame> frames) {
  return std::make_unique<FramesInMemory>(camera, std::move(frames));
}

}  // namespace mh
