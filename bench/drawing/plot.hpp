// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace mh {

/// Points of one plot: a line for the source's formula, dots for measurements.
struct Series {
  std::string name;
  bool dots = false;
  std::vector<cv::Point2d> points;
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series;
};

/// Draws plots side by side, three in a row, each with linear axes from zero or the lowest value.
cv::Mat draw_plots(const std::string& title, const std::vector<Plot>& plots);

}  // namespace mh
