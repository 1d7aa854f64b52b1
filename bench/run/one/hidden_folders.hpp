// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "bench/protocol/world/world.hpp"
#include "bench/suite/run_spec.hpp"

namespace mh {

/// The outside program of a run, with what is hidden from it: the bench's own folders, others that
/// modelhouse wrote near these or near the suite, those of other runs' programs, and the recording
/// or scene that its frames are made from, with its tours and the targets of its links.
/// @param of_bench  output folder and cache
OutsideProgram program_of(const RunSpec& spec, const World& world,
                          const std::vector<std::filesystem::path>& of_bench);

}  // namespace mh
