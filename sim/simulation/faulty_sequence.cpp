// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/faulty_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/recordings/nearest_stamp.hpp"
#include "sim/sensors/lens.hpp"
#include "sim/sensors/sense.hpp"
#include "sim/sensors/shutter.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

enum FeedStream : std::uint64_t { kStuck = 1, kJitter = 2 };

/// The faults of the feed are the same for every trial, like the frames that are lost.
const RandomStream kFeed = RandomStream(0).fork(17);

/// Finished frames with the faults that a level adds to images.
class DegradedFrames : public Sequence {
 public:
  DegradedFrames(std::shared_ptr<const Sequence> recording, const SensorConfig& level)
      : recording_(std::move(recording)),
        level_(level),
        arriving_(arriving(recording_->size(), level, RandomStream(0))) {}

  const Camera& camera() const override { return recording_->camera(); }
  std::size_t size() const override { return arriving_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return recording_->stamp_ns(arriving_[i]); }
  const Trajectory* truth() const override { return recording_->truth(); }
  std::span<const ImuReading> imu() const override { return recording_->imu(); }

  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    RgbdFrame frame = recording_->frame(arriving_[i], noise);
    if (level_.lens_blur.enabled) blur_by_lens(frame.color, level_.lens_blur.sigma_px);
    RenderedFrame seen;
    seen.color = std::move(frame.color);
    seen.depth_m = std::move(frame.depth_m);
    RgbdFrame sensed = sense(seen, camera(), level_, noise.fork(i), frame.stamp_ns);
    frame.color = std::move(sensed.color);
    frame.depth_m = std::move(sensed.depth_m);
    if (is_blank(level_, noise.fork(i))) frame.semantics = {};
    return frame;
  }

 private:
  std::shared_ptr<const Sequence> recording_;
  SensorConfig level_;
  std::vector<std::size_t> arriving_;
};

class FaultyFeed : public Sequence {
 public:
  FaultyFeed(std::shared_ptr<const Sequence> frames, const SensorConfig& level)
      : frames_(std::move(frames)), camera_(frames_->camera()), stamps_(stamps_of(*frames_)) {
    if (level.told.enabled) {
      camera_.fx_px *= level.told.focal;
      camera_.fy_px *= level.told.focal;
      camera_.cx_px += level.told.center_px;
      camera_.cy_px += level.told.center_px;
      camera_.distortion.k1 += level.told.k1;
    }
    const FeedConfig feed = level.feed.enabled ? level.feed : FeedConfig();
    for (std::size_t i = 0; i < frames_->size(); ++i)
      order_.push_back(feed.backward ? frames_->size() - 1 - i : i);
    backward_ = feed.backward && !stamps_.empty();
    if (backward_) {
      const Stamp sum_ns = stamps_.front() + stamps_.back();
      for (Stamp& stamp_ns : stamps_) stamp_ns = sum_ns - stamp_ns;
      std::ranges::reverse(stamps_);
    }
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const bool is_stuck = i > 0 && kFeed.fork(kStuck).uniform(i) < feed.stuck;
      shown_.push_back(is_stuck ? shown_.back() : order_[i]);
    }
    for (std::size_t i = 0; i < stamps_.size(); ++i)
      stamps_[i] += std::llround(1e6 * feed.jitter_ms * kFeed.fork(kJitter).normal(i));
    for (std::size_t i = 1; i < stamps_.size() && feed.jitter_ms > 0; ++i)
      stamps_[i] = std::max(stamps_[i], stamps_[i - 1] + 1);
    if (feed.jitter_ms > 0 || backward_) move_truth();
  }

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return order_.size(); }
  Stamp stamp_ns(std::size_t i) const override { return stamps_[i]; }
  const Trajectory* truth() const override { return truth_ ? &*truth_ : frames_->truth(); }
  std::span<const ImuReading> imu() const override {
    return backward_ ? std::span<const ImuReading>() : frames_->imu();
  }

  RgbdFrame frame(std::size_t i, RandomStream noise) const override {
    RgbdFrame frame = frames_->frame(order_[i], noise);
    if (shown_[i] != order_[i]) {
      RgbdFrame before = frames_->frame(shown_[i], noise);
      frame.color = std::move(before.color);
      frame.depth_m = std::move(before.depth_m);
      frame.semantics = std::move(before.semantics);
    }
    frame.stamp_ns = stamps_[i];
    if (backward_) frame.odom_from_camera.reset();
    return frame;
  }

 private:
  /// Gives the true poses the stamps that the frames are delivered with.
  void move_truth() {
    const Trajectory* poses = frames_->truth();
    if (poses == nullptr) return;
    truth_.emplace();
    std::vector<Stamp> known_ns;
    for (const TimedPose& pose : *poses) known_ns.push_back(pose.stamp_ns);
    const StampIndex known(known_ns);
    for (std::size_t i = 0; i < order_.size(); ++i)
      if (const auto nearest = known.nearest(frames_->stamp_ns(order_[i])))
        truth_->push_back({stamps_[i], (*poses)[*nearest].world_from_camera});
  }

  std::shared_ptr<const Sequence> frames_;
  Camera camera_;
  std::vector<Stamp> stamps_;
  std::vector<std::size_t> order_;  ///< the frame that each is
  std::vector<std::size_t> shown_;  ///< the frame whose images each has
  bool backward_ = false;
  std::optional<Trajectory> truth_;
};

}  // namespace

std::vector<std::string> faults_of_scene(const SensorConfig& level) {
  std::vector<std::string> faults;
  const auto refuse = [&](bool is_on, const char* section, const char* why) {
    if (is_on) faults.push_back(fmt::format("{}: {}", section, why));
  };
  const char* motion = "needs images along the camera's motion";
  refuse(level.motion_blur.exposure_s() > 0, "motion_blur", motion);
  refuse(level.rolling_shutter.readout_s() > 0, "rolling_shutter", motion);
  refuse(level.depth_offset.offset_s() != 0, "depth_offset", motion);
  refuse(level.hurry.factor() != 1, "hurry", motion);
  refuse(level.lens_distortion.enabled, "lens_distortion",
         "needs what is beyond the border; `told` hands over a wrong lens instead");
  refuse(level.auto_exposure.enabled, "auto_exposure", "the recording's camera had its own");
  refuse(level.depth_noise.enabled && level.depth_noise.projector_shadow,
         "depth_noise.projector_shadow", "the recording's sensor had its own");
  refuse(!level.labels.noise.none(), "label_noise", "acts on the scene's objects");
  return faults;
}

std::shared_ptr<const Sequence> with_feed_faults(std::shared_ptr<const Sequence> frames,
                                                 const SensorConfig& level) {
  const FeedConfig& feed = level.feed;
  if (!level.told.enabled &&
      !(feed.enabled && (feed.stuck > 0 || feed.jitter_ms > 0 || feed.backward)))
    return frames;
  return std::make_shared<FaultyFeed>(std::move(frames), level);
}

std::shared_ptr<const Sequence> degraded(std::shared_ptr<const Sequence> recording,
                                         const SensorConfig& level) {
  if (const auto faults = faults_of_scene(level); !faults.empty())
    throw InputError(
        fmt::format("this level cannot be added to finished images: {}", fmt::join(faults, "; ")));
  return with_feed_faults(std::make_shared<DegradedFrames>(std::move(recording), level), level);
}

}  // namespace mh
