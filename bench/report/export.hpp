// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "bench/store/store.hpp"

namespace mh {

// Exports of a store's results for the suite that was planned last. They depend on nothing but the
// results: times and workers' claims are excluded, and the order is that of the plan.

/// One line per finished run and parameter point: its identity, parameters and metrics.
std::string export_csv(const Store& store);
/// Every table except times and claims, row by row.
std::string export_json(const Store& store);
/// A table for the booktabs package, one line per row of the results.
std::string export_latex(const Store& store);
/// A text as LaTeX source.
std::string latex_cell(std::string_view text);

}  // namespace mh
