// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "scenes/recordings/class_map.hpp"
#include "scenes/recordings/file_checksums.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/sequence_writer.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// What is needed to read a recorded sequence.
struct RecordedCamera {
  Camera camera;
  double depth_per_meter = kDepthPerMeter;  ///< value of a depth pixel at one meter
  bool exchange_red_blue = false;           ///< the files' first channel is blue
  std::uint16_t no_depth = 0;  ///< value (in addition to 0) of depth pixels without depth
};

/// A pair of color and depth images of a recording.
struct RecordedFrame {
  Stamp stamp_ns = 0;                           ///< of the color image
  std::filesystem::path color, depth, classes;  ///< classes: empty if the recording has none
};

/// The list of pairs in a folder of TUM's or ETH3D's layout: associations.txt, associated.txt,
/// association.txt or associate.txt, all of which are in use; empty if the folder holds none.
std::filesystem::path associations_in(const std::filesystem::path& folder);

/// Reads a folder in TUM's layout: rgb.txt and depth.txt or, if one of them is missing,
/// associations.txt or associated.txt; and label.txt if present. Each color image is paired with
/// the nearest depth image within 0.02 s, as in TUM's own association, or with the depth image
/// listed next to it; color images without a depth image are omitted. Frames are in the order of
/// their stamps.
/// @param notes  receives a line with the number of omitted images, and a line if frames were
/// sorted; may be null
/// @throws InputError naming file and line.
std::vector<RecordedFrame> load_tum_folder(const std::filesystem::path& folder,
                                           std::vector<std::string>* notes = nullptr);

/// Reads the images of one frame.
/// @param classes  meaning of the ids in its label image; null: they are our classes, 8 bits
/// @throws InputError naming the image.
RgbdFrame read_frame(const RecordedFrame& frame, const RecordedCamera& camera,
                     const ClassMap* classes = nullptr);

/// Writes sequences in TUM's layout: rgb/ and depth/ (16 bit, 5000 per meter), label/ (class ids, 8
/// bit), their lists, associations.txt, camera.yaml and camera_info.yaml; with ground truth also
/// instance/ (16 bit), its list and groundtruth.txt. finish() writes the lists, so that a folder
/// without them is recognized as incomplete.
class TumWriter : public SequenceWriter {
 public:
  TumWriter(std::filesystem::path folder, const Camera& camera,
            PngCompression png_compression = {});
  /// Adds a frame with only what a SLAM system may see. label.txt lists the frames that have
  /// labels; odometry.txt holds the poses from odometry, imu.csv (EuRoC's columns) the readings of
  /// the inertial sensor, and lasers.txt the laser scans, if there are any.
  void add(const RgbdFrame& frame);
  void add(std::size_t index, const ExactFrame& frame) override;
  bool resume(std::size_t index, Stamp stamp_ns, const SE3& world_from_camera) override;
  void finish() override;

 private:
  std::filesystem::path file_of(const char* part, Stamp stamp_ns) const;
  /// The files of a frame with its truth.
  std::array<std::filesystem::path, 4> files_of(Stamp stamp_ns) const;
  void write(const char* part, Stamp stamp_ns, const cv::Mat& image);
  void add_images(const RgbdFrame& frame);
  void add_labels(Stamp stamp_ns, const Grid2d<ClassId>& classes);

  std::filesystem::path folder_;
  Camera camera_;
  std::vector<int> png_;
  FileChecksums checksums_;                        ///< of frames with their truth
  std::mutex mutex_;                               ///< guards the members below
  std::map<std::string, std::set<Stamp>> listed_;  ///< by part: stamps whose images exist
  std::map<Stamp, SE3> truth_, odometry_;
  std::map<Stamp, ImuReading> imu_;
  std::map<Stamp, std::vector<LaserScan>> lasers_;
};

}  // namespace mh
