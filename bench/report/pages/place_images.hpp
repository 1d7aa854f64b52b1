// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/report/pages/source.hpp"

namespace mh {

/// What the overview shows of a place: the plan of the first environment that has one, as `bench`
/// drew it for the first trial of each system (PNG in base64); else one run's paths and queries.
/// Frames of a recording are shown next to it. Null if no run has anything to show.
nlohmann::ordered_json place_images_json(const PagesSource& source);

/// Some frames of a suite's first recording, evenly spaced, as small JPEGs, or why there are none
/// if it is not available. Null if the suite has no recording.
nlohmann::ordered_json frames_json(const PagesSource& source);

}  // namespace mh
