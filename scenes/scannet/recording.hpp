// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Quality of the color images that are written.
inline constexpr int kRecordedJpegQuality = 95;

/// One of a recording's two cameras: a pinhole, without distortion, pixel centers at integers.
struct RecordedLens {
  int width_px = 0, height_px = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  SE3 device_from_camera;  ///< ScanNet's extrinsics; its poses are those of the device
};

/// Properties shared by all frames of a recording.
struct RecordingInfo {
  std::string sensor;
  RecordedLens color, depth;
  double depth_per_meter = 1000;
};

/// One frame of a ScanNet recording. Depth is not registered to color.
struct RecordedMoment {
  Stamp stamp_ns = 0;  ///< of the color image
  Grid2d<Rgb8> color;
  Grid2d<std::uint16_t> depth;  ///< RecordingInfo::depth_per_meter units per m; 0 = no return
  std::optional<SE3> world_from_device;  ///< nullopt if the scan's tracking was lost
};

/// A ScanNet recording, frame by frame, as a .sens file or as a folder of images.
class Recording {
 public:
  virtual ~Recording() = default;
  virtual const RecordingInfo& info() const = 0;
  /// What could not be used or was repaired, one line per item.
  const std::vector<std::string>& notes() const { return notes_; }
  virtual std::size_t size() const = 0;
  virtual Stamp stamp_ns(std::size_t index) const = 0;
  /// The number that label images use for the frame: its index in the whole scan.
  virtual std::uint32_t number(std::size_t index) const = 0;
  /// nullopt for an invalid frame: ScanNet writes a pose of -inf.
  virtual std::optional<SE3> world_from_device(std::size_t index) const = 0;
  /// @throws InputError naming file and frame if its images cannot be read.
  virtual RecordedMoment frame(std::size_t index) const = 0;
  /// The files that frame() reads; empty if everything is in the opened file.
  virtual std::vector<std::filesystem::path> files() const { return {}; }
  /// The files with the color images: one per frame, or the opened file.
  virtual std::vector<std::filesystem::path> images() const = 0;

 protected:
  /// Returns what `read` returns; if it throws because the data is not a pose, counts the faulty
  /// pose and returns nullopt.
  std::optional<SE3> pose_or_none(const std::function<std::optional<SE3>()>& read);
  void note_faulty_poses();

  std::vector<std::string> notes_;

 private:
  std::size_t faulty_poses_ = 0;
  std::string first_faulty_pose_;
};

/// Opens a .sens file, a folder that contains one, or an extracted folder (color/ depth/ pose/
/// intrinsic/). Images are read on demand.
/// @throws InputError naming file and place.
std::unique_ptr<Recording> open_recording(const std::filesystem::path& path);

/// 16 numbers, row by row; they need not be finite. @throws InputError "what: ..." on other text.
Eigen::Matrix4d parse_matrix(const std::string& text, const std::string& what);
/// The lens with these 4x4 intrinsics and extrinsics. @throws InputError "what" on an invalid
/// matrix.
RecordedLens lens_of(const Eigen::Matrix4d& intrinsics, const Eigen::Matrix4d& extrinsics,
                     int width_px, int height_px, const std::string& what);
/// Whether a matrix is a rotation, within the precision of files with few decimals.
bool is_rotation(const Eigen::Matrix3d& matrix);
/// A rigid transform; nullopt if any number is not finite, ScanNet's mark of an invalid frame.
std::optional<SE3> pose_of(const Eigen::Matrix4d& matrix, const std::string& what);
Eigen::Matrix4d intrinsics_of(const RecordedLens& lens);
Eigen::Matrix4d matrix_of(const SE3& pose);

}  // namespace mh
