// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "bench/plan/environment.hpp"
#include "scenes/recorded/open_sequence.hpp"
#include "slam/pipeline/settings.hpp"

namespace mh {

/// What settings tell of the camera and of its images.
RecordedCamera recorded_camera(const Settings& settings);

/// Reads a calibration for open_sequence(): the camera of a settings file.
/// @param read  gets all that the file says; may be null
/// @throws InputError, also where the file has no camera.
std::function<RecordedCamera(const std::filesystem::path&)> camera_reader(Settings* read = nullptr);

/// One of an environment's recordings, by its name.
/// @param labels  whether its frames come with them
/// @throws InputError naming file and place.
OpenedRecording open_recorded(const Environment& environment, const std::string& sequence,
                              bool labels = true);

/// The camera of a settings file, our own or ORB-SLAM2's: see load_settings(). @throws InputError.
RecordedCamera load_recorded_camera(const std::filesystem::path& file);

}  // namespace mh
