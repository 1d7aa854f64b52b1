// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/recordings/tum_folder.hpp"

namespace mh {

/// Which image comes first in a line of associations.
enum class FirstImage { kColor, kDepth };

/// Reads a list of pairs, "stamp file stamp file" per line. Frames get the color images' stamps;
/// paths are relative to the list's folder. The first readable pair sets the order: its 16-bit gray
/// image is the depth.
/// @param otherwise  the order if no pair can be read
/// @throws InputError naming list and line, also for lines that hold a pose.
std::vector<RecordedFrame> read_associations(const std::filesystem::path& list,
                                             FirstImage otherwise = FirstImage::kColor);

/// Sorts frames by stamp (equal stamps as listed) if they are unordered, which means that a quarter
/// or more of them would have to be dropped for the rest to be in order. Frames do not count as
/// unordered just because the clock was wrong for a while.
/// @param notes  receives a line if they were sorted; may be null
void sort_frames(std::vector<RecordedFrame>& frames, const std::filesystem::path& list,
                 std::vector<std::string>* notes);

}  // namespace mh
