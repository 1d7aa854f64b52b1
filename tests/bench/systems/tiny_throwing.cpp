// SPDX-License-Identifier: Apache-2.0
// A library that breaks the rule that no exception may leave it, and sets the processor to round
// what is very small to zero, as code made with -ffast-math does when it is loaded.
#include <modelhouse/system.h>
#include <xmmintrin.h>

#include <stdexcept>

namespace {

const bool fast = [] {
  _mm_setcsr(_mm_getcsr() | 0x8040);
  return true;
}();

}  // namespace

mh_system* mh_make_system(const mh_setup*) {
  throw std::runtime_error(fast ? "no camera" : "");
}
