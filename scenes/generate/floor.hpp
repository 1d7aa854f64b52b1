// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scenes/generate/generate.hpp"
#include "scenes/generate/grammar.hpp"

namespace mh::generate {

/// Rooms of one design on both sides of a corridor, those on one side turned by 180 degrees. Shape,
/// surfaces, furniture and fittings are the same in every room; only the extras are drawn for each
/// room separately.
GeneratedPlan generate_floor(const FloorGrammar& grammar, std::uint64_t seed);

}  // namespace mh::generate
