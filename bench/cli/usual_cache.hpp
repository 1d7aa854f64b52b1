// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bench/suite/cache.hpp"

namespace mh::cli {

/// The cache that all commands share, or a cache in a folder that the user names. Cache keys cover
/// everything that determines an entry, so commands can use one another's entries.
inline Cache usual_cache(const std::string& folder = {}) {
  return Cache(folder.empty() ? Cache::default_folder() : std::filesystem::absolute(folder));
}

/// The folder of that cache, for a command that has --no-cache; nullopt if nothing is to be kept.
inline std::optional<std::filesystem::path> cache_folder(const std::string& folder, bool none) {
  const std::filesystem::path used = none ? std::filesystem::path() : usual_cache(folder).folder();
  return used.empty() ? std::nullopt : std::optional(used);
}

}  // namespace mh::cli
