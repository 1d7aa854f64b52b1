// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/report/drawing/plot.hpp"
#include "bench/results/graded.hpp"

namespace mh {

/// Tables of success by each graded quantity; empty without graded queries.
std::string graded_table(const Suite& suite, std::span<const Row> rows);

/// The same curves as JSON; an empty list without graded queries.
nlohmann::ordered_json graded_json(const Suite& suite, std::span<const Row> rows);

/// "graded-exact-pepper.png"
std::string graded_image_name(const Labels& labels, const Level& level);

/// The curves of one level and kind of labels: one panel per curve, with a line per system and 95 %
/// intervals.
struct GradedChart {
  std::string file;  ///< its name
  PlotPage page;
};
std::vector<GradedChart> graded_charts(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
