// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace mh {

/// The last nonblank line in the last 64 kB of an open file, since a log may have any size.
std::string last_line_of(int file);

}  // namespace mh
