// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// The last nonblank line of an open file, of its last 64 kB: a log may have any size.
std::string last_line_of(int file);

}  // namespace mh
