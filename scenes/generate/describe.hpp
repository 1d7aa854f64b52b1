// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/generate/draft.hpp"
#include "scenes/house/plan_file.hpp"

namespace mh::generate {

/// Converts a furnished room to a house of one room.
HouseFile describe(const Draft& draft, const std::string& name);

}  // namespace mh::generate
