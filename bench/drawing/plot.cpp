// SPDX-License-Identifier: Apache-2.0
#include "bench/drawing/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "bench/drawing/canvas.hpp"

namespace mh {
namespace {

constexpr double kPanelWidth = 440, kPanelHeight = 320, kMargin = 24, kHeader = 64;
constexpr int kColumns = 3;
constexpr Rgb8 kInk = {40, 43, 50}, kPale = {225, 228, 233}, kGray = {110, 115, 125};
constexpr std::array<Rgb8, 5> kColors = {
    {{31, 119, 180}, {214, 39, 40}, {44, 160, 44}, {255, 127, 14}, {148, 103, 189}}};

/// A range of round numbers that contains the values, and the step between its ticks.
struct Axis {
  double low = 0, high = 1, step = 1;

  Axis(double least, double most) {
    if (least > 0 && least < 0.5 * most) least = 0;
    if (!(most > least)) most = least + 1;
    const double rough = (most - least) / 4.5;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
      step = factor * power;
      if (step >= rough) break;
    }
    low = std::floor(least / step + 1e-9) * step;
    high = std::ceil(most / step - 1e-9) * step;
  }
  double share(double value) const { return (value - low) / (high - low); }
};

void draw_panel(Canvas& canvas, const Plot& plot, double x0, double y0) {
  double least_x = 1e300, most_x = -1e300, least_y = 1e300, most_y = -1e300;
  for (const Series& series : plot.series) {
    for (const cv::Point2d& p : series.points) {
      least_x = std::min(least_x, p.x), most_x = std::max(most_x, p.x);
      least_y = std::min(least_y, p.y), most_y = std::max(most_y, p.y);
    }
    for (const auto& [from, to] : series.bars)
      least_y = std::min(least_y, from), most_y = std::max(most_y, to);
  }
  const Axis across(least_x, most_x), up(least_y, most_y);
  const double left = x0 + 58, right = x0 + kPanelWidth - 14;
  const double top = y0 + 44, bottom = y0 + kPanelHeight - 42;
  const auto at = [&](double x, double y) {
    return cv::Point2d(left + across.share(x) * (right - left),
                       bottom - up.share(y) * (bottom - top));
  };
  canvas.text(plot.title, {x0 + 8, y0 + 16}, 10, kInk, Canvas::Align::kLeft, true);
  canvas.text(plot.y_label, {x0 + 8, y0 + 34}, 8, kGray);
  canvas.text(plot.x_label, {(left + right) / 2, y0 + kPanelHeight - 10}, 8, kGray,
              Canvas::Align::kCenter);
  for (double v = across.low; v < across.high + 0.5 * across.step; v += across.step) {
    canvas.line(at(v, up.low), at(v, up.high), kPale, 0.5);
    canvas.text(fmt::format("{:g}", std::abs(v) < 1e-12 ? 0.0 : v),
                at(v, up.low) + cv::Point2d(0, 14), 7.5, kGray, Canvas::Align::kCenter);
  }
  for (double v = up.low; v < up.high + 0.5 * up.step; v += up.step) {
    canvas.line(at(across.low, v), at(across.high, v), kPale, 0.5);
    canvas.text(fmt::format("{:g}", std::abs(v) < 1e-12 ? 0.0 : v),
                at(across.low, v) + cv::Point2d(-6, 3), 7.5, kGray, Canvas::Align::kRight);
  }
  // The legend stays clear of the start of the first curve.
  const bool begins_high = !plot.series.empty() && !plot.series[0].points.empty() &&
                           up.share(plot.series[0].points[0].y) > 0.5;
  const double legend_x = begins_high ? (left + right) / 2 - 10 : left;
  double legend = top + 10;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const Series& series = plot.series[s];
    const Rgb8 color = kColors[(s / 2) % kColors.size()];
    for (std::size_t i = 0; i < series.points.size(); ++i) {
      const cv::Point2d here = at(series.points[i].x, series.points[i].y);
      if (series.dots) {
        canvas.disc(here, 2.6, color);
      } else if (i > 0) {
        canvas.line(at(series.points[i - 1].x, series.points[i - 1].y), here, color, 1.2);
      }
    }
    for (std::size_t i = 0; i < series.bars.size(); ++i)
      canvas.line(at(series.points[i].x, series.bars[i].first),
                  at(series.points[i].x, series.bars[i].second), color, 0.8);
    if (series.name.empty() && !series.bars.empty()) continue;
    if (series.dots)
      canvas.disc({legend_x + 16, legend - 3}, 2.6, color);
    else
      canvas.line({legend_x + 8, legend - 3}, {legend_x + 24, legend - 3}, color, 1.2);
    canvas.text(series.name, {legend_x + 30, legend}, 7.5, kInk);
    legend += 14;
  }
}

}  // namespace

cv::Mat draw_plots(const std::string& title, const std::vector<Plot>& plots) {
  const int rows = (static_cast<int>(plots.size()) + kColumns - 1) / kColumns;
  Canvas canvas(static_cast<int>(2 * kMargin + kColumns * kPanelWidth),
                static_cast<int>(kHeader + rows * kPanelHeight + kMargin));
  canvas.text(title, {kMargin, 36}, 15, kInk, Canvas::Align::kLeft, true);
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const int row = static_cast<int>(i) / kColumns, column = static_cast<int>(i) % kColumns;
    draw_panel(canvas, plots[i], kMargin + column * kPanelWidth, kHeader + row * kPanelHeight);
  }
  return canvas.finish();
}

}  // namespace mh
