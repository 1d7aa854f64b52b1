// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/frame_sequence.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/recorded/class_map.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/trajectory_io.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class TumFolder : public Sequence {
 public:
  TumFolder(const fs::path& folder, const RecordedCamera& camera, std::vector<std::string>* notes)
      : camera_(camera), frames_(load_tum_folder(folder, notes)) {
    const auto truth = folder / "groundtruth.txt";
    if (is_file(truth)) truth_ = read_tum(truth);
  }
  std::vector<RecordedFrame>& frames() { return frames_; }
  void set_classes(ClassMap classes) { classes_ = std::move(classes); }
  const Camera& camera() const override { return camera_.camera; }
  std::size_t size() const override { return frames_.size(); }
  Stamp stamp_ns(std::size_t index) const override { return frames_[index].stamp_ns; }
  RgbdFrame frame(std::size_t index, RandomStream) const override {
    return read_frame(frames_[index], camera_, classes_ ? &*classes_ : nullptr);
  }
  const Trajectory* truth() const override { return truth_ ? &*truth_ : nullptr; }

 private:
  RecordedCamera camera_;
  std::vector<RecordedFrame> frames_;
  std::optional<ClassMap> classes_;
  std::optional<Trajectory> truth_;
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

bool is_tum_folder(const fs::path& folder) {
  return is_file(folder / "rgb.txt") || is_file(folder / "associations.txt");
}

/// @throws InputError if no calibration is named and none lies in the folder.
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
  if (!is_folder(folder)) throw InputError(fmt::format("{}: is no folder", folder.string()));
  if (!is_tum_folder(folder))
    throw InputError(
        fmt::format("{}: holds neither rgb.txt nor associations.txt", folder.string()));
  OpenedRecording opened;
  auto sequence = std::make_unique<TumFolder>(
      folder, config.read_camera(calibration_of(folder, config)), &opened.notes);
  if (!config.classes.empty()) sequence->set_classes(load_class_map(config.classes));
  for (RecordedFrame& frame : sequence->frames()) {
    for (const fs::path* file : {&frame.color, &frame.depth, &frame.classes})
      if (!file->empty()) opened.files.push_back(*file);
    opened.has_labels = opened.has_labels || !frame.classes.empty();
    if (!config.labels) frame.classes.clear();
  }
  opened.sequence = std::move(sequence);
  return opened;
}

}  // namespace

const SequenceReader kTumReader{"tum", "FOLDER", is_tum_folder, open_tum, nullptr};

std::unique_ptr<Sequence> open_tum_folder(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          std::vector<std::string>* notes) {
  return std::make_unique<TumFolder>(folder, camera, notes);
}

std::unique_ptr<Sequence> frames_in_memory(const Camera& camera, std::vector<RgbdFrame> frames) {
  return std::make_unique<FramesInMemory>(camera, std::move(frames));
}

}  // namespace mh
