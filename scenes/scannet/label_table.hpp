// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "slam/core/labels.hpp"

namespace mh {

/// ScanNet's release. In v1 the vertex property `label` of a mesh is the raw category id of the
/// label table, in v2 it is the NYU40 id.
enum class ScannetRelease { kV1, kV2 };

/// A label table: scannetv2-labels.combined.tsv, or v1's scannet-labels.combined.tsv.
struct LabelTable {
  std::string file;  ///< for messages
  ScannetRelease release = ScannetRelease::kV2;
  std::map<std::string, ClassId, std::less<>> class_of_category;  ///< by raw category name
  std::map<std::uint32_t, ClassId> class_of_id;                   ///< by raw category id
};

/// Reads a label table; its columns identify the release: `raw_category` and `id` (v2), or
/// `category` and `index` (v1); without ids, rows count from 1. The class is that of `nyu40id` or,
/// if missing, of `nyu40class`; if that is otherfurniture or the like, a category that names one of
/// our classes ("microwave") takes precedence. Our own tables have an additional column
/// `modelhouse`, which names the class that NYU40 merges into otherfurniture or otherprop. A row
/// without any of these is void.
/// @throws InputError naming file and line.
LabelTable parse_label_table(std::string_view text, const std::string& name);
LabelTable load_label_table(const std::filesystem::path& file);

/// Our classes as a label table of release v2, with one row per class: its id, its name, its NYU40
/// id and name.
std::string label_table_text();

}  // namespace mh
