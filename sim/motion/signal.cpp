// SPDX-License-Identifier: Apache-2.0
#include "sim/motion/signal.hpp"

#include <algorithm>
#include <cmath>

namespace mh::handheld {

BandNoise::BandNoise(RandomStream stream, double rms, double low_hz, double high_hz) {
  for (std::size_t i = 0; i < sines_.size(); ++i) {
    const double share = (static_cast<double>(i) + stream.uniform(2 * i)) / sines_.size();
    sines_[i] = {2 * M_PI * (low_hz + share * (high_hz - low_hz)),
                 2 * M_PI * stream.uniform(2 * i + 1)};
  }
  amplitude_ = rms * std::sqrt(2.0 / sines_.size());
}

double BandNoise::at(double t_s) const {
  double sum = 0;
  for (const auto& [rate, phase] : sines_) sum += std::sin(rate * t_s + phase);
  return amplitude_ * sum;
}

std::vector<double> smoothed(const std::vector<double>& values, double sigma_frames) {
  const auto n = static_cast<int>(values.size());
  const int reach = static_cast<int>(std::ceil(3 * sigma_frames));
  std::vector<double> weight;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    weight.push_back(std::exp(-0.5 * k * k / (sigma_frames * sigma_frames)));
    sum += weight.back();
  }
  std::vector<double> result(values.size());
  for (int i = 0; i < n; ++i) {
    double mean = 0;
    for (int k = -reach; k <= reach; ++k)
      mean += weight[static_cast<std::size_t>(k + reach)] *
              values[static_cast<std::size_t>(std::clamp(i + k, 0, n - 1))];
    result[static_cast<std::size_t>(i)] = mean / sum;
  }
  return result;
}

}  // namespace mh::handheld
