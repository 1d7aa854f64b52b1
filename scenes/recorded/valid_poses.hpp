// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slam/core/trajectory.hpp"

namespace mh {

/// Reads true poses as TUM's text; lines that are no pose, or not after the one before, are left
/// out. @param notes  receives a line that counts them and names the first
/// @throws InputError if the file cannot be read.
Trajectory read_valid_poses(const std::filesystem::path& file, std::vector<std::string>& notes);

/// Notes that a folder, say, stands where a file of true poses would.
void note_no_file(const std::filesystem::path& truth, std::vector<std::string>& notes);

}  // namespace mh
