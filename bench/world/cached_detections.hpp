// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/cache/cache.hpp"
#include "slam/detect/detected_sequence.hpp"

namespace mh {

/// Keeps what detectors found in a cache; null for a cache without a folder.
inline KeepDetections detections_in(const Cache& cache) {
  if (cache.folder().empty()) return nullptr;
  return [cache](const std::string& key, const std::function<std::string()>& make) {
    return cache.get("detections", key, make);
  };
}

}  // namespace mh
