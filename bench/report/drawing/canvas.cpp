// SPDX-License-Identifier: Apache-2.0
#include "bench/report/drawing/canvas.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace mh {
namespace {

constexpr int kZoom = 2;
constexpr int kFractionBits = 4;  // OpenCV draws at 1/16 px
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapital = 21.0;  // height of a capital letter of kFont at scale 1

cv::Scalar bgr(Rgb8 c) {
  return {double(c.b), double(c.g), double(c.r)};
}

cv::Point fixed(cv::Point2d p) {
  const double scale = kZoom * (1 << kFractionBits);
  return {static_cast<int>(std::lround(p.x * scale)), static_cast<int>(std::lround(p.y * scale))};
}

int stroke(double thickness) {
  return std::max(1, static_cast<int>(std::lround(thickness * kZoom)));
}

double font_scale(double size) {
  return size * kZoom / kCapital;
}
int font_stroke(double size, bool bold) {
  return stroke(size * (bold ? 0.17 : 0.1));
}

}  // namespace

Canvas::Canvas(int width_px, int height_px, Rgb8 background)
    : width_(width_px),
      height_(height_px),
      large_(height_px * kZoom, width_px * kZoom, CV_8UC3, bgr(background)) {}

void Canvas::fill(double x, double y, double width, double height, Rgb8 color) {
  // Edges are rounded, not sizes, so that neighboring cells of a grid leave no gap.
  const auto edge = [](double v) { return static_cast<int>(std::lround(v * kZoom)); };
  const cv::Rect rect(cv::Point(edge(x), edge(y)), cv::Point(edge(x + width), edge(y + height)));
  const cv::Rect inside = rect & cv::Rect(0, 0, large_.cols, large_.rows);
  if (inside.area() > 0) large_(inside).setTo(bgr(color));
}

void Canvas::line(cv::Point2d from, cv::Point2d to, Rgb8 color, double thickness) {
  cv::line(large_, fixed(from), fixed(to), bgr(color), stroke(thickness), cv::LINE_AA,
           kFractionBits);
}

void Canvas::ring(cv::Point2d center, double radius, Rgb8 color, double thickness) {
  cv::circle(large_, fixed(center),
             static_cast<int>(std::lround(radius * kZoom * (1 << kFractionBits))), bgr(color),
             stroke(thickness), cv::LINE_AA, kFractionBits);
}

void Canvas::disc(cv::Point2d center, double radius, Rgb8 color) {
  cv::circle(large_, fixed(center),
             static_cast<int>(std::lround(radius * kZoom * (1 << kFractionBits))), bgr(color),
             cv::FILLED, cv::LINE_AA, kFractionBits);
}

void Canvas::cross(cv::Point2d center, double half, Rgb8 color, double thickness) {
  const cv::Point2d up(half, half), down(half, -half);
  line(center - up, center + up, color, thickness);
  line(center - down, center + down, color, thickness);
}

double Canvas::text_width(const std::string& text, double size, bool bold) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, font_scale(size), font_stroke(size, bold), &baseline).width /
         static_cast<double>(kZoom);
}

void Canvas::text(const std::string& text, cv::Point2d at, double size, Rgb8 color, Align align,
                  bool bold) {
  const double width = text_width(text, size, bold);
  if (align == Align::kCenter) at.x -= width / 2;
  if (align == Align::kRight) at.x -= width;
  cv::putText(
      large_, text,
      {static_cast<int>(std::lround(at.x * kZoom)), static_cast<int>(std::lround(at.y * kZoom))},
      kFont, font_scale(size), bgr(color), font_stroke(size, bold), cv::LINE_AA);
}

void Canvas::image(const cv::Mat& bgr_image, double x, double y, double width, double height) {
  const cv::Rect rect(static_cast<int>(x * kZoom), static_cast<int>(y * kZoom),
                      static_cast<int>(width * kZoom), static_cast<int>(height * kZoom));
  cv::Mat scaled;
  cv::resize(bgr_image, scaled, rect.size(), 0, 0, cv::INTER_AREA);
  scaled.copyTo(large_(rect));
}

cv::Mat Canvas::finish() const {
  cv::Mat small;
  cv::resize(large_, small, {width_, height_}, 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace mh
