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

/// Maps a file read-only into memory; the pages are shared with other processes. While mapped, the
/// file must only be replaced by renaming, never rewritten in place. @throws InputError naming the
/// file: missing, a folder, no permission.
HeldBytes map_file(const std::filesystem::path& file, MapPages pages = MapPages::kAtOnce);

}  // namespace mh
