// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "slam/core/labels.hpp"

namespace mh {

/// What the ids of somebody else's label images mean: the class of id i; void where it is not told.
using ClassMap = std::vector<ClassId>;

/// Reads a class map: YAML of lines `id: class`, ids from 0 to 65535, or a ScanNet label table
/// (.tsv). @throws InputError naming file and line.
ClassMap load_class_map(const std::filesystem::path& file);

}  // namespace mh
