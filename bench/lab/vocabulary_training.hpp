// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/features/features.hpp"
#include "slam/vocabulary/vocabulary.hpp"

namespace mh {

/// What a vocabulary is trained on: images of generated rooms that no evaluation uses, or images
/// from a list of files.
struct VocabularyTraining {
  int rooms = 240;         ///< training rooms, each from its own seed, >= 1
  int views = 15;          ///< images per room, >= 1
  std::uint64_t seed = 1;  ///< of rooms, views, noise and tree; determines the vocabulary
  /// Rays per vertex when light is baked, >= 1: corners do not need fine light.
  int light_samples = 16;
  /// Standard deviation of the image noise, relative to full scale. Noise is added because words
  /// should describe what a real camera sees.
  double noise = 0.007;
  std::vector<std::filesystem::path> images;  ///< if not empty, used instead of rooms
  int threads = 2;  ///< rooms or images in parallel; never changes the result
  Camera camera;    ///< size and field of view of the rooms' images
  FeatureConfig features;
  Vocabulary::TrainConfig tree;  ///< its seed is ignored in favor of `seed`
};

/// Reads a list of images: a path per line, relative to the list's folder; '#' begins a comment.
/// @throws InputError naming list and line of a missing image; the list if it is empty.
std::vector<std::filesystem::path> load_image_list(const std::filesystem::path& list);

/// Renders views of training rooms, or reads images; extracts features and trains. Deterministic.
/// @param progress  if given, called after each room or image with the number that are done and the
/// total; never called by two threads at once
/// @throws InputError naming a setting out of range, or an image that cannot be read.
Vocabulary train_vocabulary(const VocabularyTraining& config,
                            const std::function<void(int done, int total)>& progress = {});

}  // namespace mh
