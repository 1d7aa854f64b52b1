// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "bench/protocol/mapping.hpp"
#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// What mapping leaves behind: everything that the queries and the results need from it.
struct FinishedMap {
  std::string system;  ///< System::save()
  MappingOutcome outcome;
  std::shared_ptr<const VoxelMap> volume;  ///< as in RunResult::volume
};

/// Converts to bytes and back, exactly.
std::string encode(const FinishedMap& map);
/// @param name  the file's name in messages
/// @throws InputError if the bytes are not a finished map.
FinishedMap decode_finished_map(const std::string& bytes, const std::string& name);

}  // namespace mh
