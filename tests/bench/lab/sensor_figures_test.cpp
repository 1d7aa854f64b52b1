// SPDX-License-Identifier: Apache-2.0
// `modelhouse sensors plot`: each line is a published formula, each series of dots was measured on
// the model. The dots must lie on the line, or the plot shows something that the model does not do.
#include "bench/lab/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace mh {
namespace {

/// All plots, made only once since that takes some seconds.
const std::vector<Plot>& all_plots() {
  static const std::vector<Plot> plots = [] {
    std::vector<Plot> all;
    for (const auto& some : {depth_figures(), light_figures(), label_figures()})
      all.insert(all.end(), some.begin(), some.end());
    return all;
  }();
  return plots;
}

/// A line's value, interpolated between its points; beyond an end, the value at that end.
double value_at(const Series& line, double x) {
  const auto& p = line.points;
  if (x <= p.front().x) return p.front().y;
  for (std::size_t i = 1; i < p.size(); ++i)
    if (x <= p[i].x && p[i].x > p[i - 1].x)
      return p[i - 1].y + (p[i].y - p[i - 1].y) * (x - p[i - 1].x) / (p[i].x - p[i - 1].x);
  return p.back().y;
}

/// The largest distance of a dot from its line (the series before it), relative to the line's
/// largest absolute value.
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

// Largest accepted departures, relative to the line's range: for sampling errors of the random
// numbers, and for rounding to whole pixels and steps.
const std::map<std::string, double> kTolerance = {{"Depth noise along the axis", 0.02},
                                                  {"Depth noise on leaning walls, 2 m", 0.03},
                                                  {"Ragged edges", 0.015},
                                                  {"Steps of depth", 0.025},
                                                  {"Holes at grazing angles", 0},
                                                  {"Shadow before a wall at 4 m", 0.02},
                                                  {"Motion blur, 2 m away", 0.06},
                                                  {"Rolling shutter, 2 m away", 0.002},
                                                  {"Shot and read noise", 0.02},
                                                  {"Vignetting", 0.008},
                                                  {"Exposure control, light times 3 at 0 s", 0.003},
                                                  {"Lens of Pepper's upper camera", 0.13},
                                                  {"Detector: objects found", 0.04},
                                                  {"Label noise", 0.02}};

TEST(SensorFigures, WhatWasMeasuredLiesOnWhatWasPublished) {
  std::set<std::string> seen;
  for (const Plot& plot : all_plots()) {
    seen.insert(plot.title);
    if (plot.title == "Detector: how well boxes lie") {
      // Only one figure is published: the share of boxes with an IoU above 0.75 among those with an
      // IoU above 0.5.
      const auto& dots = plot.series[1].points;
      EXPECT_EQ(dots[0].x, 0.5);
      EXPECT_EQ(dots[0].y, 1.0);
      EXPECT_EQ(dots[5].x, 0.75);
      EXPECT_NEAR(dots[5].y, value_at(plot.series[0], 0.7499999), 0.02);
      EXPECT_NEAR(value_at(plot.series[0], 0.7499999), 34.4 / 57.9, 1e-6);
      continue;
    }
    ASSERT_TRUE(kTolerance.contains(plot.title)) << plot.title;
    EXPECT_LE(largest_departure(plot), kTolerance.at(plot.title)) << plot.title;
    for (const Series& series : plot.series)
      EXPECT_GT(series.points.size(), 5u) << plot.title << ": " << series.name;
  }
  EXPECT_EQ(seen.size(), kTolerance.size() + 1);
}

// The ends of each line, computed by hand from the source that it cites.
TEST(SensorFigures, LinesBeginAndEndWhereTheirFormulasDo) {
  std::map<std::string, std::array<double, 4>> ends;  // x, y of the first point and the last
  for (const Plot& plot : all_plots()) {
    const auto& p = plot.series[0].points;
    ends[plot.title] = {p.front().x, p.front().y, p.back().x, p.back().y};
  }
  const auto expect = [&](const char* title, std::array<double, 4> wanted) {
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(ends[title][k], wanted[k], 1e-9 + 1e-6 * std::abs(wanted[k])) << title << k;
  };
  // 1.2 mm + 1.9 mm/m^2 (z - 0.4 m)^2; f = 525 px, b = 0.075 m.
  expect("Depth noise along the axis", {0.5, 1.2 + 1.9 * 0.01, 5.0, 1.2 + 1.9 * 21.16});
  expect("Steps of depth",
         {0.6, 1e3 * 0.36 / (525 * 0.075 * 8), 5.0, 1e3 * 25 / (525 * 0.075 * 8)});
  expect("Shadow before a wall at 4 m",
         {0.6, 525 * 0.075 * (1 / 0.6 - 0.25), 3.9, 525 * 0.075 * (1 / 3.9 - 0.25)});
  expect("Motion blur, 2 m away", {0, 0, 2, 525 * 2 * 0.010 / 2});
  expect("Rolling shutter, 2 m away", {0, 0, 3, 525 * 3 * 0.0261 / 2});
}

}  // namespace
}  // namespace mh
