// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "bench/protocol/run_result.hpp"
#include "bench/protocol/system.hpp"
#include "bench/protocol/world/world.hpp"
#include "bench/run/one/watched_frames.hpp"

namespace mh {

/// Whether the system is shown the labels that the frames have.
bool shows_labels(const RunSpec& spec);

/// How many queries are asked under each parameter point, over all sets.
std::size_t count_queries(const RunSpec& spec, const World& world);

/// Queries a frozen system with each set of queries under each parameter point, and adds the scored
/// answers to run.points.
/// @param run   has the mapping and its trajectory; receives the answers
/// @param done  called after each query under each point
void ask_queries(const RunSpec& spec, const World& world, System& frozen, const FilesAsKeyed& files,
                 RunResult& run, const std::function<void()>& done);

}  // namespace mh
