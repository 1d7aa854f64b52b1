// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scenes/recorded/tum_folder.hpp"
#include "slam/pipeline/settings.hpp"

namespace mh {

/// What settings tell of the camera and of its pictures.
RecordedCamera recorded_camera(const Settings& settings);

/// The camera of a settings file, our own or ORB-SLAM2's: see load_settings(). @throws InputError.
RecordedCamera load_recorded_camera(const std::filesystem::path& file);

}  // namespace mh
