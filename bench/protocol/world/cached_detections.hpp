// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/suite/cache.hpp"
#include "slam/detect/detected_sequence.hpp"

namespace mh {

/// Caches what detectors found; its keys cover code, build and machine. Returns null for a cache
/// without a folder.
KeepDetections detections_in(const Cache& cache);

}  // namespace mh
