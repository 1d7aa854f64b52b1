// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "slam/core/random.hpp"

namespace mh::handheld {

/// A signal of a given root mean square with its power spread evenly over a band: 16 sines of
/// seeded frequency and phase.
class BandNoise {
 public:
  BandNoise(RandomStream stream, double rms, double low_hz, double high_hz);
  double at(double t_s) const;

 private:
  std::array<std::pair<double, double>, 16> sines_;  ///< rate, phase
  double amplitude_ = 0;
};

/// Smooths with a Gaussian window; the end values are repeated beyond the ends.
std::vector<double> smoothed(const std::vector<double>& values, double sigma_frames);

}  // namespace mh::handheld
