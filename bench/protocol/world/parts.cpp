// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/world/parts.hpp"

#include <algorithm>
#include <utility>

namespace mh {
namespace {

class FirstFrames : public Sequence {
 public:
  FirstFrames(std::unique_ptr<Sequence> all, std::size_t at_most,
              const std::optional<Trajectory>& truth, bool gives_imu)
      : all_(std::move(all)), gives_imu_(gives_imu), size_(std::min(at_most, all_->size())) {
    const Trajectory* known = truth ? &*truth : all_->truth();
    if (known == nullptr || size_ == 0) return;
    Stamp first_ns = stamp_ns(0), last_ns = first_ns;
    for (std::size_t i = 0; i < size_; ++i) {
      first_ns = std::min(first_ns, stamp_ns(i));
      last_ns = std::max(last_ns, stamp_ns(i));
    }
    constexpr Stamp kMargin_ns = 100'000'000;  // longer than any gap that is interpolated
    truth_.emplace();
    for (const TimedPose& pose : *known)
      if (pose.stamp_ns >= first_ns - kMargin_ns && pose.stamp_ns <= last_ns + kMargin_ns)
        truth_->push_back(pose);
  }
  const Camera& camera() const override { return all_->camera(); }
  std::size_t size() const override { return size_; }
  Stamp stamp_ns(std::size_t i) const override { return all_->stamp_ns(i); }
  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    return all_->frame(i, noise);
  }
  const Trajectory* truth() const override {
    return truth_ && !truth_->empty() ? &*truth_ : nullptr;
  }
  std::span<const ImuReading> imu() const override {
    return gives_imu_ ? all_->imu() : std::span<const ImuReading>();
  }

 private:
  std::unique_ptr<Sequence> all_;
  bool gives_imu_;
  std::size_t size_;
  std::optional<Trajectory> truth_;
};

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

std::shared_ptr<const Sequence> first_frames(std::unique_ptr<Sequence> all, std::size_t at_most,
                                             std::optional<Trajectory> truth, bool gives_imu) {
  return std::make_shared<const FirstFrames>(std::move(all), at_most, truth, gives_imu);
}

std::shared_ptr<const Sequence> every_nth(std::shared_ptr<const Sequence> all, std::size_t n) {
  return std::make_shared<const EveryNth>(std::move(all), n);
}

}  // namespace mh
