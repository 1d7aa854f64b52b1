// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/suite/cache.hpp"
#include "slam/detect/detected_sequence.hpp"

namespace mh {

/// Keeps what detectors found in a cache, by code and machine as well; null for a cache without a
/// folder.
KeepDetections detections_in(const Cache& cache);

}  // namespace mh
