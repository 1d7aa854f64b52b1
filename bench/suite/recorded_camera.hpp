// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "bench/suite/environment.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/files/settings_file.hpp"

namespace mh {

/// Returns what the settings specify about the camera and its images.
RecordedCamera recorded_camera(const Settings& settings);

/// Returns a calibration reader for open_sequence(): it reads the camera of a settings file.
/// @param read  receives all settings in the file; may be null
/// @throws InputError, also if the file has no camera.
std::function<RecordedCamera(const std::filesystem::path&)> camera_reader(Settings* read = nullptr);

/// Whether a settings file has a camera. @throws InputError if it is not a settings file.
bool settings_have_camera(const std::filesystem::path& file);

/// The value of a depth pixel at one meter, if the settings file states it. @throws InputError if
/// it is not a settings file.
std::optional<double> stated_depth_per_meter(const std::filesystem::path& file);

/// Returns the configuration, changed so that calibrations are read from settings files.
/// @param read  receives all settings in the file that has the camera; may be null
RecordingConfig with_settings(RecordingConfig config, Settings* read);

/// Opens one of an environment's recordings, by its name, and digests all of it.
/// @param labels  whether its frames have labels
/// @param read    receives the settings in its calibration; may be null
/// @throws InputError naming file and place.
OpenedRecording open_recorded(const Environment& environment, const std::string& sequence,
                              bool labels = true, Settings* read = nullptr);

/// Loads the camera of a settings file, our own or ORB-SLAM2's: see load_settings(). @throws
/// InputError.
RecordedCamera load_recorded_camera(const std::filesystem::path& file);

}  // namespace mh
