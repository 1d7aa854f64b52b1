// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "slam/core/grid2d.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Meaning of the ids of foreign label images: the class of id i; void if not listed.
using ClassMap = std::vector<ClassId>;

/// Reads a class map: YAML of lines `id: class`, ids from 0 to 65535, or a ScanNet label table
/// (.tsv). @throws InputError naming file and line.
ClassMap load_class_map(const std::filesystem::path& file);

/// Whether an image has ids other than 0, and none of them has a class.
bool knows_none(const Grid2d<std::uint16_t>& ids, const ClassMap& map);

/// A label image as exact distributions, one per class.
/// @param map  meaning of the ids; null: they are our classes
/// @throws InputError "class N is unknown" on an id beyond ours.
SemanticImage one_hot(const Grid2d<std::uint16_t>& ids, const ClassMap* map);

}  // namespace mh
