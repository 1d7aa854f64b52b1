// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// Creates a folder (and its parents) and proves that files can be written into it.
/// @throws InputError naming the folder.
void make_output_folder(const std::filesystem::path& folder);

/// Calls `write` with a temporary path beside `file`, then renames it into place: readers see the
/// old file or the whole new one. The temporary is removed on any failure, and keeps the ending of
/// `file` (image writers choose the format by it). @throws InputError if it cannot be written;
/// MachineError if the disk is full.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);
void write_atomically(const std::filesystem::path& file, std::string_view content);

// Readers of scenes, robots, levels and the like see the file system through these four (and
// map_file, YamlReader) alone: a ReadScope (slam/core/read_record.hpp) notes what they saw, and the
// keys of results hold that.

/// Whole content of a file. @throws InputError naming it.
std::string read_file(const std::filesystem::path& file);

/// Whether there is a file (or a link to one), a folder, anything of that name.
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);
bool is_there(const std::filesystem::path& path);

/// The names in a folder that match a pattern (* ? [...], as a shell's), sorted; none where there
/// is no such folder.
std::vector<std::string> list_folder(const std::filesystem::path& folder,
                                     const std::string& pattern);

}  // namespace mh
