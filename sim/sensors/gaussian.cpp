// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/gaussian.hpp"

#include <algorithm>
#include <cmath>

namespace mh {

std::vector<float> gaussian_kernel(double sigma_px) {
  const int radius = std::max(1, static_cast<int>(std::ceil(3.5 * sigma_px)));
  std::vector<double> weights;
  double sum = 0.0;
  for (int k = 0; k <= radius; ++k) {
    weights.push_back(std::exp(-0.5 * k * k / (sigma_px * sigma_px)));
    sum += (k == 0 ? 1.0 : 2.0) * weights.back();
  }
  std::vector<float> kernel;
  for (const double weight : weights) kernel.push_back(static_cast<float>(weight / sum));
  return kernel;
}

}  // namespace mh
