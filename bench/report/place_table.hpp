// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/results/summary.hpp"

namespace mh {

/// Table of a suite of one place: a block for each level and kind of labels, then how the systems
/// differ.
std::string place_table(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
