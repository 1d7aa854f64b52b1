// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "slam/pipeline/slam.hpp"
#include "tests/slam/pipeline/box_room.hpp"

namespace mh::testing_support {

inline constexpr int kTurnFrames = 240;
inline constexpr Stamp kFrame_ns = 33333333;

/// A vocabulary trained on the room itself, by default with several hundred words.
inline std::shared_ptr<const Vocabulary> box_room_vocabulary(int depth = 3) {
  std::vector<std::vector<Descriptor>> images;
  for (int i = 0; i < 12; ++i)
    images.push_back(extract(BoxRoom::render(BoxRoom::round_trip(20 * i + 5, kTurnFrames), 0),
                             BoxRoom::camera(), {.count = 500})
                         .descriptors);
  return std::make_shared<const Vocabulary>(
      Vocabulary::train(images, {.branching = 10, .depth = depth}));
}

/// The vocabulary of the default depth, trained once for all tests of a program.
inline std::shared_ptr<const Vocabulary> vocabulary() {
  static const auto trained = box_room_vocabulary();
  return trained;
}

inline SlamConfig box_room_settings(const SemanticConfig& semantics = {}) {
  SlamConfig config;
  config.features.count = 500;  // the images have a quarter of the usual size
  config.semantics = semantics;
  return config;
}

inline RgbdFrame box_room_frame(int i, bool labels = true) {
  return BoxRoom::render(BoxRoom::round_trip(i, kTurnFrames), i * kFrame_ns, labels);
}

}  // namespace mh::testing_support
