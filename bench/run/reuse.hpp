// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/run/plan_runs.hpp"
#include "bench/store/store.hpp"

namespace mh {

struct Reuse {
  bool failures = true;  ///< a failed run counts as finished
  bool files = true;     ///< the files of runs count, too
};

/// Whether the result of a run is reused instead of making it again: it is in the store, and the
/// folder of its name holds the files of no other run. The one place where this is decided.
/// @param out  holds the folders of runs
bool is_reused(const Store& store, const Job& job, const std::filesystem::path& out,
               const Reuse& reuse = {});

}  // namespace mh
