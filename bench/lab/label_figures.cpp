// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/lab/figure_tools.hpp"
#include "bench/lab/figures.hpp"
#include "sim/sensors/labels.hpp"

namespace mh {
namespace {

using namespace figure;

/// A frame with square chairs of one size in a grid, and the number of chairs.
std::pair<RenderedFrame, int> chairs(int size) {
  constexpr ClassId kChair = 5;
  RenderedFrame frame = blank(2.0F);
  InstanceId instance = 0;
  for (int top = 12; top + size + 12 < kCamera.height_px; top += size + 24)
    for (int left = 12; left + size + 12 < kCamera.width_px; left += size + 24) {
      ++instance;
      for (int y = top; y < top + size; ++y)
        for (int x = left; x < left + size; ++x) {
          frame.classes(x, y) = kChair;
          frame.instances(x, y) = instance;
        }
    }
  return {frame, instance};
}

Plot recall_over_size() {
  const auto recall = [](double size) {
    const auto [frame, count] = chairs(static_cast<int>(size));
    double found = 0, all = 0;
    for (std::uint64_t seed = 0; all < 3000; ++seed, all += count) {
      LabelConfig config{.seed = seed};
      config.detector.false_alarms = 0.0;
      found += static_cast<double>(detect(frame, config, SE3(), RandomStream(seed)).size());
    }
    return found / all;
  };
  return {"Detector: objects found",
          "size, px (root of the area)",
          "share",
          {curve("YOLOv3, table 3: AP by size x AP50 / AP", 10, 150,
                 [](double size) {
                   const double ap = size < 32 ? 0.183 : size < 96 ? 0.354 : 0.419;
                   return ap * 0.579 / 0.330;
                 }),
           measured("measured", {12, 20, 28, 36, 50, 70, 90, 100, 120, 150}, recall)}};
}

Plot boxes_over_threshold() {
  constexpr int kSize = 150;
  RenderedFrame truth = blank(2.0F);
  for (int y = 150; y < 150 + kSize; ++y)
    for (int x = 200; x < 200 + kSize; ++x) truth.classes(x, y) = 5, truth.instances(x, y) = 1;
  std::vector<double> overlaps;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    LabelConfig config{.seed = seed};
    config.detector.recall_large = 1.0;
    config.detector.false_alarms = 0.0;
    const Detection box = detect(truth, config, SE3(), RandomStream(seed)).at(0);
    const double w = std::min(box.right, 349) - std::max(box.left, 200) + 1;
    const double h = std::min(box.bottom, 299) - std::max(box.top, 150) + 1;
    const double own = (box.right - box.left + 1.0) * (box.bottom - box.top + 1.0);
    overlaps.push_back(w * h / (own + kSize * kSize - w * h));
  }
  const auto above = [&](double threshold) {
    return static_cast<double>(std::count_if(overlaps.begin(), overlaps.end(),
                                             [=](double iou) { return iou > threshold; }));
  };
  return {"Detector: how well boxes lie",
          "IoU",
          "share of those above 0.5",
          {{"YOLOv3, table 3: AP75 / AP50",
            false,
            {{0.5, 34.4 / 57.9}, {0.75, 34.4 / 57.9}, {0.75, 0}}},
           measured("measured above", {0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95},
                    [&](double t) { return above(t) / above(0.5); })}};
}

Plot labels_over_dial() {
  const auto [frame, count] = chairs(20);
  Plot plot{"Label noise", "dial", "share of instances", {}};
  plot.series.push_back(curve("the dial", 0, 1, [](double x) { return x; }));
  plot.series.push_back(measured("wrong class", {0, 0.1, 0.25, 0.5, 0.75, 1}, [&](double dial) {
    double wrong = 0, all = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed, all += count) {
      LabelConfig config{.seed = seed};
      config.noise = {.enabled = true, .confusion = dial};
      const SemanticImage seen =
          label_image(frame, LabelMode::kExact, config, SE3(), RandomStream(seed));
      for (int top = 12; top + 32 < kCamera.height_px; top += 44)
        for (int left = 12; left + 32 < kCamera.width_px; left += 44)
          wrong += seen.at(left + 9, top + 9).most_probable() != 5;
    }
    return wrong / all;
  }));
  return plot;
}

}  // namespace

std::vector<Plot> label_figures() {
  return {recall_over_size(), boxes_over_threshold(), labels_over_dial()};
}

}  // namespace mh
