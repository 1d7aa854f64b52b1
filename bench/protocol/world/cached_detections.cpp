// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/cached_detections.hpp"

#include <fmt/format.h>

#include "bench/suite/code_version.hpp"
#include "bench/suite/fingerprint.hpp"
#include "slam/core/digest.hpp"

namespace mh {

KeepDetections detections_in(const Cache& cache) {
  if (cache.folder().empty()) return nullptr;
  const std::string made_by = fmt::format("{} {}", code_of_detections(), fingerprint_json().dump());
  return [cache, made_by](const std::string& key, const std::function<std::string()>& make) {
    return cache.get("detections", text_key(fmt::format("{} {}", made_by, key)), make);
  };
}

}  // namespace mh
