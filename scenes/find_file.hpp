// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace mh {

/// Finds an existing file or folder, ignoring letter case below the deepest folder that exists as
/// written; if several match, takes the first by name.
std::optional<std::filesystem::path> find_any_case(const std::filesystem::path& path);

}  // namespace mh
