// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/recording.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/image_file.hpp"
#include "scenes/scannet/frame_folder.hpp"
#include "scenes/scannet/sens.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/number_in.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Reads sixteen numbers from a text file, row by row; "-inf" is a number.
Eigen::Matrix4d read_matrix(const fs::path& file) {
  return parse_matrix(read_text(file), file.string());
}

/// color/ depth/ pose/ intrinsic/, as ScanNet's SensReader extracts them.
class ExtractedFolder : public Recording {
 public:
  explicit ExtractedFolder(const fs::path& folder)
      : folder_(folder),
        color_(folder / "color", {".jpg", ".png"}),
        depth_(folder / "depth", {".png"}) {
    for (const std::uint32_t number : color_.numbers())
      if (depth_.contains(number)) numbers_.push_back(number);
    if (numbers_.empty())
      throw InputError(fmt::format("{}: no image in color/ has one with the same number in depth/",
                                   folder.string()));
    info_.sensor = "extracted";
    info_.color = read_lens("color", announced(color_));
    info_.depth = read_lens("depth", announced(depth_));
    for (const std::uint32_t number : numbers_)
      poses_.push_back(pose_or_none([&] { return read_pose(number); }));
    note_faulty_poses();
    note_files_alone();
    if (missing_poses_ > 0)
      notes_.push_back(
          fmt::format("{}: {} of {} frames have no file in pose/: their pose is unknown",
                      folder_.string(), missing_poses_, numbers_.size()));
  }

  const RecordingInfo& info() const override { return info_; }
  std::size_t size() const override { return numbers_.size(); }
  /// Extracted folders have no stamps: ScanNet's sensor recorded 30 images per second.
  Stamp stamp_ns(std::size_t index) const override {
    return static_cast<Stamp>(numbers_[index]) * 1'000'000'000 / 30;
  }
  std::uint32_t number(std::size_t index) const override { return numbers_[index]; }
  std::optional<SE3> world_from_device(std::size_t index) const override { return poses_[index]; }

  std::vector<fs::path> files() const override {
    std::vector<fs::path> files;
    for (const std::uint32_t number : numbers_)
      files.insert(files.end(), {color_.file(number), depth_.file(number)});
    return files;
  }

  std::vector<fs::path> images() const override {
    std::vector<fs::path> images;
    for (const std::uint32_t number : numbers_) images.push_back(color_.file(number));
    return images;
  }

  RecordedMoment frame(std::size_t index) const override {
    const fs::path color_file = color_.file(numbers_[index]);
    const fs::path depth_file = depth_.file(numbers_[index]);
    auto color = decode_color(read_whole(color_file));
    auto depth = depth_in(depth_file);
    if (!color)
      throw InputError(fmt::format("{}: is not an image of 3 x 8 bits", color_file.string()));
    check_size(*color, info_.color, color_file);
    check_size(depth, info_.depth, depth_file);
    return {stamp_ns(index), std::move(*color), std::move(depth), poses_[index]};
  }

 private:
  static std::string read_whole(const fs::path& file) {
    std::string bytes = read_file(file);
    if (const char* fault = image_fault(bytes))
      throw InputError(fmt::format("{}: {}", file.string(), fault));
    return bytes;
  }

  static Grid2d<std::uint16_t> depth_in(const fs::path& file) {
    const std::string bytes = read_file(file);
    try {
      return decode_depth16(bytes);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", file.string(), error.what()));
    }
  }

  ImageSize announced(const NumberedFiles& files) const {
    const fs::path file = files.file(numbers_.front());
    const auto size = declared_size(read_file(file));
    constexpr std::uint32_t kLongestSide_px = 16384;
    if (!size || size->width == 0 || size->height == 0 || size->width > kLongestSide_px ||
        size->height > kLongestSide_px)
      throw InputError(fmt::format("{}: is not a JPEG or PNG image", file.string()));
    return *size;
  }

  RecordedLens read_lens(const std::string& which, const ImageSize& size) {
    const fs::path intrinsics = folder_ / "intrinsic" / ("intrinsic_" + which + ".txt");
    const fs::path extrinsics = folder_ / "intrinsic" / ("extrinsic_" + which + ".txt");
    if (!is_there(extrinsics))
      notes_.push_back(fmt::format("{}: is missing: the {} camera is taken as the device's origin",
                                   extrinsics.string(), which));
    const Eigen::Matrix4d placed =
        is_there(extrinsics) ? read_matrix(extrinsics) : Eigen::Matrix4d::Identity();
    if (!pose_of(placed, extrinsics.string()))
      throw InputError(fmt::format("{}: a number is not finite", extrinsics.string()));
    return lens_of(read_matrix(intrinsics), placed, static_cast<int>(size.width),
                   static_cast<int>(size.height), intrinsics.string());
  }

  /// @param what  statement about these files: "images have no partner in depth/"
  template <class Predicate>
  void note_alone(const char* which, const std::vector<std::uint32_t>& numbers,
                  const Predicate& is_alone, const char* what) {
    const auto first = std::ranges::find_if(numbers, is_alone);
    if (first != numbers.end())
      notes_.push_back(fmt::format("{}: {} of {} {} (the first is {})", (folder_ / which).string(),
                                   std::ranges::count_if(numbers, is_alone), numbers.size(), what,
                                   *first));
  }

  /// Adds notes about files without counterparts, as a damaged download leaves them.
  void note_files_alone() {
    const auto without = [](const NumberedFiles& others) {
      return [&](std::uint32_t number) { return !others.contains(number); };
    };
    note_alone("color", color_.numbers(), without(depth_),
               "images have no partner in depth/ and are left out");
    note_alone("depth", depth_.numbers(), without(color_),
               "images have no partner in color/ and are left out");
    if (!is_folder(folder_ / "pose")) return;
    const auto without_image = [&](std::uint32_t number) {
      return !color_.contains(number) && !depth_.contains(number);
    };
    note_alone("pose", NumberedFiles(folder_ / "pose", {".txt"}).numbers(), without_image,
               "poses belong to no image");
  }

  std::optional<SE3> read_pose(std::uint32_t number) {
    const fs::path file = folder_ / "pose" / fmt::format("{}.txt", number);
    if (is_there(file)) return pose_of(read_matrix(file), file.string());
    const fs::path padded = folder_ / "pose" / fmt::format("{:06}.txt", number);
    if (!is_there(padded)) {
      ++missing_poses_;
      return std::nullopt;
    }
    return pose_of(read_matrix(padded), padded.string());
  }

  template <class Pixel>
  static void check_size(const Grid2d<Pixel>& image, const RecordedLens& lens,
                         const fs::path& file) {
    if (image.width() != lens.width_px || image.height() != lens.height_px)
      throw InputError(fmt::format("{}: is {} x {}, the first image is {} x {}", file.string(),
                                   image.width(), image.height(), lens.width_px, lens.height_px));
  }

  fs::path folder_;
  NumberedFiles color_, depth_;
  std::vector<std::uint32_t> numbers_;
  RecordingInfo info_;
  std::vector<std::optional<SE3>> poses_;
  std::size_t missing_poses_ = 0;
};

/// The .sens files of a folder.
std::vector<fs::path> sens_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const std::string& name : list_folder(folder, "*.sens")) files.push_back(folder / name);
  return files;
}

}  // namespace

Eigen::Matrix4d parse_matrix(const std::string& text, const std::string& what) {
  std::istringstream words(text);
  Eigen::Matrix4d matrix;
  std::string word;
  for (int i = 0; i < 16; ++i) {
    if (!(words >> word))
      throw InputError(fmt::format("{}: holds {} numbers, 16 are needed", what, i));
    const auto value = number_in(word);
    if (!value)
      throw InputError(
          fmt::format("{}: number {}: '{}' is not a number", what, i + 1, word.substr(0, 40)));
    matrix(i / 4, i % 4) = *value;
  }
  if (words >> word) throw InputError(fmt::format("{}: holds more than 16 numbers", what));
  return matrix;
}

RecordedLens lens_of(const Eigen::Matrix4d& intrinsics, const Eigen::Matrix4d& extrinsics,
                     int width_px, int height_px, const std::string& what) {
  const RecordedLens lens{
      width_px,         height_px, intrinsics(0, 0), intrinsics(1, 1), intrinsics(0, 2),
      intrinsics(1, 2), {}};
  const bool good = intrinsics.topLeftCorner<3, 3>().allFinite() && lens.fx_px > 0 &&
                    lens.fy_px > 0 && lens.fx_px < 1e6 && lens.fy_px < 1e6 && lens.cx_px >= 0 &&
                    lens.cy_px >= 0 && lens.cx_px <= width_px - 1 && lens.cy_px <= height_px - 1;
  if (!good)
    throw InputError(
        fmt::format("{}: fx {} fy {} cx {} cy {} are not intrinsics of an image of {} x {}", what,
                    lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px, width_px, height_px));
  for (const auto& [row, column] : {std::pair{0, 1}, {1, 0}, {2, 0}, {2, 1}})
    if (std::abs(intrinsics(row, column)) > 1e-6)
      throw InputError(fmt::format(
          "{}: row {}, column {} of the intrinsics is {}, but a pinhole camera has 0 there", what,
          row + 1, column + 1, intrinsics(row, column)));
  const auto placed = pose_of(extrinsics, what);
  if (!placed) throw InputError(fmt::format("{}: the extrinsics are not finite", what));
  RecordedLens result = lens;
  result.device_from_camera = *placed;
  return result;
}

std::optional<SE3> Recording::pose_or_none(const std::function<std::optional<SE3>()>& read) {
  try {
    return read();
  } catch (const InputError& error) {
    if (faulty_poses_++ == 0) first_faulty_pose_ = error.what();
    return std::nullopt;
  }
}

void Recording::note_faulty_poses() {
  if (faulty_poses_ > 0)
    notes_.push_back(fmt::format("{}; {} without truth", first_faulty_pose_,
                                 counted(faulty_poses_, "such frame is", "such frames are")));
}

bool is_rotation(const Eigen::Matrix3d& matrix) {
  // Files have six decimals or floats. Within this tolerance, the matrix is so close to a rotation
  // that the error of the quaternion is negligible.
  constexpr double kTolerance = 1e-2;
  const Eigen::Matrix3d square = matrix * matrix.transpose();
  return square.isIdentity(kTolerance) && matrix.determinant() > 0;
}

std::optional<SE3> pose_of(const Eigen::Matrix4d& matrix, const std::string& what) {
  if (!matrix.allFinite()) return std::nullopt;
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (!is_rotation(rotation))
    throw InputError(fmt::format("{}: the upper left 3 x 3 of a pose is not a rotation", what));
  if (!(matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).isZero(1e-6))
    throw InputError(fmt::format("{}: the last row of a pose is not 0 0 0 1", what));
  if (const double far_m = matrix.topRightCorner<3, 1>().cwiseAbs().maxCoeff();
      far_m > kFarthestPose_m)
    throw InputError(fmt::format("{}: a pose lies {:g} m from the origin", what, far_m));
  return SE3(Eigen::Quaterniond(rotation), matrix.topRightCorner<3, 1>());
}

Eigen::Matrix4d intrinsics_of(const RecordedLens& lens) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(0, 0) = lens.fx_px;
  matrix(1, 1) = lens.fy_px;
  matrix(0, 2) = lens.cx_px;
  matrix(1, 2) = lens.cy_px;
  return matrix;
}

Eigen::Matrix4d matrix_of(const SE3& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation();
  matrix.topRightCorner<3, 1>() = pose.translation();
  return matrix;
}

std::unique_ptr<Recording> open_recording(const fs::path& path) {
  if (!is_there(path))
    throw InputError(fmt::format("{}: cannot be read: no such file", path.string()));
  if (!is_folder(path)) return open_sens(path);
  if (is_folder(path / "color")) return std::make_unique<ExtractedFolder>(path);
  const std::vector<fs::path> files = sens_files(path);
  if (files.empty())
    throw InputError(
        fmt::format("{}: holds neither color/ nor a .sens file: it is not a ScanNet "
                    "recording",
                    path.string()));
  if (files.size() > 1)
    throw InputError(
        fmt::format("{}: holds {} .sens files: name one", path.string(), files.size()));
  return open_sens(files[0]);
}

}  // namespace mh
