// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/report/drawing/plot.hpp"
#include "bench/results/spread.hpp"
#include "bench/results/stress_results.hpp"
#include "bench/suite/suite.hpp"

namespace mh {

// The sheet of a stress test: for each dial, the dose at which each system breaks.

/// For a terminal: a row per dial, a column per system, then their ratios.
std::string stress_text(const Suite& suite, const StressResults& results);
/// The same as a LaTeX table.
std::string stress_latex(const Suite& suite, const StressResults& results);
/// Breaking points, ratios, and the curves that they come from.
nlohmann::ordered_json stress_json(const Suite& suite, const StressResults& results);
/// A panel per dial: what is left of the answers without the fault, over the dose.
PlotPage stress_plots(const Suite& suite, const StressResults& results);
/// How far answers move under changes that should not matter, in cm; what that can tell, and what
/// not.
std::string spread_text(const std::vector<Spread>& all);
nlohmann::ordered_json spread_json(const std::vector<Spread>& all);
/// A page that shows the table and the file of stress_plots().
std::string stress_html(const Suite& suite, const StressResults& results, const std::string& image);

}  // namespace mh
