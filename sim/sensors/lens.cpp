// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/lens.hpp"

#include <algorithm>
#include <cmath>

#include "sim/render/color.hpp"

namespace mh {
namespace {

using Eigen::Vector2d;

// Pixels that need a wider margin, as a share of the image, are not rendered: the lens is outside
// the range of its model there.
constexpr double kMostMargin = 0.5;

}  // namespace

Vector2d distort_px(const Camera& camera, const Vector2d& at_unit_depth) {
  const Vector2d p = camera.distortion.distorted(at_unit_depth.x(), at_unit_depth.y());
  return {camera.fx_px * p.x() + camera.cx_px, camera.fy_px * p.y() + camera.cy_px};
}

Vector2d undistort_px(const Camera& camera, const Vector2d& pixel) {
  return camera.distortion.undistorted((pixel.x() - camera.cx_px) / camera.fx_px,
                                       (pixel.y() - camera.cy_px) / camera.fy_px);
}

Lens::Lens(const Camera& camera)
    : width_(camera.width_px), height_(camera.height_px), pinhole_(camera) {
  pinhole_.distortion = {};
  if (camera.distortion.none()) return;
  double left = 0, top = 0, right = width_ - 1.0, bottom = height_ - 1.0;
  source_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const Vector2d p = undistort_px(camera, {x, y});
      const double u = camera.fx_px * p.x() + camera.cx_px;
      const double v = camera.fy_px * p.y() + camera.cy_px;
      source_.push_back({static_cast<float>(u), static_cast<float>(v)});
      if (!(std::abs(u - x) < kMostMargin * width_ && std::abs(v - y) < kMostMargin * height_))
        continue;
      left = std::min(left, u), right = std::max(right, u);
      top = std::min(top, v), bottom = std::max(bottom, v);
    }
  const double before_x = std::ceil(-left), before_y = std::ceil(-top);
  pinhole_.width_px = static_cast<int>(before_x + std::ceil(right) + 1.0);
  pinhole_.height_px = static_cast<int>(before_y + std::ceil(bottom) + 1.0);
  pinhole_.cx_px += before_x;
  pinhole_.cy_px += before_y;
  for (Source& source : source_) {
    source.x += static_cast<float>(before_x);
    source.y += static_cast<float>(before_y);
  }
}

RenderedFrame Lens::bend(RenderedFrame image) const {
  if (source_.empty()) return image;
  RenderedFrame bent{{width_, height_}, {width_, height_}, {width_, height_}, {width_, height_}};
  bent.exposure = image.exposure;
  const auto last_x = static_cast<float>(pinhole_.width_px - 1);
  const auto last_y = static_cast<float>(pinhole_.height_px - 1);
  for (std::size_t i = 0; i < source_.size(); ++i) {
    const auto [x, y] = source_[i];
    if (!(x >= 0.0F && y >= 0.0F && x <= last_x && y <= last_y)) continue;
    const int near_x = static_cast<int>(x + 0.5F), near_y = static_cast<int>(y + 0.5F);
    bent.depth_m.data()[i] = image.depth_m(near_x, near_y);
    bent.classes.data()[i] = image.classes(near_x, near_y);
    bent.instances.data()[i] = image.instances(near_x, near_y);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, pinhole_.width_px - 1);
    const int y1 = std::min(y0 + 1, pinhole_.height_px - 1);
    const float s = x - static_cast<float>(x0), t = y - static_cast<float>(y0);
    const Eigen::Vector3f light = (1.0F - t) * ((1.0F - s) * srgb_to_linear(image.color(x0, y0)) +
                                                s * srgb_to_linear(image.color(x1, y0))) +
                                  t * ((1.0F - s) * srgb_to_linear(image.color(x0, y1)) +
                                       s * srgb_to_linear(image.color(x1, y1)));
    bent.color.data()[i] = {linear_to_srgb(light.x()), linear_to_srgb(light.y()),
                            linear_to_srgb(light.z())};
  }
  return bent;
}

}  // namespace mh
