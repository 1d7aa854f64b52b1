// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/provenance/input_digest.hpp"

namespace mh {

/// What is told of a driven path. NaN: unknown, since the path was cut.
struct PathFacts {
  std::size_t frames = 0;
  double length_m = 0, turned_in_place_rad = 0, contact_time_s = 0, max_penetration_m = 0;
};

/// What a run says of its surroundings, so that results need no world beside them.
struct PlaceFacts {
  std::string scene, robot;  ///< their names
  std::uint64_t scene_digest = 0, path_digest = 0, vocabulary_digest = 0;
  std::size_t vocabulary_words = 0;
  PathFacts mapping;
  std::optional<PathFacts> second;
  bool cut = false;  ///< the tours were cut after RunSpec::max_frames
  std::vector<InputDigest> inputs;
};

}  // namespace mh
