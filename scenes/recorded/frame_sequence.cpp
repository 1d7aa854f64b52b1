// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/frame_sequence.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/image_file.hpp"
#include "scenes/recorded/class_map.hpp"
#include "scenes/recorded/valid_poses.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/trajectory_io.hpp"

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

ListedFrames list_tum_folder(const fs::path& folder, const RecordedCamera& camera,
                             std::vector<std::string>* notes) {
  ListedFrames listed{camera, load_tum_folder(folder, notes), {}, {}, {}};
  for (const char* name : {"groundtruth.txt", "groundtruth.csv"})
    if (!listed.truth && is_file(folder / name))
      listed.truth = read_trajectory(folder / name);
    else if (!listed.truth && notes != nullptr)
      note_no_file(folder / name, *notes);
  return listed;
}

bool is_tum_folder(const fs::path& folder) {
  return is_file(folder / "rgb.txt") || is_file(folder / "associations.txt");
}

/// @throws InputError if no calibration is specified and none is in the folder.
fs::path calibration_of(const fs::path& folder, const RecordingConfig& config) {
  if (!config.calibration.empty()) return config.calibration;
  for (const char* name : {"camera.yaml", "camera_info.yaml"})
    if (is_file(folder / name)) return folder / name;
  throw InputError(
      fmt::format("{}: holds neither camera.yaml nor camera_info.yaml; name a settings file by "
                  "--settings, in a suite by `settings:`",
                  folder.string()));
}

OpenedRecording open_tum(const fs::path& folder, const RecordingConfig& config) {
  if (!is_folder(folder)) throw InputError(fmt::format("{}: is not a folder", folder.string()));
  if (!is_tum_folder(folder))
    throw InputError(
        fmt::format("{}: holds neither rgb.txt nor associations.txt", folder.string()));
  std::vector<std::string> notes;
  ListedFrames listed =
      list_tum_folder(folder, config.read_camera(calibration_of(folder, config)), &notes);
  return open_listed(std::move(listed), config, std::move(notes));
}

}  // namespace

const SequenceReader kTumReader{"tum", "FOLDER", is_tum_folder, open_tum, nullptr};

OpenedRecording open_listed(ListedFrames listed, const RecordingConfig& config,
                            std::vector<std::string> notes) {
  OpenedRecording opened;
  opened.notes = std::move(notes);
  // Read even where labels are left out: what is read depends on the recording alone.
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
  return std::make_unique<ListedSequence>(list_tum_folder(folder, camera, notes));
}

std::unique_ptr<Sequence> frames_in_memory(const Camera& camera, std::vector<RgbdFrame> frames) {
  return std::make_unique<FramesInMemory>(camera, std::move(frames));
}

}  // namespace mh
