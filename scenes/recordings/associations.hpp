// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/recordings/tum_folder.hpp"

namespace mh {

/// Which image stands first in a line of associations.
enum class FirstImage { kColor, kDepth };

/// Reads a list of pairs, "stamp file stamp file" a line, with the color images' stamps; the files
/// are next to it. The order is that of the first pair that can be read: depth is gray, of 16 bits.
/// @param otherwise  the order if no pair can be read
/// @throws InputError naming list and line, also for lines that hold a pose.
std::vector<RecordedFrame> read_associations(const std::filesystem::path& list,
                                             FirstImage otherwise = FirstImage::kColor);

/// Sorts frames by stamp, those of one stamp as listed, if they are in no order: if a quarter or
/// more would have to be left out for the others to be. A clock that was wrong for a while is no
/// other order.
/// @param notes  receives a line if they were sorted; may be null
void sort_frames(std::vector<RecordedFrame>& frames, const std::filesystem::path& list,
                 std::vector<std::string>* notes);

}  // namespace mh
