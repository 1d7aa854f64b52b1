// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mh {

/// The files of a recording: the path itself, the only matching file in a folder, or the parts into
/// which a recorder split a recording, in order. The parts are the files that ROS 2's metadata.yaml
/// lists, or files whose names differ only in the number at the end, from 0 on (NAME_0.bag,
/// NAME_1.bag), and in the time that ROS 1's recorder writes into NAME.
/// @param pattern  "*.bag"
/// @param notes    receives a line if there are several files
/// @throws InputError if a folder holds no such file, or several that are not parts of one
/// recording.
std::vector<std::filesystem::path> parts_at(const std::filesystem::path& path, const char* pattern,
                                            std::vector<std::string>& notes);

}  // namespace mh
