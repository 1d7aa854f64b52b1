// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "slam/core/sequence.hpp"

namespace mh {

/// Every n-th frame of a sequence, from the first, as a camera of that lower rate sees them.
std::shared_ptr<const Sequence> every_nth(std::shared_ptr<const Sequence> all, std::size_t n);

}  // namespace mh
