// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace mh {

using InstanceId = std::uint16_t;  ///< of an object in a scene; 0 = none

}  // namespace mh
