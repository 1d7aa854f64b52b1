// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace mh {

/// Points of one plot: a line for the source's formula, dots for measurements. The first two series
/// have one color, the next two another, and so on.
struct Series {
  std::string name;  ///< empty: not in the legend
  bool dots = false;
  std::vector<cv::Point2d> points;
  std::vector<std::pair<double, double>> bars = {};  ///< from, to, at each point; or empty
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
};

/// Draws plots side by side, three in a row, each with linear axes from zero or the lowest value.
cv::Mat draw_plots(const std::string& title, const std::vector<Plot>& plots);

}  // namespace mh
