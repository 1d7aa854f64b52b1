// SPDX-License-Identifier: Apache-2.0
// A library that breaks the rule that no exception may leave it.
#include <modelhouse/system.h>

#include <stdexcept>

mh_system* mh_make_system(const mh_setup*) {
  throw std::runtime_error("no camera");
}
