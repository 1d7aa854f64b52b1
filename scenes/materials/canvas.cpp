// SPDX-License-Identifier: Apache-2.0
#include "scenes/materials/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>

namespace mh {
namespace {

constexpr int kShift = 4;  // OpenCV draws in sixteenths of a texel
constexpr float kUnit = 1 << kShift;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr float kCapitalHeight = 21.0F;  // of that font at scale 1, in texels

cv::Mat view(Grid2d<Rgb8>& image) {
  return {image.height(), image.width(), CV_8UC3, image.data()};
}

cv::Point point(float x, float y) {
  return {static_cast<int>(std::lround(x * kUnit)), static_cast<int>(std::lround(y * kUnit))};
}

cv::Scalar scalar(Tint tint) {
  const Rgb8 c = to_rgb8(tint);
  return cv::Scalar(c.r, c.g, c.b);
}

int stroke(float thickness) {
  return std::max(1, static_cast<int>(std::lround(thickness)));
}

}  // namespace

void Canvas::rectangle(float x, float y, float width, float height, Tint tint) {
  cv::Mat image = view(image_);
  const cv::Rect rect(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)),
                      std::max(1, static_cast<int>(std::lround(width))),
                      std::max(1, static_cast<int>(std::lround(height))));
  const cv::Rect inside = rect & cv::Rect(0, 0, image.cols, image.rows);
  if (!inside.empty()) image(inside).setTo(scalar(tint));
}

void Canvas::frame(float x, float y, float width, float height, float thickness, Tint tint) {
  rectangle(x, y, width, thickness, tint);
  rectangle(x, y + height - thickness, width, thickness, tint);
  rectangle(x, y, thickness, height, tint);
  rectangle(x + width - thickness, y, thickness, height, tint);
}

void Canvas::line(float x0, float y0, float x1, float y1, float thickness, Tint tint) {
  cv::Mat image = view(image_);
  cv::line(image, point(x0, y0), point(x1, y1), scalar(tint), stroke(thickness), cv::LINE_AA,
           kShift);
}

void Canvas::ellipse(float x, float y, float radius_x, float radius_y, float angle_rad, Tint tint) {
  cv::Mat image = view(image_);
  const cv::Point radii = point(std::max(radius_x, 0.5F), std::max(radius_y, 0.5F));
  cv::ellipse(image, point(x, y), cv::Size(radii.x, radii.y), angle_rad * 180.0 / std::numbers::pi,
              0.0, 360.0, scalar(tint), cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::polygon(const std::vector<Eigen::Vector2f>& corners, Tint tint) {
  cv::Mat image = view(image_);
  std::vector<cv::Point> points;
  for (const Eigen::Vector2f& c : corners) points.push_back(point(c.x(), c.y()));
  cv::fillPoly(image, std::vector{points}, scalar(tint), cv::LINE_AA, kShift);
}

float Canvas::text(std::string_view words, const Eigen::Vector2f& at, const Letters& letters,
                   Tint tint) {
  const auto& [height, thickness, upwards] = letters;
  cv::Mat image = view(image_);
  const std::string copy(words);
  const double scale = height / kCapitalHeight;
  const float width = text_width(words, height);
  if (!upwards) {
    cv::putText(image, copy, cv::Point(std::lround(at.x()), std::lround(at.y())), kFont, scale,
                scalar(tint), stroke(thickness), cv::LINE_AA);
    return width;
  }
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
  const cv::Point base(image.rows - 1 - std::lround(at.y()), std::lround(at.x()));
  cv::putText(turned, copy, base, kFont, scale, scalar(tint), stroke(thickness), cv::LINE_AA);
  cv::rotate(turned, image, cv::ROTATE_90_COUNTERCLOCKWISE);
  return width;
}

float Canvas::text_width(std::string_view words, float height) {
  int baseline = 0;
  return static_cast<float>(
      cv::getTextSize(std::string(words), kFont, height / kCapitalHeight, 1, &baseline).width);
}

}  // namespace mh
