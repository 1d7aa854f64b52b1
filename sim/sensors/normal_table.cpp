// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/normal_table.hpp"

#include <cmath>
#include <numbers>

namespace mh {
namespace {

using Table = std::array<float, 1 << kNormalBits>;

/// The x > 0 with P(X < x) = p for a standard normal X, by Newton's method on erfc.
double quantile(double p) {
  double x = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double error = 0.5 * std::erfc(-x / std::numbers::sqrt2) - p;
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
    x -= error / density;
  }
  return x;
}

Table make_table() {
  constexpr std::size_t kSize = Table{}.size(), kHalf = kSize / 2;
  std::array<double, kHalf> upper{};
  double square = 0.0;
  for (std::size_t i = 0; i < kHalf; ++i) {
    upper[i] = quantile(0.5 + (static_cast<double>(i) + 0.5) / kSize);
    square += upper[i] * upper[i];
  }
  const double scale = 1.0 / std::sqrt(square / kHalf);
  Table table{};
  for (std::size_t i = 0; i < kHalf; ++i) {
    table[kHalf + i] = static_cast<float>(scale * upper[i]);
    table[kHalf - 1 - i] = -table[kHalf + i];
  }
  return table;
}

}  // namespace

const Table& normal_table() {
  static const Table kTable = make_table();
  return kTable;
}

}  // namespace mh
