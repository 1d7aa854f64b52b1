// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mh {

/// An annotated object: which segments it is made of.
struct SegmentGroup {
  std::uint32_t object = 0;  ///< objectId, counted from 0
  std::string category;      ///< raw category name, as people typed it
  std::string name;          ///< our own addition; empty in ScanNet's files
  std::vector<std::uint32_t> segments;
};

/// Reads *.segs.json: the segment of every vertex.
/// @throws InputError naming the file, where the JSON is damaged or has no segIndices.
std::vector<std::uint32_t> parse_segments(std::string_view json, const std::string& name);

/// Reads *.aggregation.json.
/// @throws InputError naming file and group: damaged JSON, an objectId that two groups have.
std::vector<SegmentGroup> parse_aggregation(std::string_view json, const std::string& name);

/// The two files' content, for the scene of that id.
std::string segments_text(const std::vector<std::uint32_t>& segment_of_vertex,
                          const std::string& scene_id);
std::string aggregation_text(const std::vector<SegmentGroup>& groups, const std::string& scene_id);

}  // namespace mh
