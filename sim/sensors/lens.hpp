// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/render/renderer.hpp"

namespace mh {

/// Distorts pinhole images like a camera's lens. Color is blended in linear light;
/// depth, class and instance are those of the nearest pixel.
class Lens {
 public:
  explicit Lens(const Camera& camera);
  /// The pinhole camera whose images it requires: wide enough for everything the lens sees.
  const Camera& pinhole() const { return pinhole_; }
  /// The image seen through the lens; unchanged without distortion.
  RenderedFrame bend(RenderedFrame image) const;

 private:
  struct Source {
    float x, y;  // in the pinhole image, px
  };
  int width_, height_;
  Camera pinhole_;
  std::vector<Source> source_;  // by pixel; empty without distortion
};

/// Blurs like a slightly soft lens and the interpolation of a color filter array: with a Gaussian
/// of this standard deviation (px) in linear light; 0 or less: no change.
void blur_by_lens(Grid2d<Rgb8>& color, double sigma_px);

/// A distorted pixel's point at unit depth: the inverse of the distortion, by Newton's method. NaN
/// if the lens maps no point there.
Eigen::Vector2d undistort_px(const Camera& camera, const Eigen::Vector2d& pixel);
/// The pixel of a point at unit depth, seen through the lens.
Eigen::Vector2d distort_px(const Camera& camera, const Eigen::Vector2d& at_unit_depth);

}  // namespace mh
