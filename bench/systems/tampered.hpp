// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "bench/protocol/system.hpp"

namespace mh {

/// A system whose replies to track() pass through a function that may change them: the tests of
/// `verify` seed differences with it. `call` counts track calls from 0.
std::unique_ptr<System> make_tampered(std::unique_ptr<System> inner,
                                      std::function<void(std::size_t call, SystemReport&)> hand);

}  // namespace mh
