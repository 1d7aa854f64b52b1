// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "slam/core/camera.hpp"
#include "slam/features/features.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// What a vocabulary is trained on: pictures of generated rooms that no evaluation uses.
struct VocabularyTraining {
  int rooms = 40;          ///< training rooms, each from its own seed, >= 1
  int views = 15;          ///< pictures per room, >= 1
  std::uint64_t seed = 1;  ///< of rooms, views and tree; another seed, another vocabulary
  int light_samples =
      16;           ///< rays per vertex when light is baked, >= 1: corners need no fine light
  int threads = 2;  ///< rooms side by side; never changes a bit of the result
  Camera camera;    ///< size and field of view of the pictures
  FeatureConfig features;
  Vocabulary::TrainConfig tree;  ///< its seed is not used: `seed` decides
};

/// Renders views of training rooms, extracts features and trains. Deterministic.
/// @param progress  if given, is called after each room, one call at a time, with the rooms done so
///                  far and their total.
/// @throws InputError naming a setting out of range.
Vocabulary train_vocabulary(const VocabularyTraining& config,
                            const std::function<void(int done, int total)>& progress = {});

}  // namespace mh
