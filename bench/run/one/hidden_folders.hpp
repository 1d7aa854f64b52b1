// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "bench/protocol/world/world.hpp"
#include "bench/suite/run_spec.hpp"

namespace mh {

/// The outside program of a run, with the list of what is hidden from it: the bench's own folders,
/// other folders that modelhouse wrote near them or near the suite, the folders of other runs'
/// programs, and the recording or scene that the frames are made from, tours and targets of links
/// included.
/// @param of_bench  the bench's output folder and cache
OutsideProgram program_of(const RunSpec& spec, const World& world,
                          const std::vector<std::filesystem::path>& of_bench);

}  // namespace mh
