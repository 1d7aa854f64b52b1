// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "bench/suite/cache.hpp"

namespace mh::cli {

/// The cache that all commands share, or the one in a folder that the user names. Its keys cover
/// everything that decides an entry, so commands can use one another's entries.
inline Cache usual_cache(const std::string& folder = {}) {
  return Cache(folder.empty() ? Cache::default_folder() : std::filesystem::absolute(folder));
}

}  // namespace mh::cli
