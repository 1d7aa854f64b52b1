// SPDX-License-Identifier: Apache-2.0
#include "scenes/generate/draft.hpp"

#include <cmath>

namespace mh::generate {

double whole_mm(double m) {
  return std::round(m * 1000.0) / 1000.0;
}

Eigen::Vector2d whole_mm(const Eigen::Vector2d& at_m) {
  return {whole_mm(at_m.x()), whole_mm(at_m.y())};
}

double half_degrees(double deg) {
  return std::round(deg * 2.0) / 2.0;
}

double draw(Dice& dice, const DrawRange& range) {
  return dice.number(range.low, range.high);
}

int draw_count(Dice& dice, const DrawRange& range) {
  return dice.whole(static_cast<int>(std::lround(range.low)),
                    static_cast<int>(std::lround(range.high)));
}

}  // namespace mh::generate
