// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/timed.hpp"

#include <time.h>

#include <chrono>
#include <functional>
#include <utility>

#include "bench/protocol/query.hpp"

namespace mh {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class TimedSession : public RelocalizationSession {
 public:
  using Note = std::function<void(bool blank, double wall_ms, double processor_s)>;
  TimedSession(std::unique_ptr<RelocalizationSession> inner, Note note)
      : inner_(std::move(inner)), note_(std::move(note)) {}
  SystemReport feed(const RgbdFrame& frame, RandomStream stream) override {
    const bool blank = is_blank(frame);
    const auto start = Clock::now();
    const double processor_before_s = processor_time_s();
    SystemReport report = inner_->feed(frame, stream);
    note_(blank, ms_since(start), processor_time_s() - processor_before_s);
    return report;
  }

 private:
  std::unique_ptr<RelocalizationSession> inner_;
  Note note_;
};

}  // namespace

double processor_time_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

SystemReport TimedSystem::track(const RgbdFrame& frame, RandomStream stream) {
  const auto start = Clock::now();
  const ProcessorTimer timer(processor_s_);
  SystemReport report = SystemView::track(frame, stream);
  track_ms_.push_back(ms_since(start));
  return report;
}

void TimedSystem::rewind() {
  const ProcessorTimer timer(processor_s_);
  SystemView::rewind();
}

void TimedSystem::reset() {
  const ProcessorTimer timer(processor_s_);
  SystemView::reset();
}

void TimedSystem::freeze() {
  const ProcessorTimer timer(processor_s_);
  SystemView::freeze();
}

void TimedSystem::use_point(std::size_t point) {
  const ProcessorTimer timer(processor_s_);
  SystemView::use_point(point);
}

Trajectory TimedSystem::trajectory() const {
  const ProcessorTimer timer(processor_s_);
  return SystemView::trajectory();
}

std::unique_ptr<RelocalizationSession> TimedSystem::open_session() const {
  return timed(SystemView::open_session());
}

std::unique_ptr<RelocalizationSession> TimedSystem::open_session_with(QueryMemo& memo) const {
  return timed(SystemView::open_session_with(memo));
}

std::unique_ptr<RelocalizationSession> TimedSystem::timed(
    std::unique_ptr<RelocalizationSession> inner) const {
  return std::make_unique<TimedSession>(std::move(inner),
                                        [this](bool blank, double wall_ms, double processor_s) {
                                          const std::lock_guard lock(mutex_);
                                          (blank ? blank_ms_ : relocalize_ms_).push_back(wall_ms);
                                          relocalize_processor_s_ += processor_s;
                                        });
}

CallTimes TimedSystem::times() const {
  const std::lock_guard lock(mutex_);
  return {track_ms_, relocalize_ms_, blank_ms_, processor_s_ + relocalize_processor_s_};
}

}  // namespace mh
