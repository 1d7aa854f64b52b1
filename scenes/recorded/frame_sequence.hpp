// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "scenes/recorded/open_sequence.hpp"
#include "scenes/recorded/tum_folder.hpp"
#include "slam/core/sequence.hpp"

namespace mh {

/// A folder in TUM's layout, seen by that camera.
/// @param notes  gets what was left out, a line each; may be null
/// @throws InputError naming file and line.
std::unique_ptr<Sequence> open_tum_folder(const std::filesystem::path& folder,
                                          const RecordedCamera& camera,
                                          std::vector<std::string>* notes = nullptr);

/// TUM's layout. The calibration is the one named, else camera.yaml, else camera_info.yaml in the
/// folder.
extern const SequenceReader kTumReader;

/// Frames that lie in memory.
std::unique_ptr<Sequence> frames_in_memory(const Camera& camera, std::vector<RgbdFrame> frames);

}  // namespace mh
