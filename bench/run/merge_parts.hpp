// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "bench/suite/suite.hpp"

namespace mh {

/// The results files to merge: first the one in `out`, if it exists, then those of the parts.
/// @throws InputError if a part has none, or as Store::check_mergeable() does; nothing is written.
std::vector<std::filesystem::path> mergeable_results(
    const std::filesystem::path& out, const std::vector<std::filesystem::path>& parts);

/// Copies from a suite's parts the results, run folders and images that are missing in `out`.
/// @param say  receives a line about each part that adds nothing
/// @pre mergeable_results() passed
void merge_parts(const std::filesystem::path& out, const std::vector<std::filesystem::path>& parts,
                 const std::function<void(std::string_view)>& say);

}  // namespace mh
