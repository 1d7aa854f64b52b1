// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/results/scenes.hpp"

namespace mh {

/// "[-0.0123, +0.0456]"; "-" if there are too few pairs for an interval.
std::string interval(const Comparison& comparison);

/// Reports the differences between two systems, line by line, in one place or over scenes.
std::string comparisons_text(const Suite& suite, const Family& family);
std::string comparisons_text(const Suite& suite, const SceneFamily& family);

}  // namespace mh
