// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/scannet_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "scenes/recordings/class_map.hpp"
#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/scannet/files.hpp"
#include "scenes/scannet/label_images.hpp"
#include "scenes/scannet/label_table.hpp"
#include "scenes/scannet/scene_info.hpp"
#include "scenes/scannet/sens.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

Camera camera_of(const RecordedLens& lens) {
  Camera camera;
  camera.width_px = lens.width_px;
  camera.height_px = lens.height_px;
  camera.fx_px = lens.fx_px;
  camera.fy_px = lens.fy_px;
  camera.cx_px = lens.cx_px;
  camera.cy_px = lens.cy_px;
  return camera;
}

/// Maps pixels of the depth camera to pixels of the color camera.
class ColorPixels {
 public:
  explicit ColorPixels(const RecordingInfo& info)
      : info_(info),
        color_from_depth_(info.color.device_from_camera.inverse() * info.depth.device_from_camera),
        parallax_(color_from_depth_.translation().norm() > 1e-6) {}

  /// Column and row in the color image for each pixel of the depth image. If the cameras are apart,
  /// a pixel without depth is treated as far away.
  void find(const Grid2d<std::uint16_t>& depth, cv::Mat& columns, cv::Mat& rows) const {
    columns.create(depth.height(), depth.width(), CV_32FC1);
    rows.create(depth.height(), depth.width(), CV_32FC1);
    for (int y = 0; y < depth.height(); ++y)
      for (int x = 0; x < depth.width(); ++x) {
        const Eigen::Vector2d pixel = find(x, y, depth(x, y));
        columns.at<float>(y, x) = static_cast<float>(pixel.x());
        rows.at<float>(y, x) = static_cast<float>(pixel.y());
      }
  }

 private:
  Eigen::Vector2d find(int x, int y, std::uint16_t depth) const {
    const RecordedLens &from = info_.depth, &to = info_.color;
    const Eigen::Vector3d ray((x - from.cx_px) / from.fx_px, (y - from.cy_px) / from.fy_px, 1.0);
    Eigen::Vector3d seen = color_from_depth_.rotation() * ray;
    if (parallax_ && depth > 0)
      seen += color_from_depth_.translation() * (info_.depth_per_meter / depth);
    constexpr double kNowhere = -1e6;
    if (seen.z() <= 1e-6) return {kNowhere, kNowhere};
    return {to.fx_px * seen.x() / seen.z() + to.cx_px, to.fy_px * seen.y() / seen.z() + to.cy_px};
  }

  const RecordingInfo& info_;
  SE3 color_from_depth_;
  bool parallax_;
};

class ScannetSequence : public Sequence {
 public:
  ScannetSequence(const fs::path& path, const RecordingConfig& config,
                  std::vector<std::string>& notes)
      : recording_(open_recording(path)),
        camera_(camera_of(recording_->info().depth)),
        pixels_(recording_->info()) {
    try {
      validate(camera_);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: depth {}", path.string(), error.what()));
    }
    std::ranges::copy(recording_->notes(), std::back_inserter(notes));
    constexpr double kFar_m = 1;
    const RecordingInfo& info = recording_->info();
    const SE3 apart = info.color.device_from_camera.inverse() * info.depth.device_from_camera;
    if (const double far_m = apart.translation().norm(); far_m > kFar_m)
      notes.push_back(
          fmt::format("{}: its extrinsics put {:g} m between the color and the depth camera: are "
                      "they in meters?",
                      path.string(), far_m));
    const SE3& device_from_camera = recording_->info().depth.device_from_camera;
    for (std::size_t i = 0; i < recording_->size(); ++i)
      if (const auto world_from_device = recording_->world_from_device(i))
        truth_.push_back({recording_->stamp_ns(i), *world_from_device * device_from_camera});
    if (truth_.empty())
      notes.push_back(
          fmt::format("{}: no frame has a valid pose: there is no truth", path.string()));
    for (const ClassInfo& c : classes()) palette_.push_back(ClassDistribution::one_hot(c.id));
    fs::path folder = is_folder(path) ? path : path.parent_path();
    if (folder.empty()) folder = ".";
    labels_ = find_label_images(folder, "label-filt");
    if (labels_ == nullptr) return;
    fs::path table = config.classes;
    if (const auto tables = find_label_tables(folder); table.empty() && !tables.empty())
      table = tables[0];
    if (table.empty()) {
      labels_ = nullptr;
      notes.push_back(fmt::format("{}: labels are left out: neither {} nor {} lies beside them",
                                  folder.string(), kLabelTableV2, kLabelTableV1));
      return;
    }
    note_missing_labels(notes);
    class_of_id_ = load_class_map(table);
    note_foreign_ids({.frames = size(),
                      .read = [&](std::size_t i) { return labels_->read(recording_->number(i)); },
                      .place =
                          [&](std::size_t i) {
                            return fmt::format("{}: the label image of frame {}", labels_->place(),
                                               recording_->number(i));
                          }},
                     class_of_id_, table, notes);
  }

  bool has_labels() const { return labels_ != nullptr; }
  double depth_per_meter() const { return recording_->info().depth_per_meter; }
  void leave_out_labels() { labels_.reset(); }
  std::vector<fs::path> images() const { return recording_->images(); }
  std::vector<fs::path> files() const {
    std::vector<fs::path> files = recording_->files();
    if (labels_ == nullptr) return files;
    for (std::size_t i = 0; i < size(); ++i)
      if (const fs::path file = labels_->file(recording_->number(i)); !file.empty())
        files.push_back(file);
    return files;
  }

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return recording_->size(); }
  Stamp stamp_ns(std::size_t index) const override { return recording_->stamp_ns(index); }

  RgbdFrame frame(std::size_t index, RandomStream) const override {
    const RecordedMoment moment = recording_->frame(index);
    cv::Mat columns, rows;
    pixels_.find(moment.depth, columns, rows);
    RgbdFrame frame;
    frame.stamp_ns = moment.stamp_ns;
    frame.color = color_at(moment.color, columns, rows);
    frame.depth_m = Grid2d<float>(camera_.width_px, camera_.height_px);
    std::ranges::transform(moment.depth, frame.depth_m.begin(), [&](std::uint16_t units) {
      return static_cast<float>(units / recording_->info().depth_per_meter);
    });
    if (labels_ == nullptr) return frame;
    const std::uint32_t number = recording_->number(index);
    if (const auto ids = labels_->read(number)) {
      frame.semantics.palette = palette_;
      frame.semantics.index = classes_at(*ids, number, columns, rows);
    }
    return frame;
  }

  const Trajectory* truth() const override { return truth_.empty() ? nullptr : &truth_; }

 private:
  void note_missing_labels(std::vector<std::string>& notes) const {
    std::size_t missing = 0;
    std::uint32_t first = 0;
    for (std::size_t i = size(); i-- > 0;)
      if (const std::uint32_t number = recording_->number(i); !labels_->contains(number)) {
        ++missing;
        first = number;
      }
    if (missing > 0)
      notes.push_back(
          fmt::format("{}: {} of {} frames have no labels there (the first is frame {})",
                      labels_->place(), missing, size(), first));
  }

  Grid2d<Rgb8> color_at(const Grid2d<Rgb8>& image, const cv::Mat& columns,
                        const cv::Mat& rows) const {
    const cv::Mat full(image.height(), image.width(), CV_8UC3, const_cast<Rgb8*>(image.data()));
    Grid2d<Rgb8> result(camera_.width_px, camera_.height_px);
    cv::Mat out(camera_.height_px, camera_.width_px, CV_8UC3, result.data());
    if (image.width() <= camera_.width_px) {
      cv::remap(full, out, columns, rows, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
      return result;
    }
    cv::Mat smaller;
    cv::resize(full, smaller, out.size(), 0, 0, cv::INTER_AREA);
    // Pixel centers are at integers, so a change of the pixel size shifts them.
    const double sx = static_cast<double>(camera_.width_px) / image.width();
    const double sy = static_cast<double>(camera_.height_px) / image.height();
    const cv::Mat x = (columns + 0.5) * sx - 0.5, y = (rows + 0.5) * sy - 0.5;
    cv::remap(smaller, out, x, y, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
    return result;
  }

  /// Label images have the color image's resolution; some tools store them at the depth image's
  /// resolution.
  Grid2d<std::uint8_t> classes_at(const Grid2d<std::uint16_t>& ids, std::uint32_t number,
                                  const cv::Mat& columns, const cv::Mat& rows) const {
    const RecordedLens& lens = recording_->info().color;
    const bool as_color = ids.width() == lens.width_px && ids.height() == lens.height_px;
    const bool as_depth = ids.width() == camera_.width_px && ids.height() == camera_.height_px;
    if (!as_color && !as_depth)
      throw InputError(fmt::format("{}: {}.png: is {} x {}, the color images are {} x {}",
                                   labels_->place(), number, ids.width(), ids.height(),
                                   lens.width_px, lens.height_px));
    Grid2d<std::uint8_t> result(camera_.width_px, camera_.height_px, kVoid);
    for (int y = 0; y < result.height(); ++y)
      for (int x = 0; x < result.width(); ++x) {
        const int u = as_color ? cvRound(columns.at<float>(y, x)) : x;
        const int v = as_color ? cvRound(rows.at<float>(y, x)) : y;
        if (ids.contains(u, v) && ids(u, v) < class_of_id_.size())
          result(x, y) = class_of_id_[ids(u, v)];
      }
    return result;
  }

  std::unique_ptr<Recording> recording_;
  Camera camera_;
  Trajectory truth_;  // of the frames with a valid pose
  ColorPixels pixels_;
  std::unique_ptr<LabelImages> labels_;
  ClassMap class_of_id_;
  std::vector<ClassDistribution> palette_;
};

bool is_scannet_recording(const fs::path& path) {
  if (!is_folder(path)) return path.extension() == ".sens";
  return (is_folder(path / "color") && is_folder(path / "depth")) ||
         !list_folder(path, "*.sens").empty();
}

OpenedRecording open_recorded(const fs::path& path, const RecordingConfig& config) {
  OpenedRecording opened;
  auto sequence = std::make_unique<ScannetSequence>(path, config, opened.notes);
  opened.files = sequence->files();
  opened.images = sequence->images();
  opened.has_labels = sequence->has_labels();
  note_depth_scale(sequence->depth_per_meter(), config, opened.notes);
  if (!config.labels) sequence->leave_out_labels();
  opened.sequence = std::move(sequence);
  return opened;
}

std::string scene_type(const fs::path& path) {
  std::error_code error;
  const fs::path place = without_trailing_slash(fs::absolute(path, error).lexically_normal());
  const fs::path info = is_folder(place) ? place / (place.filename().string() + ".txt")
                                         : fs::path(place).replace_extension(".txt");
  if (!is_file(info)) return "";
  return parse_scannet_info(read_file(info), info.string()).scene_type;
}

template <class Id>
Grid2d<std::uint16_t> widened(const Grid2d<Id>& ids) {
  Grid2d<std::uint16_t> wide(ids.width(), ids.height());
  std::ranges::copy(ids, wide.begin());
  return wide;
}

}  // namespace

std::uint16_t millimeters(float depth_m) {
  const double units = std::round(kScannetDepthPerMeter * static_cast<double>(depth_m));
  return units > 0.0 && units <= 65535.0 ? static_cast<std::uint16_t>(units) : std::uint16_t{0};
}

RecordedLens recorded_lens(const Camera& camera) {
  return {camera.width_px,
          camera.height_px,
          camera.fx_px,
          camera.fy_px,
          camera.cx_px,
          camera.cy_px,
          {}};
}

std::unique_ptr<Sequence> open_scannet(const fs::path& path, std::vector<std::string>& notes) {
  return std::make_unique<ScannetSequence>(path, RecordingConfig(), notes);
}

const SequenceReader kScannetReader{"scannet", "FOLDER, scannet:FILE.sens", is_scannet_recording,
                                    open_recorded, scene_type};

void write_scannet_recording(const fs::path& folder, const Camera& camera, std::size_t frames,
                             const std::function<ExactFrame(std::size_t index)>& frame_at) {
  const TemporaryFolder work(folder);  // only complete files get their final names
  const fs::path full = fs::absolute(folder).lexically_normal();
  const std::string name = (full.has_filename() ? full : full.parent_path()).filename().string();
  const std::array names = {name + "_2d-label-filt.zip", name + "_2d-instance-filt.zip",
                            name + ".sens"};
  const RecordedLens lens = recorded_lens(camera);
  const RecordingInfo info{.sensor = "Modelhouse",
                           .color = lens,
                           .depth = lens,
                           .depth_per_meter = kScannetDepthPerMeter};
  const auto labels = write_label_zip(work.path() / names[0], "label-filt");
  const auto instances = write_label_zip(work.path() / names[1], "instance-filt");
  save_sens(work.path() / names[2], info, frames, [&](std::size_t index) {
    ExactFrame frame = frame_at(index);
    labels->add(static_cast<std::uint32_t>(index), widened(frame.classes));
    instances->add(static_cast<std::uint32_t>(index), frame.instances);
    RecordedMoment moment{.stamp_ns = frame.seen.stamp_ns,
                          .color = std::move(frame.seen.color),
                          .depth = Grid2d<std::uint16_t>(camera.width_px, camera.height_px),
                          .world_from_device = frame.world_from_camera};
    std::ranges::transform(frame.seen.depth_m, moment.depth.begin(), millimeters);
    return moment;
  });
  labels->finish();
  instances->finish();
  for (const std::string& file : names) {
    std::error_code error;
    fs::rename(work.path() / file, folder / file, error);
    if (error) throw_unwritable(folder / file, error.value());
  }
  write_atomically(folder / kLabelTableV2, label_table_text());
}

}  // namespace mh
