// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "slam/core/random.hpp"

namespace mh {

/// Sequential random draws. Give each draw its own statement or braced list: the evaluation order
/// of function arguments is unspecified (braced lists go from left to right).
class Dice {
 public:
  explicit Dice(RandomStream random) : random_(random) {}

  float uniform(double low, double high) { return static_cast<float>(number(low, high)); }
  double number(double low, double high) { return random_.uniform(next_++, low, high); }
  int whole(int low, int high) {  ///< both ends included
    return low +
           static_cast<int>(random_.below(next_++, static_cast<std::uint64_t>(high - low + 1)));
  }
  std::uint64_t bits() { return random_.bits(next_++); }
  bool chance(double share) { return random_.uniform(next_++) < share; }
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(random_.below(next_++, count));
  }
  template <class T>
  const T& one_of(std::span<const T> list) {
    return list[below(list.size())];
  }

 private:
  RandomStream random_;
  std::uint64_t next_ = 0;
};

}  // namespace mh
