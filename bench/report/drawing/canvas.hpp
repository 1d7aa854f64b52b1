// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <opencv2/core/mat.hpp>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// An image drawn at twice its size and scaled down at the end, so that lines and letters are
/// smooth. All lengths are in pixels of the finished image.
class Canvas {
 public:
  Canvas(int width_px, int height_px, Rgb8 background = {255, 255, 255});

  int width() const { return width_; }
  int height() const { return height_; }

  void fill(double x, double y, double width, double height, Rgb8 color);
  void line(cv::Point2d from, cv::Point2d to, Rgb8 color, double thickness);
  void ring(cv::Point2d center, double radius, Rgb8 color, double thickness);
  void disc(cv::Point2d center, double radius, Rgb8 color);
  void cross(cv::Point2d center, double half, Rgb8 color, double thickness);  ///< an 'x'
  enum class Align { kLeft, kCenter, kRight };
  /// Text with its baseline at y; `size` is the height of a capital letter.
  void text(const std::string& text, cv::Point2d at, double size, Rgb8 color = {40, 40, 40},
            Align align = Align::kLeft, bool bold = false);
  static double text_width(const std::string& text, double size, bool bold = false);
  /// Draws an image (8-bit BGR) into a rectangle.
  void image(const cv::Mat& bgr, double x, double y, double width, double height);

  cv::Mat finish() const;  ///< 8-bit BGR at its final size

 private:
  int width_, height_;
  cv::Mat large_;
};

}  // namespace mh
