// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/shutter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

#include "sim/render/color.hpp"

namespace mh {
namespace {

enum ShutterStream : std::uint64_t { kDropped = 1 };

double seconds_between(const TimedPose& a, const TimedPose& b) {
  return static_cast<double>(b.stamp_ns - a.stamp_ns) * 1e-9;
}

/// The pixels on which motion is evaluated.
std::vector<Eigen::Vector2i> motion_grid(const Camera& camera) {
  constexpr int kGrid = 9;
  std::vector<Eigen::Vector2i> pixels;
  for (int j = 0; j < kGrid; ++j)
    for (int i = 0; i < kGrid; ++i)
      pixels.emplace_back(i * (camera.width_px - 1) / (kGrid - 1),
                          j * (camera.height_px - 1) / (kGrid - 1));
  return pixels;
}

/// The maximum motion (px) of some pixels' content between two poses.
/// @param depth_m  depth of those pixels, seen from a third pose
double farthest_motion_px(const Camera& camera, std::span<const Eigen::Vector2i> pixels,
                          std::span<const float> depth_m, const SE3& first_from_seen,
                          const SE3& last_from_seen) {
  constexpr double kNothingM = 10.0;  // where nothing is seen, motion is computed at this depth
  constexpr double kNearestM = 0.05;
  double farthest = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double z = depth_m[i] > 0.0F ? depth_m[i] : kNothingM;
    const Eigen::Vector3d point = camera.unproject(pixels[i].x(), pixels[i].y(), z);
    const Eigen::Vector3d a = first_from_seen * point, b = last_from_seen * point;
    if (a.z() < kNearestM || b.z() < kNearestM) continue;
    farthest = std::max(farthest, (camera.project(a) - camera.project(b)).norm());
  }
  return farthest;
}

/// The times within a frame at which rows are exposed.
class Rows {
 public:
  /// @param images  number of images over the whole time in which any row is exposed
  Rows(const SensorConfig& config, int height, int images)
      : height_(height),
        images_(images),
        readout_s_(config.rolling_shutter.readout_s()),
        exposure_s_(config.motion_blur.exposure_s()),
        step_s_((readout_s_ + exposure_s_) / images) {
    // A row exposed for less than a step blends the two images nearest in time.
    if (exposure_s_ < step_s_) exposure_s_ = step_s_ = readout_s_ / (images - 1);
    for (int y = 0; y < height_; ++y) {
      collected_s_.push_back(0.0);
      for (int k = 0; k < images_; ++k) collected_s_.back() += overlap_s(k, y);
    }
  }

  static double duration_s(const SensorConfig& config) {
    return config.rolling_shutter.readout_s() + config.motion_blur.exposure_s();
  }
  /// The middle of image k's share of the time, s after the stamp.
  double time_s(int k) const { return (k + 0.5 - 0.5 * images_) * step_s_; }
  /// How long row y is exposed during image k's share of the time.
  double overlap_s(int k, int y) const {
    const double middle = ((y + 0.5) / height_ - 0.5) * readout_s_;
    const double begin = std::max(middle - 0.5 * exposure_s_, time_s(k) - 0.5 * step_s_);
    const double end = std::min(middle + 0.5 * exposure_s_, time_s(k) + 0.5 * step_s_);
    return std::max(0.0, end - begin);
  }
  /// The image that represents the middle of row y's exposure.
  int middle_image(int y) const {
    const double middle_s = ((y + 0.5) / height_ - 0.5) * readout_s_;
    return std::clamp(static_cast<int>(std::floor(middle_s / step_s_ + 0.5 * images_)), 0,
                      images_ - 1);
  }
  /// The rows that are exposed during image k's share of the time: first, and one past the last.
  std::pair<int, int> exposed_during(int k) const {
    int first = 0, last = height_;
    while (first < last && overlap_s(k, first) <= 0.0) ++first;
    while (last > first && overlap_s(k, last - 1) <= 0.0) --last;
    return {first, last};
  }
  /// The fraction of row y's light that image k contributes.
  double weight(int k, int y) const {
    return overlap_s(k, y) / collected_s_[static_cast<std::size_t>(y)];
  }

 private:
  int height_, images_;
  double readout_s_, exposure_s_, step_s_;
  std::vector<double> collected_s_;  // by row
};

/// Sums the rows of images in linear light.
class LightSum {
 public:
  LightSum(int width, int height)
      : width_(width),
        light_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F) {}

  void add_row(int y, std::span<const Rgb8> color, float weight) {
    add_linear(color, weight, light_.data() + place(y));
  }
  void write(Grid2d<Rgb8>& color) const {
    for (int y = 0; y < color.height(); ++y) encode_row(light_.data() + place(y), color.row(y));
  }

 private:
  std::size_t place(int y) const {
    return 3U * static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
  }
  int width_;
  std::vector<float> light_;
};

}  // namespace

SE3 pose_at(const Trajectory& path, std::size_t i, double after_s) {
  assert(i < path.size());
  while (after_s > 0.0 && i + 1 < path.size() && after_s > seconds_between(path[i], path[i + 1])) {
    after_s -= seconds_between(path[i], path[i + 1]);
    ++i;
  }
  while (after_s < 0.0 && i > 0) {
    --i;
    after_s += seconds_between(path[i], path[i + 1]);
  }
  if (after_s <= 0.0 || i + 1 >= path.size()) return path[i].world_from_camera;
  const SE3 &from = path[i].world_from_camera, &to = path[i + 1].world_from_camera;
  const double share = after_s / seconds_between(path[i], path[i + 1]);
  return from * SE3::exp(share * (from.inverse() * to).log());
}

std::vector<std::size_t> arriving(std::size_t frames, const SensorConfig& config,
                                  RandomStream stream) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < frames; ++i)
    if ((!config.feed.enabled || i % static_cast<std::size_t>(config.feed.keep_every) == 0) &&
        stream.fork(kDropped).uniform(i) >= config.dropped_frames.lost())
      indices.push_back(i);
  if (indices.empty() && frames > 0) indices.push_back(0);
  return indices;
}

Trajectory arriving_frames(const Trajectory& path, const SensorConfig& config,
                           RandomStream stream) {
  Trajectory frames;
  for (const std::size_t i : arriving(path.size(), config, stream)) frames.push_back(path[i]);
  return frames;
}

Camera with_lens(Camera camera, const SensorConfig& config) {
  if (config.lens_distortion.enabled) camera.distortion = config.lens_distortion.lens;
  return camera;
}

Shutter::Shutter(SceneAt scene, const Camera& camera, Trajectory path, const SensorConfig& config)
    : scene_(std::move(scene)),
      camera_(with_lens(camera, config)),
      lens_(camera_),
      path_(std::move(path)),
      config_(config) {
  assert(scene_ && !path_.empty());
}

Shutter::Shutter(std::shared_ptr<const Renderer> renderer, const Camera& camera, Trajectory path,
                 const SensorConfig& config)
    : Shutter([renderer = std::move(renderer)](Stamp) { return renderer; }, camera, std::move(path),
              config) {}

Shutter::Exposed Shutter::expose(std::size_t i, LabelMode labels) const {
  assert(i < path_.size());
  const int images = images_within(i);
  const double offset_s = config_.depth_offset.offset_s();
  RenderedFrame image = images > 1 && offset_s != 0.0 && labels != LabelMode::kAnnotated
                            ? RenderedFrame{}  // neither its depth nor most of its rows are used
                            : render(lens_.pinhole(), i, 0.0);
  if (images > 1) blur(image, i, images, labels);
  if (offset_s != 0.0) {
    const auto [scene, pose] = moment(i, offset_s);
    image.depth_m = scene->render_depth(lens_.pinhole(), pose);
  }
  image = lens_.bend(std::move(image));
  if (config_.lens_blur.enabled) blur_by_lens(image.color, config_.lens_blur.sigma_px);
  return {std::move(image), gain(i)};
}

Shutter::Moment Shutter::moment(std::size_t i, double after_s) const {
  const Stamp stamp_ns = path_[i].stamp_ns + static_cast<Stamp>(std::llround(after_s * 1e9));
  return {scene_(stamp_ns), pose_at(path_, i, after_s)};
}

RenderedFrame Shutter::render(const Camera& pinhole, std::size_t i, double after_s) const {
  const auto [scene, pose] = moment(i, after_s);
  return scene->render(pinhole, pose);
}

/// Number of images to blend into a frame.
int Shutter::images_within(std::size_t i) const {
  const MotionSampling& sampling = config_.motion_sampling;
  const double duration_s = Rows::duration_s(config_);
  if (duration_s <= 0.0) return 1;
  const Camera& camera = lens_.pinhole();
  const auto [scene, world_from_seen] = moment(i, 0.0);
  const std::vector<Eigen::Vector2i> pixels = motion_grid(camera);
  const double motion_px = farthest_motion_px(
      camera, pixels, scene->depth_at(camera, world_from_seen, pixels),
      pose_at(path_, i, -0.5 * duration_s).inverse() * path_[i].world_from_camera,
      pose_at(path_, i, 0.5 * duration_s).inverse() * path_[i].world_from_camera);
  if (motion_px <= sampling.sharp_px) return 1;
  // With an odd number, the image of the stamp is the middle one.
  const int wanted = static_cast<int>(std::ceil(motion_px / sampling.step_px)) | 1;
  return std::clamp(wanted, 3, std::max(3, sampling.max_images | 1));
}

/// Blends the images taken within a frame's exposure.
/// @param image  the image at the stamp; empty: its rows are rendered as they are needed
void Shutter::blur(RenderedFrame& image, std::size_t i, int images, LabelMode labels) const {
  const Camera& camera = lens_.pinhole();
  const Rows rows(config_, camera.height_px, images);
  if (image.color.empty()) {
    const auto [first, last] = rows.exposed_during(images / 2);
    const auto [scene, pose] = moment(i, 0.0);
    image = scene->render_rows(camera, pose, first, last);
  }
  LightSum sum(camera.width_px, camera.height_px);
  for (int k = 0; k < images; ++k) {
    const auto [first, last] = rows.exposed_during(k);
    if (first == last) continue;
    const bool middle = k == images / 2;
    Camera strip = camera;
    strip.height_px = last - first;
    strip.cy_px -= first;
    RenderedFrame part;
    if (!middle) part = render(strip, i, rows.time_s(k));
    for (int y = first; y < last; ++y) {
      sum.add_row(
          y, middle ? std::as_const(image.color).row(y) : std::as_const(part.color).row(y - first),
          static_cast<float>(rows.weight(k, y)));
      if (middle || labels == LabelMode::kAnnotated || rows.middle_image(y) != k) continue;
      std::ranges::copy(part.classes.row(y - first), image.classes.row(y).begin());
      std::ranges::copy(part.instances.row(y - first), image.instances.row(y).begin());
    }
  }
  sum.write(image.color);
}

double Shutter::gain(std::size_t i) const {
  if (!config_.auto_exposure.enabled) return 1.0;
  std::call_once(gains_->made, [&] { gains_->by_frame = exposure_gains(); });
  return gains_->by_frame[i];
}

std::vector<double> Shutter::exposure_gains() const {
  // A light meter needs no detail.
  constexpr int kWidth = 40, kHeight = 30;
  const Camera meter = resized(camera_, kWidth, kHeight);
  const AutoExposureConfig& config = config_.auto_exposure;
  const double limit = std::log(config.max_gain);
  std::vector<double> gains;
  double log_gain = 0.0;
  for (std::size_t i = 0; i < path_.size(); ++i) {
    double mean = 0.0;
    for (const Rgb8& c : render(meter, i, 0.0).color)
      mean += luminance(srgb_to_linear(c)) / (kWidth * kHeight);
    const double wanted = std::clamp(std::log(config.target / std::max(mean, 1e-6)), -limit, limit);
    // At the first frame, the control has settled.
    const double share =
        i == 0 || config.time_constant_s <= 0.0
            ? 1.0
            : 1.0 - std::exp(-seconds_between(path_[i - 1], path_[i]) / config.time_constant_s);
    log_gain += share * (wanted - log_gain);
    gains.push_back(std::exp(log_gain));
  }
  return gains;
}

}  // namespace mh
