// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/results/spread.hpp"
#include "bench/run/stress.hpp"

namespace mh {

/// Runs each system of a suite on each environment, unchanged and with changes that should not
/// matter: backward, with other draws, and with faults that every camera has.
/// @throws InputError if the suite has more than one level or kind of labels, or a run fails
std::vector<Spread> find_spread(const Suite& suite, const SuiteOverrides& overrides,
                                const StressOptions& options);

/// A suite of one recording and the plain system, for find_spread().
/// @param settings  its calibration; empty: beside its frames
Suite suite_of_recording(const std::string& recording, const std::string& settings);

}  // namespace mh
