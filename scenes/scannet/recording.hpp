// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"
#include "slam/core/se3.hpp"

namespace mh {

/// Of the color pictures that are written.
inline constexpr int kRecordedJpegQuality = 95;

/// One of a recording's two cameras: a pinhole, without distortion, pixel centers at integers.
struct RecordedLens {
  int width_px = 0, height_px = 0;
  double fx_px = 0, fy_px = 0, cx_px = 0, cy_px = 0;
  SE3 device_from_camera;  ///< ScanNet's extrinsics; what its poses place is the device
};

/// What the frames of a recording have in common.
struct RecordingInfo {
  std::string sensor;
  RecordedLens color, depth;
  double depth_per_meter = 1000;
};

/// One moment of a ScanNet recording. Depth is not registered to color.
struct RecordedMoment {
  Stamp stamp_ns = 0;  ///< of the color picture
  Grid2d<Rgb8> color;
  Grid2d<std::uint16_t> depth;           ///< in RecordingInfo::depth_per_meter; 0 = no return
  std::optional<SE3> world_from_device;  ///< nullopt where the scan had lost its way
};

/// A ScanNet recording, frame by frame, as a .sens file or as a folder of pictures.
class Recording {
 public:
  virtual ~Recording() = default;
  virtual const RecordingInfo& info() const = 0;
  /// What could not be used or was mended, one line each.
  const std::vector<std::string>& notes() const { return notes_; }
  virtual std::size_t size() const = 0;
  virtual Stamp stamp_ns(std::size_t index) const = 0;
  /// The number by which label images name the frame: its place in the whole scan.
  virtual std::uint32_t number(std::size_t index) const = 0;
  /// nullopt marks an invalid frame: ScanNet writes a pose of -inf.
  virtual std::optional<SE3> world_from_device(std::size_t index) const = 0;
  /// @throws InputError naming file and frame if its pictures cannot be had.
  virtual RecordedMoment frame(std::size_t index) const = 0;
  /// The files that frame() reads; none where all is in the file that was opened.
  virtual std::vector<std::filesystem::path> files() const { return {}; }

 protected:
  std::vector<std::string> notes_;
};

/// Opens a .sens file, a folder that holds one, or an extracted folder (color/ depth/ pose/
/// intrinsic/). Pictures are read as they are asked for.
/// @throws InputError naming file and place.
std::unique_ptr<Recording> open_recording(const std::filesystem::path& path);

/// A camera's 4x4 intrinsics or a pose, row by row. @throws InputError "what" on a matrix that is
/// none.
RecordedLens lens_of(const Eigen::Matrix4d& intrinsics, const Eigen::Matrix4d& extrinsics,
                     int width_px, int height_px, const std::string& what);
/// Whether it is a rotation, as far as files with few decimals tell.
bool is_rotation(const Eigen::Matrix3d& matrix);
/// A rigid transform; nullopt if any number is not finite, ScanNet's mark of an invalid frame.
std::optional<SE3> pose_of(const Eigen::Matrix4d& matrix, const std::string& what);
Eigen::Matrix4d intrinsics_of(const RecordedLens& lens);
Eigen::Matrix4d matrix_of(const SE3& pose);

}  // namespace mh
