// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/report/text_table.hpp"
#include "bench/results/rows.hpp"

namespace mh {

/// The table of a suite of many places, in the form of the paper's Table 1: a row per category and
/// system, then how the systems differ over scenes. On a screen, it contains only the rows for all
/// categories together.
std::string scenes_table(const Suite& suite, std::span<const Row> rows,
                         Extent extent = Extent::kWhole);

}  // namespace mh
