// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/tampered.hpp"

#include <utility>

namespace mh {
namespace {

class TamperedSystem : public System {
 public:
  TamperedSystem(std::unique_ptr<System> inner,
                 std::function<void(std::size_t, SystemReport&)> hand)
      : inner_(std::move(inner)), hand_(std::move(hand)) {}

  SystemReport track(const RgbdFrame& frame, RandomStream stream) override {
    SystemReport report = inner_->track(frame, stream);
    hand_(calls_++, report);
    return report;
  }
  void rewind() override { inner_->rewind(); }
  void reset() override { inner_->reset(); }
  void freeze() override { inner_->freeze(); }
  void finish() override { inner_->finish(); }
  void use_point(std::size_t point) override { inner_->use_point(point); }
  Trajectory trajectory() const override { return inner_->trajectory(); }
  std::unique_ptr<QueryMemo> make_memo() const override { return inner_->make_memo(); }
  std::unique_ptr<RelocalizationSession> open_session() const override {
    return inner_->open_session();
  }
  std::unique_ptr<RelocalizationSession> open_session_with(QueryMemo& memo) const override {
    return inner_->open_session_with(memo);
  }

 private:
  std::unique_ptr<System> inner_;
  std::function<void(std::size_t, SystemReport&)> hand_;
  std::size_t calls_ = 0;
};

}  // namespace

std::unique_ptr<System> make_tampered(std::unique_ptr<System> inner,
                                      std::function<void(std::size_t, SystemReport&)> hand) {
  return std::make_unique<TamperedSystem>(std::move(inner), std::move(hand));
}

}  // namespace mh
