// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "bench/protocol/mapping.hpp"
#include "slam/occupancy/occupancy.hpp"

namespace mh {

/// What mapping leaves behind: all that the queries and the results need of it.
struct FinishedMap {
  std::string system;  ///< System::save()
  MappingOutcome outcome;
  std::shared_ptr<const OccupancyMapper> volume;  ///< as RunResult::volume
};

/// As bytes and back. Of the volume each voxel's state stays (free, occupied, unknown), not its
/// probability.
std::string encode(const FinishedMap& map);
/// @param name  stands for the file in messages.
/// @throws InputError where the bytes are no finished map.
FinishedMap decode_finished_map(const std::string& bytes, const std::string& name);

}  // namespace mh
