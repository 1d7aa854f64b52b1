// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/report/pages/source.hpp"

namespace mh {

/// What the overview shows of a place: for the first environment that has plans, the plan that
/// `bench` drew for the first trial of each system (PNG in base64); without plans, the paths and
/// queries of one run. Frames of a recording are included, too (frames_json()). Null if there is
/// nothing to show.
nlohmann::ordered_json place_images_json(const PagesSource& source);

/// Some frames of a suite's first recording, evenly spaced, as small JPEGs. If the recording is not
/// available, the reason instead. Null if the suite has no recording.
nlohmann::ordered_json frames_json(const PagesSource& source);

}  // namespace mh
