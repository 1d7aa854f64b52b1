// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/suite/input_digest.hpp"

namespace mh {

/// Reported facts about a path. A value is NaN if it is unknown because the path was cut or
/// recorded.
struct PathFacts {
  std::size_t frames = 0;
  std::size_t true_poses = 0;  ///< frames whose true pose is known
  double length_m = 0, turned_in_place_rad = 0, contact_time_s = 0, max_penetration_m = 0;
};

template <MaybeConst<PathFacts> P, class Visit>
void fields(P& path, Visit& v) {
  auto& [frames, true_poses, length_m, turned_in_place_rad, contact_time_s, max_penetration_m] =
      path;
  v("frames", frames);
  v("true_poses", true_poses);
  v("length_m", length_m);
  v("turned_in_place_rad", turned_in_place_rad);
  v("contact_time_s", contact_time_s);
  v("max_penetration_m", max_penetration_m);
}

/// Graded queries in one pair of bins, given by their indices.
struct GradedCell {
  std::size_t distance = 0, angle = 0;
  std::size_t asked = 0;   ///< poses used as queries, each at every speed
  std::size_t hidden = 0;  ///< drawn, not used: mapped frames show too little of their view
};

template <MaybeConst<GradedCell> C, class Visit>
void fields(C& cell, Visit& v) {
  auto& [distance, angle, asked, hidden] = cell;
  v("distance", distance);
  v("angle", angle);
  v("asked", asked);
  v("hidden", hidden);
}

/// What a run records about its place, so that its results can be read without the world.
struct PlaceFacts {
  std::string scene, robot;  ///< their names
  std::uint64_t scene_digest = 0, path_digest = 0, vocabulary_digest = 0;
  std::size_t vocabulary_words = 0;
  PathFacts mapping;
  std::optional<PathFacts> query_tour;
  std::vector<GradedCell> graded = {};  ///< empty: no graded queries
  bool cut = false;                     ///< the tours were cut after RunSpec::max_frames
  /// A line about each part of its recordings that could not be used or was repaired, without the
  /// recording's path.
  std::vector<std::string> notes = {};
  std::vector<InputDigest> inputs;
};

template <MaybeConst<PlaceFacts> P, class Visit>
void fields(P& place, Visit& v) {
  auto& [scene, robot, scene_digest, path_digest, vocabulary_digest, vocabulary_words, mapping,
         query_tour, graded, cut, notes, inputs] = place;
  v("scene", scene);
  v("robot", robot);
  v("scene_digest", as_digest(scene_digest));
  v("path_digest", as_digest(path_digest));
  v("vocabulary_digest", as_digest(vocabulary_digest));
  v("vocabulary_words", vocabulary_words);
  v("mapping_tour", mapping);
  v("query_tour", query_tour);
  v("graded", graded);
  v("cut", cut);
  v("notes", notes);
  v("inputs", inputs);
}

}  // namespace mh
