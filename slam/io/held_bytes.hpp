// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace mh {

/// Immutable bytes together with their owner. Copies share them.
struct HeldBytes {
  std::shared_ptr<const void> owner;
  std::string_view view;  ///< starts at a multiple of 16
};

HeldBytes hold(std::string bytes);

/// When the pages of a mapped file are read.
enum class MapPages { kAtOnce, kAsTouched };

/// Maps a file read-only into memory; the pages are shared with other processes. If a file is
/// truncated while it is mapped, the process ends: see end_at_lost_pages(). @throws InputError
/// naming the file: missing, a folder, no permission.
HeldBytes map_file(const std::filesystem::path& file, MapPages pages = MapPages::kAtOnce);

/// From now on, if a mapped file was truncated and a page beyond its end is touched, the process
/// ends with a line that names the file.
/// @param code  exit code
void end_at_lost_pages(std::string_view error_mark, int code);

}  // namespace mh
