// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "bench/protocol/call_times.hpp"
#include "bench/protocol/system.hpp"

namespace mh {

/// Processor time of this process so far, s, over all its threads.
double processor_time_s();

/// Adds the processor time spent during its lifetime to a sum.
class ProcessorTimer {
 public:
  explicit ProcessorTimer(double& sum_s) : sum_s_(sum_s), start_s_(processor_time_s()) {}
  ~ProcessorTimer() { sum_s_ += processor_time_s() - start_s_; }
  ProcessorTimer(const ProcessorTimer&) = delete;
  ProcessorTimer& operator=(const ProcessorTimer&) = delete;

 private:
  double& sum_s_;
  double start_s_;
};

/// A system whose calls are timed; its replies pass through unchanged.
class TimedSystem : public SystemView {
 public:
  using SystemView::SystemView;

  SystemReport track(const RgbdFrame& frame, RandomStream stream) override;
  void rewind() override;
  void reset() override;
  void freeze() override;
  void use_point(std::size_t point) override;
  Trajectory trajectory() const override;
  std::unique_ptr<RelocalizationSession> open_session() const override;
  std::unique_ptr<RelocalizationSession> open_session_with(QueryMemo& memo) const override;

  CallTimes times() const;

 private:
  std::unique_ptr<RelocalizationSession> timed(std::unique_ptr<RelocalizationSession> inner) const;

  mutable double processor_s_ = 0;
  std::vector<double> track_ms_;
  mutable std::mutex mutex_;  // sessions of one system may run concurrently
  mutable std::vector<double> relocalize_ms_, blank_ms_;
  mutable double relocalize_processor_s_ = 0;
};

}  // namespace mh
