// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/tum_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/image_file.hpp"
#include "scenes/recordings/associations.hpp"
#include "scenes/recordings/euroc.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "scenes/recordings/nearest_stamp.hpp"
#include "scenes/recordings/tum_list.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

using Listed = TumListEntry;

/// A line for each laser scan, as described in docs/outside_systems.md.
std::string lasers_text(const std::map<Stamp, std::vector<LaserScan>>& lasers) {
  std::string text =
      "# stamp (s), laser, camera_from_laser (x y z qx qy qz qw), first angle, step (rad), least "
      "and "
      "largest range (m), ranges (m, 0 = nothing)\n";
  for (const auto& [stamp_ns, scans] : lasers)
    for (const LaserScan& scan : scans)
      text += fmt::format("{} {} {} {} {} {} {} {}\n", format_stamp(stamp_ns), scan.name,
                          fmt::join(scan.camera_from_laser.numbers(), " "), scan.first_rad,
                          scan.step_rad, scan.min_range_m, scan.max_range_m,
                          fmt::join(scan.ranges_m, " "));
  return text;
}

/// Reads a list whose files are next to it.
std::vector<Listed> read_list(const fs::path& list) {
  std::vector<Listed> entries = parse_tum_list(read_text(list), list.string());
  for (Listed& entry : entries) entry.file = list.parent_path() / entry.file;
  return entries;
}

/// Frames with the listed color images, and no depth yet.
std::vector<RecordedFrame> listed_color(const fs::path& list) {
  std::vector<RecordedFrame> frames;
  for (const Listed& entry : read_list(list))
    frames.push_back({entry.stamp_ns, entry.file, {}, {}});
  if (frames.empty()) throw InputError(fmt::format("{}: lists no image", list.string()));
  return frames;
}

/// Entries by stamp, for lookup by time.
class ByStamp {
 public:
  explicit ByStamp(const std::vector<Listed>& entries)
      : entries_(entries), index_(stamps_of(entries)) {}

  /// The entry nearest in time, or the first in the list of several that are equally near; null if
  /// none is near enough.
  const Listed* nearest(Stamp stamp_ns) const {
    const auto found = index_.nearest(stamp_ns);
    return found ? &entries_[*found] : nullptr;
  }

 private:
  static std::vector<Stamp> stamps_of(const std::vector<Listed>& entries) {
    std::vector<Stamp> stamps_ns;
    for (const Listed& entry : entries) stamps_ns.push_back(entry.stamp_ns);
    return stamps_ns;
  }

  const std::vector<Listed>& entries_;
  StampIndex index_;
};

std::string form_of(int type) {
  return fmt::format("{} of {} bits", counted(CV_MAT_CN(type), "channel"), 8 * CV_ELEM_SIZE1(type));
}

enum class Pixels { kColorOrDepth, kIds };

/// Reads a frame's image. Its declared format is checked before anything is decoded.
cv::Mat read_frame_image(const fs::path& file, std::initializer_list<int> types,
                         const Camera& camera, Pixels pixels = Pixels::kColorOrDepth) {
  const std::string bytes = read_file(file);
  if (pixels == Pixels::kIds && bytes.starts_with("\xff\xd8"))
    throw InputError(fmt::format(
        "{}: is a JPEG image, whose ids are not exact: labels must be PNG images", file.string()));
  const auto check_size = [&](std::int64_t width, std::int64_t height) {
    if (width != camera.width_px || height != camera.height_px)
      throw InputError(fmt::format("{}: is {} x {}, the camera has {} x {}", file.string(), width,
                                   height, camera.width_px, camera.height_px));
  };
  if (const auto size = declared_size(bytes)) check_size(size->width, size->height);
  cv::Mat image;
  try {
    image = decode_image(bytes);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  if (std::ranges::find(types, image.type()) == types.end())
    throw InputError(fmt::format("{}: has {}, needs {}", file.string(), form_of(image.type()),
                                 form_of(*types.begin())));
  check_size(image.cols, image.rows);
  return image;
}

/// Converts to three channels: images of gray cameras have one, and those of simulators that write
/// opacity have four.
cv::Mat as_three_channels(const cv::Mat& image) {
  if (image.channels() == 3) return image;
  cv::Mat color;
  cv::cvtColor(image, color, image.channels() == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_BGRA2BGR);
  return color;
}

Grid2d<std::uint16_t> widened(const cv::Mat& ids) {
  Grid2d<std::uint16_t> wide(ids.cols, ids.rows);
  cv::Mat out(ids.rows, ids.cols, CV_16UC1, wide.data());
  ids.convertTo(out, CV_16U);
  return wide;
}

template <class Number>
void fill_meters(const cv::Mat& depth, std::uint16_t no_depth, Number per_meter,
                 Grid2d<float>& depth_m) {
  for (int y = 0; y < depth.rows; ++y) {
    const auto* const units = depth.ptr<std::uint16_t>(y);
    float* const meters = &depth_m(0, y);
    for (int x = 0; x < depth.cols; ++x) {
      const auto measured = static_cast<float>(static_cast<Number>(units[x]) / per_meter);
      meters[x] = units[x] == no_depth ? 0.0F : measured;
    }
  }
}

/// Copies the channels in the order in which they are stored, so that blue becomes red.
Grid2d<Rgb8> as_it_is(const cv::Mat& bgr) {
  Grid2d<Rgb8> image(bgr.cols, bgr.rows);
  bgr.copyTo(cv::Mat(bgr.rows, bgr.cols, CV_8UC3, image.data()));
  return image;
}

}  // namespace

fs::path associations_in(const fs::path& folder) {
  for (const char* name :
       {"associations.txt", "associated.txt", "association.txt", "associate.txt"})
    if (is_there(folder / name)) return folder / name;
  return {};
}

std::vector<RecordedFrame> load_tum_folder(const fs::path& folder,
                                           std::vector<std::string>* notes) {
  const fs::path both = associations_in(folder);
  const bool associated =
      !both.empty() && !(is_there(folder / "rgb.txt") && is_there(folder / "depth.txt"));
  const fs::path list = associated ? both : folder / "rgb.txt";
  std::vector<RecordedFrame> all = associated ? read_associations(both) : listed_color(list);
  const std::vector<Listed> depth =
      associated ? std::vector<Listed>{} : read_list(folder / "depth.txt");
  std::vector<Listed> labels;
  if (is_there(folder / "label.txt")) labels = read_list(folder / "label.txt");
  const ByStamp depth_at(depth), labels_at(labels);
  std::vector<RecordedFrame> frames;
  for (RecordedFrame& frame : all) {
    if (!associated) {
      const Listed* d = depth_at.nearest(frame.stamp_ns);
      if (d == nullptr) continue;
      frame.depth = d->file;
    }
    if (const Listed* l = labels_at.nearest(frame.stamp_ns)) frame.classes = l->file;
    frames.push_back(frame);
  }
  if (frames.empty())
    throw InputError(
        fmt::format("{}: no color image has a depth image within 0.02 s", folder.string()));
  const auto unlabeled = std::ranges::count_if(
      frames, [](const RecordedFrame& frame) { return frame.classes.empty(); });
  if (notes != nullptr && !labels.empty() && unlabeled > 0)
    notes->push_back(fmt::format("{}: {} of {} frames have no label image within 0.02 s",
                                 (folder / "label.txt").string(), unlabeled, frames.size()));
  if (notes != nullptr && frames.size() < all.size())
    notes->push_back(
        fmt::format("{}: {} of {} color images have no depth image within 0.02 s "
                    "and are left out",
                    folder.string(), all.size() - frames.size(), all.size()));
  sort_frames(frames, list, notes);
  return frames;
}

RgbdFrame read_frame(const RecordedFrame& recorded, const RecordedCamera& camera,
                     const ClassMap* classes) {
  const cv::Mat color = as_three_channels(
      read_frame_image(recorded.color, {CV_8UC3, CV_8UC1, CV_8UC4}, camera.camera));
  const cv::Mat depth = read_frame_image(recorded.depth, {CV_16UC1}, camera.camera);
  RgbdFrame frame;
  frame.stamp_ns = recorded.stamp_ns;
  frame.color = camera.exchange_red_blue ? as_it_is(color) : color_of(color);
  frame.depth_m = Grid2d<float>(color.cols, color.rows);
  // The quotient of two floats equals their quotient in double, rounded, since double has more than
  // twice the digits (Figueroa 1995). Float division takes a quarter of the time.
  const auto per_meter = static_cast<float>(camera.depth_per_meter);
  if (per_meter == camera.depth_per_meter)
    fill_meters(depth, camera.no_depth, per_meter, frame.depth_m);
  else
    fill_meters(depth, camera.no_depth, camera.depth_per_meter, frame.depth_m);
  if (recorded.classes.empty()) return frame;
  const std::initializer_list<int> ours = {CV_8UC1}, foreign = {CV_8UC1, CV_16UC1};
  const cv::Mat ids = read_frame_image(recorded.classes, classes == nullptr ? ours : foreign,
                                       camera.camera, Pixels::kIds);
  try {
    frame.semantics = one_hot(widened(ids), classes);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", recorded.classes.string(), error.what()));
  }
  return frame;
}

TumWriter::TumWriter(fs::path folder, const Camera& camera, PngCompression png_compression)
    : folder_(std::move(folder)),
      camera_(camera),
      png_(png_settings(png_compression)),
      checksums_(folder_) {
  for (const char* part : {"rgb", "depth", "label"}) {
    make_output_folder(folder_ / part);
    listed_[part];
  }
}

fs::path TumWriter::file_of(const char* part, Stamp stamp_ns) const {
  return folder_ / part / (format_stamp(stamp_ns) + ".png");
}

std::array<fs::path, 4> TumWriter::files_of(Stamp stamp_ns) const {
  return {file_of("rgb", stamp_ns), file_of("depth", stamp_ns), file_of("label", stamp_ns),
          file_of("instance", stamp_ns)};
}

void TumWriter::write(const char* part, Stamp stamp_ns, const cv::Mat& image) {
  write_image(file_of(part, stamp_ns), image, png_);
  const std::scoped_lock lock(mutex_);
  listed_[part].insert(stamp_ns);
}

void TumWriter::add_images(const RgbdFrame& frame) {
  cv::Mat depth(frame.depth_m.height(), frame.depth_m.width(), CV_16UC1);
  std::transform(frame.depth_m.begin(), frame.depth_m.end(), depth.ptr<std::uint16_t>(),
                 depth_units);
  write("rgb", frame.stamp_ns, color_image(frame.color));
  write("depth", frame.stamp_ns, depth);
}

void TumWriter::add_labels(Stamp stamp_ns, const Grid2d<ClassId>& classes) {
  write("label", stamp_ns, gray_image(classes));
}

void TumWriter::add(const RgbdFrame& frame) {
  add_images(frame);
  {
    const std::scoped_lock lock(mutex_);
    if (frame.odom_from_camera) odometry_[frame.stamp_ns] = *frame.odom_from_camera;
    for (const ImuReading& reading : frame.imu) imu_[reading.stamp_ns] = reading;
    if (!frame.lasers.empty()) lasers_[frame.stamp_ns] = frame.lasers;
  }
  if (!frame.semantics.index.empty()) add_labels(frame.stamp_ns, class_image(frame.semantics));
}

void TumWriter::add(std::size_t, const ExactFrame& frame) {
  const Stamp stamp_ns = frame.seen.stamp_ns;
  fs::create_directories(folder_ / "instance");
  add_images(frame.seen);
  add_labels(stamp_ns, frame.classes);
  write("instance", stamp_ns, gray_image(frame.instances));
  checksums_.add(files_of(stamp_ns));
  const std::scoped_lock lock(mutex_);
  truth_[stamp_ns] = frame.world_from_camera;
}

bool TumWriter::resume(std::size_t, Stamp stamp_ns, const SE3& world_from_camera) {
  if (!checksums_.hold(files_of(stamp_ns))) return false;
  const std::scoped_lock lock(mutex_);
  for (const char* part : {"rgb", "depth", "label", "instance"}) listed_[part].insert(stamp_ns);
  truth_[stamp_ns] = world_from_camera;
  return true;
}

void TumWriter::finish() {
  checksums_.finish();
  std::string associations;
  for (const auto& [part, stamps] : listed_) {
    std::string list = "# stamp (s) file\n";
    for (const Stamp stamp : stamps) {
      const std::string name = format_stamp(stamp);
      list += fmt::format("{0} {1}/{0}.png\n", name, part);
      if (part == "rgb") associations += fmt::format("{0} rgb/{0}.png {0} depth/{0}.png\n", name);
    }
    write_atomically(folder_ / (part + ".txt"), list);
  }
  write_atomically(folder_ / "associations.txt", associations);
  for (const auto& [name, poses] :
       {std::pair("groundtruth.txt", &truth_), std::pair("odometry.txt", &odometry_)}) {
    Trajectory path;
    for (const auto& [stamp, pose] : *poses) path.push_back({stamp, pose});
    if (!path.empty()) write_tum(folder_ / name, path);
  }
  if (!lasers_.empty()) write_atomically(folder_ / "lasers.txt", lasers_text(lasers_));
  if (!imu_.empty()) {
    std::vector<ImuReading> readings;
    for (const auto& [stamp, reading] : imu_) readings.push_back(reading);
    write_euroc_imu(folder_ / "imu.csv", readings);
  }
  write_atomically(folder_ / "camera_info.yaml", camera_info_text(camera_));
  write_atomically(folder_ / "camera.yaml", settings_text(camera_));
}

}  // namespace mh
