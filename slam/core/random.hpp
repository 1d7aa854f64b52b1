// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace mh {

/// Mixes a 64-bit value so that every input bit reaches every output bit (the finalizer of Steele,
/// Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014).
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Counter-based random numbers: each draw is a pure function of (key, index), so no draw depends
/// on the order or thread of the others. Keys are derived, never shared:
/// RandomStream(seed).fork(kDepthNoise).fork(frame).uniform(pixel).
class RandomStream {
 public:
  explicit constexpr RandomStream(std::uint64_t seed = 0) : key_(mix(seed)) {}

  constexpr RandomStream fork(std::uint64_t name) const {
    return RandomStream(key_ ^ mix(name + 0x632be59bd9b4e019ULL));
  }
  constexpr std::uint64_t bits(std::uint64_t index) const {
    return mix(key_ + index * 0xd1342543de82ef95ULL);
  }
  /// Uniform in [0, 1).
  constexpr double uniform(std::uint64_t index) const {
    return static_cast<double>(bits(index) >> 11) * 0x1.0p-53;
  }
  constexpr double uniform(std::uint64_t index, double low, double high) const {
    return low + (high - low) * uniform(index);
  }
  /// Uniform in {0, ..., count - 1}; count > 0.
  constexpr std::uint64_t below(std::uint64_t index, std::uint64_t count) const {
    return static_cast<std::uint64_t>((static_cast<unsigned __int128>(bits(index)) * count) >> 64);
  }
  /// Standard normal (Box-Muller).
  double normal(std::uint64_t index) const {
    const std::uint64_t b = bits(index);
    const double u = (static_cast<double>(b >> 32) + 0.5) * 0x1.0p-32;
    const double v = static_cast<double>(b & 0xffffffffULL) * 0x1.0p-32;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }
  constexpr std::uint64_t key() const { return key_; }

 private:
  std::uint64_t key_;
};

}  // namespace mh
