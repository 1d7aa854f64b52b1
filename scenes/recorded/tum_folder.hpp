// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "scenes/recorded/class_map.hpp"
#include "scenes/recorded/frame_files.hpp"
#include "scenes/recorded/sequence_writer.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// What a recorded sequence needs to be read.
struct RecordedCamera {
  Camera camera;
  double depth_per_meter = kDepthPerMeter;  ///< value of a depth pixel one meter away
  bool exchange_red_blue = false;           ///< the files' first channel is blue
};

/// One moment of a recording: color and depth pictures that belong together.
struct RecordedFrame {
  Stamp stamp_ns = 0;                           ///< of the color picture
  std::filesystem::path color, depth, classes;  ///< classes: empty where the recording has none
};

/// Reads a folder in TUM's layout: rgb.txt and depth.txt, without them associations.txt, and
/// label.txt where it is there. Each color picture gets the nearest depth picture within 0.02 s,
/// as TUM's own association does, or the one beside which it is listed; one without is left out.
/// @param notes  gets a line with the number of those left out; may be null
/// @throws InputError naming file and line.
std::vector<RecordedFrame> load_tum_folder(const std::filesystem::path& folder,
                                           std::vector<std::string>* notes = nullptr);

/// Reads the pictures of one frame.
/// @param classes  what the ids of its label picture mean; null: they are our classes, 8 bits
/// @throws InputError naming the picture.
RgbdFrame read_frame(const RecordedFrame& frame, const RecordedCamera& camera,
                     const ClassMap* classes = nullptr);

/// Writes sequences in TUM's layout: rgb/ and depth/ (16 bit, 5000 per meter), label/ (class ids, 8
/// bit), their lists, associations.txt, camera.yaml and camera_info.yaml; with truth also instance/
/// (16 bit), its list and groundtruth.txt. The lists appear with finish(), so that a folder without
/// them was not finished.
class TumWriter : public SequenceWriter {
 public:
  TumWriter(std::filesystem::path folder, const Camera& camera,
            PngCompression png_compression = {});
  /// What a system may see and nothing else. label.txt lists the frames that have labels.
  void add(const RgbdFrame& frame);
  void add(std::size_t index, const ExactFrame& frame) override;
  bool resume(std::size_t index, Stamp stamp_ns, const SE3& world_from_camera) override;
  void finish() override;

 private:
  std::filesystem::path file_of(const char* part, Stamp stamp_ns) const;
  void write(const char* part, Stamp stamp_ns, const cv::Mat& picture);
  void add_pictures(const RgbdFrame& frame);
  void add_labels(Stamp stamp_ns, const Grid2d<ClassId>& classes);

  std::filesystem::path folder_;
  Camera camera_;
  std::vector<int> png_;
  std::mutex mutex_;                               ///< of what follows
  std::map<std::string, std::set<Stamp>> listed_;  ///< by part: whose pictures are there
  std::map<Stamp, SE3> truth_;
};

}  // namespace mh
