// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "scenes/materials/color.hpp"
#include "slam/core/grid2d.hpp"

namespace mh {

/// Style of a line of text.
struct Letters {
  float height;          ///< of capitals
  float thickness;       ///< of strokes
  bool upwards = false;  ///< rotated by 90 degrees, as on the spine of a book
};

/// Draws antialiased shapes and letters into an image; coordinates in texels, clipped at the
/// border. Keeps a reference to the image.
class Canvas {
 public:
  explicit Canvas(Grid2d<Rgb8>& image) : image_(image) {}

  void rectangle(float x, float y, float width, float height, Tint tint);
  void frame(float x, float y, float width, float height, float thickness, Tint tint);
  void line(float x0, float y0, float x1, float y1, float thickness, Tint tint);
  void ellipse(float x, float y, float radius_x, float radius_y, float angle_rad, Tint tint);
  void polygon(const std::vector<Eigen::Vector2f>& corners, Tint tint);
  /// Writes text, its baseline starting at `at`, and returns its width.
  float text(std::string_view words, const Eigen::Vector2f& at, const Letters& letters, Tint tint);
  static float text_width(std::string_view words, float height);

 private:
  Grid2d<Rgb8>& image_;
};

}  // namespace mh
