// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// The file in which an output folder lists the commands that wrote there.
inline constexpr const char* kOutputMark = ".modelhouse";

/// Creates a folder (and its parents) and verifies that files can be written to it.
/// @throws InputError naming the folder.
void make_output_folder(const std::filesystem::path& folder);

/// Calls `write` with a temporary path next to `file`, then renames it into place: readers see
/// either the old file or the complete new one. The temporary is removed on any failure, and has
/// the same extension as `file` (image writers choose the format by it).
/// @throws InputError if it cannot be written; MachineError if the disk is full.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);
void write_atomically(const std::filesystem::path& file, std::string_view content);

// Readers of scenes, robots, levels and the like access the file system only through these
// functions (and map_file, YamlReader): a ReadScope (slam/io/read_record.hpp) records what they
// saw, and result keys depend on that record.

/// Returns the whole content of a file. @throws InputError naming it.
std::string read_file(const std::filesystem::path& file);

/// Whether the path names a file (or a link to one), a folder, or anything at all.
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);
bool is_there(const std::filesystem::path& path);

/// Turns "room/" into "room", so that the path has a last component.
std::filesystem::path without_trailing_slash(std::filesystem::path path);

/// Returns the names in a folder that match a pattern (* ? [...], as in a shell), sorted; empty if
/// the folder does not exist.
std::vector<std::string> list_folder(const std::filesystem::path& folder,
                                     const std::string& pattern);

}  // namespace mh
