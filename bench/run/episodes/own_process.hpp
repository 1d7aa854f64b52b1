// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "bench/run/episodes/run_episodes.hpp"

namespace mh {

/// Runs the episodes of one run in a process of this program, which stores them itself: what a
/// library does to its process ends no other run.
/// @param options  with `arguments`
/// @param share    receives the share of them that is done, in [0, 1]
/// @returns why they were not all run; empty if they were
/// @throws InputError as the process reported it.
std::string run_in_own_process(const RunSpec& spec, const EpisodeOptions& options,
                               const std::function<void(double)>& share);

}  // namespace mh
