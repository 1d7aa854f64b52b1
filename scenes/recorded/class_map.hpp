// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "slam/core/labels.hpp"

namespace mh {

/// Meaning of the ids of foreign label images: the class of id i; void if not listed.
using ClassMap = std::vector<ClassId>;

/// Reads a class map: YAML of lines `id: class`, ids from 0 to 65535, or a ScanNet label table
/// (.tsv). @throws InputError naming file and line.
ClassMap load_class_map(const std::filesystem::path& file);

}  // namespace mh
