// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/report/text_table.hpp"
#include "bench/results/rows.hpp"

namespace mh {

/// The table of a suite of one place: a block for each level and kind of labels, then how the
/// systems differ. On a screen, a block contains only the table in the form of the paper's Table 2,
/// and the mapping.
std::string place_table(const Suite& suite, std::span<const Row> rows,
                        Extent extent = Extent::kWhole);

}  // namespace mh
