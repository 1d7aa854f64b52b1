// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/timed.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <utility>

namespace mh {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class TimedSession : public RelocalizationSession {
 public:
  TimedSession(std::unique_ptr<RelocalizationSession> inner, std::function<void(double)> note_ms)
      : inner_(std::move(inner)), note_ms_(std::move(note_ms)) {}
  StepReport feed(const RgbdFrame& frame, RandomStream stream) override {
    const auto start = Clock::now();
    StepReport report = inner_->feed(frame, stream);
    note_ms_(ms_since(start));
    return report;
  }

 private:
  std::unique_ptr<RelocalizationSession> inner_;
  std::function<void(double)> note_ms_;
};

}  // namespace

TimedSystem::TimedSystem(std::unique_ptr<System> inner) : inner_(std::move(inner)) {}

StepReport TimedSystem::track(const RgbdFrame& frame, RandomStream stream) {
  const auto start = Clock::now();
  StepReport report = inner_->track(frame, stream);
  track_ms_.push_back(ms_since(start));
  return report;
}

std::unique_ptr<RelocalizationSession> TimedSystem::open_session() const {
  return timed(inner_->open_session());
}

std::unique_ptr<RelocalizationSession> TimedSystem::open_session_with(QueryMemo& memo) const {
  return timed(inner_->open_session_with(memo));
}

std::unique_ptr<RelocalizationSession> TimedSystem::timed(
    std::unique_ptr<RelocalizationSession> inner) const {
  return std::make_unique<TimedSession>(std::move(inner), [this](double ms) {
    const std::lock_guard lock(mutex_);
    relocalize_ms_.push_back(ms);
  });
}

CallTimes TimedSystem::times() const {
  const std::lock_guard lock(mutex_);
  return {track_ms_, relocalize_ms_};
}

TimeSummary summarize(std::vector<double> times_ms) {
  if (times_ms.empty()) return {};
  std::sort(times_ms.begin(), times_ms.end());
  const auto at = [&](double share) {
    return times_ms[static_cast<std::size_t>(share * static_cast<double>(times_ms.size() - 1))];
  };
  return {at(0.5), at(0.95)};
}

}  // namespace mh
