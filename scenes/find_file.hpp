// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace mh {

/// A file or folder that is there, whatever the case of the letters of its name below the folders
/// that are there as written; of several, the first in order.
std::optional<std::filesystem::path> find_any_case(const std::filesystem::path& path);

}  // namespace mh
