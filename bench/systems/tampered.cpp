// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/tampered.hpp"

#include <utility>

namespace mh {
namespace {

class TamperedSystem : public SystemView {
 public:
  TamperedSystem(std::unique_ptr<System> inner,
                 std::function<void(std::size_t, SystemReport&)> hand)
      : SystemView(std::move(inner)), hand_(std::move(hand)) {}

  SystemReport track(const RgbdFrame& frame, RandomStream stream) override {
    SystemReport report = SystemView::track(frame, stream);
    hand_(calls_++, report);
    return report;
  }

 private:
  std::function<void(std::size_t, SystemReport&)> hand_;
  std::size_t calls_ = 0;
};

}  // namespace

std::unique_ptr<System> make_tampered(std::unique_ptr<System> inner,
                                      std::function<void(std::size_t, SystemReport&)> hand) {
  return std::make_unique<TamperedSystem>(std::move(inner), std::move(hand));
}

}  // namespace mh
