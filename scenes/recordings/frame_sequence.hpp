// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/recordings/class_map.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/registered_depth.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// A recording whose frames are image files, read when they are requested.
struct ListedFrames {
  RecordedCamera camera;
  std::vector<RecordedFrame> frames;
  std::optional<ClassMap> classes;  ///< of its label images; absent: they are our classes
  std::optional<Trajectory> truth;
  std::optional<DepthCamera> depth_camera;  ///< absent: depth is registered to color in the files
  std::vector<ImuReading> imu = {};
};

/// Notes a calibration file that states a depth scale other than the one that is used.
void note_depth_scale(double depth_per_meter, const RecordingConfig& config,
                      std::vector<std::string>& notes);

/// The last step of opening files of images: loads the class map, leaves labels out if they are not
/// wanted, and notes a class map that is not used or does not fit the ids.
OpenedRecording open_listed(ListedFrames listed, const RecordingConfig& config,
                            std::vector<std::string> notes = {});

/// Opens a folder in TUM's layout, recorded by that camera.
/// @param notes  receives what was omitted, one line each; may be null
/// @throws InputError naming file and line.
std::unique_ptr<Sequence> open_tum_folder(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          std::vector<std::string>* notes = nullptr);

/// TUM's layout. The calibration is the specified one, otherwise camera.yaml, camera_info.yaml
/// or ETH3D's calibration.txt in the folder.
extern const SequenceReader kTumReader;

/// A sequence of frames in memory.
std::unique_ptr<Sequence> frames_in_memory(const Camera& camera, std::vector<RgbdFrame> frames);

}  // namespace mh
