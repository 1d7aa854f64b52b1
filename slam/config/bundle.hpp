// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/config/setting.hpp"

namespace mh {

struct BundleConfig {
  int iterations = 5;          ///< iterations with Huber's loss; then outliers are dropped
  int refine_iterations = 10;  ///< at most this many more iterations, without Huber's loss
  double relative_decrease =
      1e-3;  ///< a phase ends when a step reduces the cost by no more than this share
  double chi2_mono = 5.991;    ///< 95 % quantile of chi-square, 2 degrees of freedom
  double chi2_stereo = 7.815;  ///< 95 % quantile of chi-square, 3 degrees of freedom
  friend bool operator==(const BundleConfig&, const BundleConfig&) = default;
};

template <MaybeConst<BundleConfig> C, class Visit>
void fields(C& c, Visit& v) {
  auto& [iterations, refine_iterations, relative_decrease, chi2_mono, chi2_stereo] = c;
  v("iterations", iterations, {1, 1000}, "with Huber's loss, before outliers are dropped");
  v("refine_iterations", refine_iterations, {0, 1000},
    "at most this many more, without Huber's loss");
  v("relative_decrease", relative_decrease, setting::kShare,
    "a phase ends when a step reduces the cost by no more than this share");
  v("chi2_mono", chi2_mono, setting::kGate, "gate of an observation without depth");
  v("chi2_stereo", chi2_stereo, setting::kGate, "gate of an observation with depth");
}

}  // namespace mh
