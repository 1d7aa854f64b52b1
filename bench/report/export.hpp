// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/store/store.hpp"

namespace mh {

// What a store holds of the suite that was planned last. A function of the results: times and
// claims take no part, and the order is that of the plan.

/// A line per finished run and parameter point: what it is, its parameters, its metrics.
std::string export_csv(const Store& store);
/// Every table but times and claims, row by row.
std::string export_json(const Store& store);
/// A table of the booktabs package: a line per row of the results.
std::string export_latex(const Store& store);

}  // namespace mh
