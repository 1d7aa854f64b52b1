// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// A picture drawn at twice its size and scaled down in the end, so that lines and letters are
/// smooth. All lengths are in pixels of the finished picture.
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
  /// Puts a picture (8-bit BGR) into a rectangle.
  void picture(const cv::Mat& bgr, double x, double y, double width, double height);

  cv::Mat finish() const;  ///< 8-bit BGR at its real size

 private:
  int width_, height_;
  cv::Mat large_;
};

/// The same picture as 8-bit BGR.
cv::Mat color_picture(const Grid2d<Rgb8>& color);

/// A grid of numbers of 8 or 16 bits as a gray picture in the same memory: for reading, and no
/// longer than the grid is there.
template <class Number>
cv::Mat gray_picture(const Grid2d<Number>& grid) {
  static_assert(std::is_unsigned_v<Number> && sizeof(Number) <= 2);
  return {grid.height(), grid.width(), sizeof(Number) == 1 ? CV_8UC1 : CV_16UC1,
          const_cast<Number*>(grid.data())};
}

/// Writes a picture, in the format that the file's ending tells, whole or not at all.
/// @param settings  of the format, as cv::imencode takes them
/// @throws InputError if it cannot be written.
void write_picture(const std::filesystem::path& file, const cv::Mat& bgr,
                   const std::vector<int>& settings = {});

/// Whether a PNG or JPEG file is there and as whole as picture_fault() can tell.
bool is_whole_picture(const std::filesystem::path& file);

}  // namespace mh
