// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/frame_sequence.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "slam/core/trajectory_io.hpp"

namespace mh {
namespace {

class TumFolder : public Sequence {
 public:
  TumFolder(const std::filesystem::path& folder, const RecordedCamera& camera,
            std::vector<std::string>* notes)
      : camera_(camera), frames_(load_tum_folder(folder, notes)) {
    const auto truth = folder / "groundtruth.txt";
    if (std::filesystem::exists(truth)) truth_ = read_tum(truth);
  }
  const Camera& camera() const override { return camera_.camera; }
  std::size_t size() const override { return frames_.size(); }
  Stamp stamp_ns(std::size_t index) const override { return frames_[index].stamp_ns; }
  RgbdFrame frame(std::size_t index, RandomStream) const override {
    return read_frame(frames_[index], camera_);
  }
  const Trajectory* truth() const override { return truth_ ? &*truth_ : nullptr; }

 private:
  RecordedCamera camera_;
  std::vector<RecordedFrame> frames_;
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

}  // namespace

std::unique_ptr<Sequence> open_tum_folder(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          std::vector<std::string>* notes) {
  return std::make_unique<TumFolder>(folder, camera, notes);
}

std::unique_ptr<Sequence> frames_in_memory(const Camera& camera, std::vector<RgbdFrame> frames) {
  return std::make_unique<FramesInMemory>(camera, std::move(frames));
}

}  // namespace mh
