// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/run.hpp"

namespace mh::cli {

/// Writes the results of a suite into its folder and prints them.
/// @throws MachineError naming the first failed run, after everything was written.
void finish(const std::filesystem::path& out, const Suite& suite, const BenchResults& results,
            bool json);

}  // namespace mh::cli
