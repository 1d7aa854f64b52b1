// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// An annotated object and its segments.
struct SegmentGroup {
  std::uint32_t object = 0;  ///< objectId, 0-based
  std::string category;      ///< raw category name, as annotators typed it
  std::string name;          ///< our own addition; empty in ScanNet's files
  std::vector<std::uint32_t> segments;
};

/// Reads *.segs.json: the segment of every vertex.
/// @throws InputError naming the file, if the JSON is damaged or has no segIndices.
std::vector<std::uint32_t> parse_segments(std::string_view json, const std::string& name);

/// Reads *.aggregation.json.
/// @throws InputError naming file and group: damaged JSON, an objectId shared by two groups.
std::vector<SegmentGroup> parse_aggregation(std::string_view json, const std::string& name);

/// The content of *.segs.json and of *.aggregation.json, for the scene with that id.
std::string segments_text(const std::vector<std::uint32_t>& segment_of_vertex,
                          const std::string& scene_id);
std::string aggregation_text(const std::vector<SegmentGroup>& groups, const std::string& scene_id);

}  // namespace mh
