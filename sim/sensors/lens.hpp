// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sim/render/renderer.hpp"

namespace mh {

/// Bends pinhole images as a camera's lens does (Brown-Conrady). Color is blended in linear
/// light; depth, class and instance are those of the nearest pixel.
class Lens {
 public:
  explicit Lens(const Camera& camera);
  /// The pinhole camera whose images it needs: wide enough for what the lens draws in.
  const Camera& pinhole() const { return pinhole_; }
  /// The image behind the lens; the same where there is no distortion.
  RenderedFrame bend(RenderedFrame image) const;

 private:
  struct Source {
    float x, y;  // in the pinhole image, px
  };
  int width_, height_;
  Camera pinhole_;
  std::vector<Source> source_;  // by pixel; empty without distortion
};

/// A lens that is not quite sharp, and the interpolation of a color filter: a Gaussian in linear
/// light of this standard deviation, px; 0 or less: nothing.
void blur_by_lens(Grid2d<Rgb8>& color, double sigma_px);

/// Where a distorted pixel lies at unit depth: the inverse of the distortion, by Newton's method.
/// NaN where the lens maps nothing there.
Eigen::Vector2d undistort_px(const Camera& camera, const Eigen::Vector2d& pixel);
/// The pixel of a point at unit depth, seen through the lens.
Eigen::Vector2d distort_px(const Camera& camera, const Eigen::Vector2d& at_unit_depth);

}  // namespace mh
