// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/trajectory.hpp"

namespace mh {

/// Reads the true poses of a recording; nullopt if no valid ones are left.
/// @param notes  receives what was left out (trajectory_io.hpp), or that there is no ground truth
/// @throws InputError if the file cannot be read or does not contain poses.
std::optional<Trajectory> read_truth(const std::filesystem::path& file,
                                     std::vector<std::string>& notes);

/// Adds a note if the path of the file of true poses is taken by something that is not a file, such
/// as a folder.
void note_no_file(const std::filesystem::path& truth, std::vector<std::string>& notes);

}  // namespace mh
