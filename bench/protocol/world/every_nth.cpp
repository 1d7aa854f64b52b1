// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/every_nth.hpp"

#include <utility>

namespace mh {
namespace {

class EveryNth : public Sequence {
 public:
  EveryNth(std::shared_ptr<const Sequence> all, std::size_t n)
      : all_(std::move(all)), n_(n), camera_(all_->camera()) {
    camera_.rate_hz /= static_cast<double>(n);
    if (all_->truth() == nullptr) return;
    for (std::size_t i = 0; i < all_->truth()->size(); i += n)
      truth_.push_back((*all_->truth())[i]);
  }
  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return (all_->size() + n_ - 1) / n_; }
  Stamp stamp_ns(std::size_t i) const override { return all_->stamp_ns(i * n_); }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    return all_->frame(i * n_, noise);
  }
  const Trajectory* truth() const override { return all_->truth() != nullptr ? &truth_ : nullptr; }
  std::span<const ImuReading> imu() const override { return all_->imu(); }

 private:
  std::shared_ptr<const Sequence> all_;
  std::size_t n_;
  Camera camera_;
  Trajectory truth_;
};

}  // namespace

std::shared_ptr<const Sequence> every_nth(std::shared_ptr<const Sequence> all, std::size_t n) {
  return std::make_shared<const EveryNth>(std::move(all), n);
}

}  // namespace mh
