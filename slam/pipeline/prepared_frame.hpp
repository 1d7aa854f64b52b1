// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "slam/match/context.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {

/// Reports a stage to the observers: its begin on construction, its end on destruction.
class InStage {
 public:
  InStage(const StepObservers& observers, Stage stage) : observers_(observers), stage_(stage) {
    if (observers_.stage) observers_.stage(stage_, StageEvent::kBegin);
  }
  ~InStage() {
    if (observers_.stage) observers_.stage(stage_, StageEvent::kEnd);
  }
  InStage(const InStage&) = delete;
  InStage& operator=(const InStage&) = delete;

 private:
  const StepObservers& observers_;
  Stage stage_;
};

/// A frame's features, indexed. Words are computed only when a stage needs them.
struct PreparedFrame {
  Stamp stamp_ns;
  Features features;
  FeatureGrid grid;
  std::optional<WordIndex> words;
  std::optional<SE3> odom_from_camera = {};
  std::span<const ImuReading> imu = {};  ///< the caller owns them
};

/// extract(), reported as a stage.
Features observed_features(const RgbdFrame& frame, const SlamState& state,
                           const StepObservers& observers);

/// @param tracker  state after the previous frames; gives the camera's motion during a
///                 rolling-shutter readout
PreparedFrame prepare(Stamp stamp_ns, Features features, const SlamState& state,
                      const Tracker& tracker);

/// The frame with its words, which are computed on the first call.
Query with_words(PreparedFrame& frame, const SlamState& state, const StepObservers& observers);
/// The frame with the words that it has so far.
Query without_words(const PreparedFrame& frame);

}  // namespace mh
