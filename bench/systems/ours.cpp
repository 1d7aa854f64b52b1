// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/ours.hpp"

#include <cassert>
#include <utility>

namespace mh {
namespace {

class OurSession : public RelocalizationSession {
 public:
  explicit OurSession(const SlamState& frozen) : frozen_(frozen) {}
  StepReport feed(const RgbdFrame& frame, RandomStream stream) override {
    return localize(frozen_, tracker_, frame, stream);
  }

 private:
  const SlamState& frozen_;  // outlived by the system that opened the session
  Tracker tracker_;
};

class OurSystem : public System {
 public:
  OurSystem(const Camera& camera, const SlamConfig& config,
            std::shared_ptr<const Vocabulary> vocabulary)
      : state_(make_slam(camera, config, std::move(vocabulary))) {}

  StepReport track(const RgbdFrame& frame, RandomStream stream) override {
    assert(!frozen_);
    return step(state_, frame, stream);
  }
  void rewind() override { mh::rewind(state_); }
  void reset() override { state_ = make_slam(state_.camera, state_.config, state_.vocabulary); }
  void freeze() override { frozen_ = true; }
  void set_query_settings(const SemanticConfig& settings) override {
    assert(frozen_);
    mh::set_query_settings(state_, settings);
  }
  Trajectory trajectory() const override { return mh::trajectory(state_); }
  std::unique_ptr<RelocalizationSession> open_session() const override {
    assert(frozen_);
    return std::make_unique<OurSession>(state_);
  }

 private:
  SlamState state_;
  bool frozen_ = false;
};

}  // namespace

std::unique_ptr<System> make_our_system(const Camera& camera, const SlamConfig& config,
                                        std::shared_ptr<const Vocabulary> vocabulary) {
  return std::make_unique<OurSystem>(camera, config, std::move(vocabulary));
}

}  // namespace mh
