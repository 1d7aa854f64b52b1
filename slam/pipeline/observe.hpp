// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include "slam/match/trace.hpp"

namespace mh {

/// The stages of a step. kWords happens within others, where words are first asked for.
enum class Stage {
  kFeatures,
  kWords,
  kTracking,  ///< motion model, reference keyframe
  kRelocalization,
  kLocalMap,
  kMapping,  ///< of a new keyframe
  kLoop,     ///< looking for a loop and closing it
  kCount
};
std::string_view name(Stage stage);

enum class StageEvent { kBegin, kEnd };

/// What the caller wants to be told while a step runs. Nothing of it reaches the algorithms: with
/// and without observers the results have the same bits.
struct StepObservers {
  std::function<void(Stage, StageEvent)> stage;  ///< e.g. a clock; begins and ends nest
  MatchTrace* matches = nullptr;                 ///< gets every pair that a matcher accepts
};

}  // namespace mh
