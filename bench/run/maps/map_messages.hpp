// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/run/maps/map_study.hpp"
#include "scenes/recordings/messages/message_writer.hpp"

namespace mh {

/// Writes a map for RViz and Foxglove, one message per topic, in frame `map`, at time 0: `/map`
/// (the grid), `/global_costmap/costmap` (its costs as Nav2 publishes them), `/objects` (a box and
/// a name for each object), `/voxels` (the occupied voxels in the colors of their classes).
/// @throws as the writer does
void write_map_messages(MessageWriter& file, const VoxelMap& map, const MapStudy& study);

/// Whether write_map_messages() made a file, so that it may be replaced.
bool holds_map_messages(const std::filesystem::path& file);

}  // namespace mh
