// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "scenes/scannet/recording.hpp"
#include "slam/io/held_bytes.hpp"

namespace mh {

/// Opens a .sens file of version 4: color raw, PNG or JPEG; depth raw or zlib, 16 bits. Only the
/// frames' headers are read immediately; images are read on demand.
/// @throws InputError naming file and place: another version, sizes that exceed the file.
std::unique_ptr<Recording> open_sens(const std::filesystem::path& file);
/// Opens a .sens file in memory; `name` names the file in messages.
std::unique_ptr<Recording> open_sens(HeldBytes bytes, const std::string& name);

/// Writes a .sens file of version 4: color as JPEG, depth with zlib, poses of -inf for invalid
/// frames, stamps in microseconds, no inertial measurements. Keeps one frame in memory at a time.
/// @param frame_at  called once per index, in order; images must have the cameras' sizes
/// @throws InputError if it cannot be written.
void save_sens(const std::filesystem::path& file, const RecordingInfo& info, std::size_t frames,
               const std::function<RecordedMoment(std::size_t index)>& frame_at);

}  // namespace mh
