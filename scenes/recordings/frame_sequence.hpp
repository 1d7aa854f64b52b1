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
  std::optional<ClassMap> classes;  ///< of its label images; absent: the ids are our classes
  std::optional<Trajectory> truth;
  std::optional<DepthCamera> depth_camera;  ///< absent: depth is registered to color in the files
  std::vector<ImuReading> imu = {};
};

/// Adds a note if a calibration file states a depth scale that differs from the one in use.
void note_depth_scale(double depth_per_meter, const RecordingConfig& config,
                      std::vector<std::string>& notes);

/// The last step of opening a recording of image files: loads the class map, drops labels if they
/// are not wanted, and adds a note if the class map is unused or does not fit the ids.
OpenedRecording open_listed(ListedFrames listed, const RecordingConfig& config,
                            std::vector<std::string> notes = {});

/// Opens a folder in TUM's layout that was recorded by this camera.
/// @param notes  receives what was omitted, one line per item; may be null
/// @throws InputError naming file and line.
std::unique_ptr<Sequence> open_tum_folder(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          std::vector<std::string>* notes = nullptr);

/// TUM's layout. The calibration is the specified one, or otherwise camera.yaml, camera_info.yaml
/// or ETH3D's calibration.txt in the folder.
extern const SequenceReader kTumReader;

/// A sequence of frames in memory.
std::unique_ptr<Sequence> frames_in_memory(const Camera& camera, std::vector<RgbdFrame> frames);

}  // namespace mh
