// SPDX-License-Identifier: Apache-2.0
// `modelhouse sensors plot`: each line is a published formula, each row of dots was measured on the
// model. The one must lie on the other, or the picture shows what the model does not do.
#include "bench/sensors/figures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace mh {
namespace {

/// A line's value between its points; that of its end beyond.
double value_at(const Series& line, double x) {
  const auto& p = line.points;
  if (x <= p.front().x) return p.front().y;
  for (std::size_t i = 1; i < p.size(); ++i)
    if (x <= p[i].x && p[i].x > p[i - 1].x)
      return p[i - 1].y + (p[i].y - p[i - 1].y) * (x - p[i - 1].x) / (p[i].x - p[i - 1].x);
  return p.back().y;
}

/// The largest distance of a dot from the line before it, as a share of the line's range from zero.
double largest_departure(const Plot& plot) {
  double largest = 0;
  for (std::size_t s = 1; s < plot.series.size(); ++s) {
    const Series &line = plot.series[s - 1], &dots = plot.series[s];
    if (line.dots || !dots.dots) continue;
    double range = 0;
    for (const auto& p : line.points) range = std::max(range, std::abs(p.y));
    for (const auto& p : dots.points)
      largest = std::max(largest, std::abs(p.y - value_at(line, p.x)) / range);
  }
  return largest;
}

TEST(SensorFigures, WhatWasMeasuredLiesOnWhatWasPublished) {
  // Shares of the range: what so many random numbers leave open, and whole pixels and steps.
  const std::map<std::string, double> tolerance = {
      {"Depth noise along the axis", 0.0},
  };
  std::size_t seen = 0;
  for (const auto& plots : {depth_figures(), light_figures(), label_figures()})
    for (const Plot& plot : plots) {
      const auto found = tolerance.find(plot.title);
      ++seen;
      const double departure = largest_departure(plot);
      std::string dots;
      for (const Series& s : plot.series)
        if (s.dots)
          for (const auto& p : s.points) dots += " " + std::to_string(p.y);
      EXPECT_LE(departure, found == tolerance.end() ? 0.0 : found->second) << plot.title << dots;
    }
  EXPECT_EQ(seen, 15u);
}

}  // namespace
}  // namespace mh
