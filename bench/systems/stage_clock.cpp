// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/stage_clock.hpp"

namespace mh {

void StageClock::charge_open_stage(Clock::time_point now) {
  if (!open_.empty())
    current_[static_cast<std::size_t>(open_.back())] +=
        std::chrono::duration<double, std::milli>(now - since_).count();
  since_ = now;
}

void StageClock::operator()(Stage stage, StageEvent event) {
  charge_open_stage(Clock::now());
  if (event == StageEvent::kBegin)
    open_.push_back(stage);
  else
    open_.pop_back();
}

void StageClock::end_frame() {
  frames_.push_back(current_);
  current_ = {};
}

std::vector<double> StageClock::times_ms(Stage stage) const {
  std::vector<double> times;
  for (const Times& frame : frames_)
    if (const double ms = frame[static_cast<std::size_t>(stage)]; ms > 0) times.push_back(ms);
  return times;
}

}  // namespace mh
