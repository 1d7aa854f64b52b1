// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mh {

/// The files of a recording: the path itself, the only file of that kind in a folder, or the parts
/// that a recorder split one into, in their order: those that ROS 2's metadata.yaml lists, or files
/// whose names differ in the number at the end alone, from 0 on (NAME_0.bag, NAME_1.bag), and in
/// the time that ROS 1's recorder writes into NAME.
/// @param pattern  "*.bag"
/// @param notes    receives a line if there are several
/// @throws InputError if a folder holds none, or several that are not parts of one recording.
std::vector<std::filesystem::path> parts_at(const std::filesystem::path& path, const char* pattern,
                                            std::vector<std::string>& notes);

}  // namespace mh
