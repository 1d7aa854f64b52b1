// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include "slam/pipeline/observe.hpp"

namespace mh {

/// A stopwatch for the stages of SLAM steps. It observes from outside, so that no algorithm needs a
/// clock. The time of a nested stage is not counted in the outer one.
class StageClock {
 public:
  using Times = std::array<double, static_cast<std::size_t>(Stage::kCount)>;  ///< ms by stage

  void operator()(Stage stage, StageEvent event);
  /// Ends a frame: stores its times; the next frame starts at zero.
  void end_frame();

  const std::vector<Times>& frames() const { return frames_; }
  /// Times of a stage over the frames in which it ran, ms.
  std::vector<double> times_ms(Stage stage) const;

 private:
  using Clock = std::chrono::steady_clock;
  void charge_open_stage(Clock::time_point now);

  Times current_{};
  std::vector<Times> frames_;
  std::vector<Stage> open_;  // innermost last
  Clock::time_point since_;
};

}  // namespace mh
