// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "bench/results/summary.hpp"

namespace mh {

/// A suite of one place: everything about it, a block for each level and kind of labels, then what
/// the systems differ in.
std::string place_table(const Suite& suite, std::span<const Row> rows);

}  // namespace mh
