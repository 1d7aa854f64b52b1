// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace mh {

/// Weights of the pixels 0, 1, 2, ... aside of a Gaussian; the whole kernel sums to one.
/// @param sigma_px  above 0; the kernel ends 3.5 of them aside
std::vector<float> gaussian_kernel(double sigma_px);

}  // namespace mh
