// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace mh {

/// Weights of a Gaussian at 0, 1, 2, ... pixels from its center; the whole two-sided kernel sums to
/// one.
/// @param sigma_px  above 0; the kernel ends at 3.5 sigma
std::vector<float> gaussian_kernel(double sigma_px);

}  // namespace mh
