// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>

#include "slam/match/trace.hpp"

namespace mh {

/// The stages of a step. kWords runs inside others, when words are first needed.
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

/// Optional callbacks during a step. They do not affect the algorithms: results are bit-identical
/// with and without observers.
struct StepObservers {
  std::function<void(Stage, StageEvent)> stage;  ///< e.g. a timer; stages nest
  MatchTrace* matches = nullptr;                 ///< receives every pair that a matcher accepts
  DecisionTrace* decisions = nullptr;  ///< receives the outcome of every pair: see DecisionTrace
};

}  // namespace mh
