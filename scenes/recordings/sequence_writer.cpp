// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/sequence_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "scenes/image_file.hpp"
#include "scenes/recordings/file_checksums.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "scenes/recordings/scannet_folder.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "scenes/scannet/files.hpp"
#include "scenes/scannet/label_table.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

std::string rows(const Eigen::Matrix4d& m) {
  std::string text;
  for (int y = 0; y < 4; ++y)
    text += fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", m(y, 0), m(y, 1), m(y, 2), m(y, 3));
  return text;
}

class ScanNetWriter : public SequenceWriter {
 public:
  ScanNetWriter(fs::path folder, const Camera& camera, PngCompression png_compression)
      : folder_(std::move(folder)),
        camera_(camera),
        png_(png_settings(png_compression)),
        checksums_(folder_) {
    for (const char* part : {"color", "depth", "pose", "intrinsic", "label-filt", "instance-filt"})
      make_output_folder(folder_ / part);
  }

  void add(std::size_t index, const ExactFrame& frame) override {
    const auto [color, depth, labels, instances, pose] = files_of(index);
    write_atomically(color, encode_jpeg(frame.seen.color, kRecordedJpegQuality));
    const Grid2d<float>& depth_m = frame.seen.depth_m;
    cv::Mat depth_mm(depth_m.height(), depth_m.width(), CV_16UC1);
    std::transform(depth_m.begin(), depth_m.end(), depth_mm.ptr<std::uint16_t>(), millimeters);
    write_image(depth, depth_mm, png_);
    cv::Mat classes;  // 16 bits in this layout
    gray_image(frame.classes).convertTo(classes, CV_16U);
    write_image(labels, classes, png_);
    write_image(instances, gray_image(frame.instances), png_);
    write_atomically(pose, rows(matrix_of(frame.world_from_camera)));
    checksums_.add(files_of(index));
    count(index);
  }

  bool resume(std::size_t index, Stamp, const SE3&) override {
    if (!checksums_.hold(files_of(index))) return false;
    count(index);
    return true;
  }

  void finish() override {
    checksums_.finish();
    const std::string k = rows(intrinsics_of(recorded_lens(camera_)));
    const std::string identity = rows(Eigen::Matrix4d::Identity());
    write_atomically(folder_ / "intrinsic" / "intrinsic_color.txt", k);
    write_atomically(folder_ / "intrinsic" / "intrinsic_depth.txt", k);
    write_atomically(folder_ / "intrinsic" / "extrinsic_color.txt", identity);
    write_atomically(folder_ / "intrinsic" / "extrinsic_depth.txt", identity);
    write_atomically(folder_ / kLabelTableV2, label_table_text());
    // The info file of an extracted .sens; readers expect this name.
    write_atomically(
        folder_ / "_info.txt",
        fmt::format("m_versionNumber = 4\nm_sensorName = Modelhouse\nm_colorWidth = {0}\n"
                    "m_colorHeight = {1}\nm_depthWidth = {0}\nm_depthHeight = {1}\n"
                    "m_depthShift = {2}\nm_frames.size = {3}\n",
                    camera_.width_px, camera_.height_px, kScannetDepthPerMeter, written_.size()));
  }

 private:
  /// Color, depth, classes, instances, pose.
  std::array<fs::path, 5> files_of(std::size_t index) const {
    const std::string name = std::to_string(index);
    return {folder_ / "color" / (name + ".jpg"), folder_ / "depth" / (name + ".png"),
            folder_ / "label-filt" / (name + ".png"), folder_ / "instance-filt" / (name + ".png"),
            folder_ / "pose" / (name + ".txt")};
  }
  void count(std::size_t index) {
    const std::scoped_lock lock(mutex_);
    written_.insert(index);
  }

  fs::path folder_;
  Camera camera_;
  std::vector<int> png_;
  FileChecksums checksums_;
  std::mutex mutex_;
  std::set<std::size_t> written_;
};

}  // namespace

std::vector<int> png_settings(PngCompression compression) {
  if (!compression) return {};
  return {cv::IMWRITE_PNG_COMPRESSION, *compression};
}

std::unique_ptr<SequenceWriter> make_sequence_writer(std::string_view format,
                                                     const fs::path& folder, const Camera& camera,
                                                     PngCompression png_compression) {
  if (format == "tum") return std::make_unique<TumWriter>(folder, camera, png_compression);
  if (format == "scannet-frames")
    return std::make_unique<ScanNetWriter>(folder, camera, png_compression);
  throw InputError(fmt::format("format '{}' is neither 'tum' nor 'scannet-frames'", format));
}

}  // namespace mh
