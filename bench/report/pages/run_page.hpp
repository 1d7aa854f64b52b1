// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "bench/report/pages/source.hpp"

namespace mh {

/// How many poses of a trajectory a run's page may hold, so that the pages of all runs fit into
/// `budget` bytes.
std::size_t moments_for(std::size_t runs, std::size_t budget);

/// What the page of one run shows in addition to the tables: the true and the estimated path in the
/// frame of the dock (positions in mm, quaternions in 1/10,000), thinned to about `moments` poses;
/// tracking by call; the occupancy grid; digests and settings. Unknown values are null.
nlohmann::ordered_json run_page_json(const PagesSource& source, const RunResult& run,
                                     std::size_t moments);

}  // namespace mh
