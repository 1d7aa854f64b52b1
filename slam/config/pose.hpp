// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/setting.hpp"

namespace mh {

struct PoseConfig {
  int rounds = 4;              ///< after each round, the inlier set is recomputed
  int iterations = 10;         ///< Gauss-Newton steps per round
  double chi2_mono = 5.991;    ///< 95 % quantile of chi-square, 2 degrees of freedom
  double chi2_stereo = 7.815;  ///< 95 % quantile of chi-square, 3 degrees of freedom
  int min_inliers = 10;
  friend bool operator==(const PoseConfig&, const PoseConfig&) = default;
};

template <MaybeConst<PoseConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [rounds, iterations, chi2_mono, chi2_stereo, min_inliers] = c;
  v("rounds", rounds, {1, 100}, "the inlier set is recomputed after each round");
  v("iterations", iterations, {1, 1000}, "Gauss-Newton steps per round");
  v("chi2_mono", chi2_mono, setting::kGate, "gate of an observation without depth");
  v("chi2_stereo", chi2_stereo, setting::kGate, "gate of an observation with depth");
  v("min_inliers", min_inliers, setting::kPoints, "with fewer, there is no pose");
}

struct RansacConfig {
  int max_iterations = 300;
  double confidence = 0.99;
  int min_inliers = 10;
  friend bool operator==(const RansacConfig&, const RansacConfig&) = default;
};

template <MaybeConst<RansacConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [max_iterations, confidence, min_inliers] = c;
  v("max_iterations", max_iterations, setting::kCount, "of RANSAC");
  v("confidence", confidence, setting::kOpenShare, "of RANSAC");
  v("min_pnp_inliers", min_inliers, setting::kPoints, "inliers that a PnP pose needs");
}

}  // namespace mh
