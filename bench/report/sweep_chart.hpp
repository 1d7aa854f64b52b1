// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "bench/report/drawing/plot.hpp"
#include "bench/results/sweep_results.hpp"

namespace mh {

/// The answers over a sweep: for each query set, the share of correct answers, the share of false
/// positives, and the mean distance. A grid over one or two parameters is drawn as a heat map with
/// the values written in its cells. Any other sweep is drawn as one panel of correct answers per
/// pair of parameters, with a dot per point. The point with the most correct answers is framed; its
/// difference from the suite's own settings is printed below with its 95 % interval.
PlotPage sweep_chart(const Suite& suite, std::span<const Row> rows, const SweepResult& result);

/// "sweep-semantic-exact-pepper.png"
std::string sweep_image_name(const SystemSpec& system, const Labels& labels, const Level& level);

}  // namespace mh
