// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "slam/core/sequence.hpp"

namespace mh {

/// The first frames of a sequence, with the ground truth over their time span.
/// @param truth  replaces the sequence's own
/// @param gives_imu  whether its inertial readings, if there are any, are passed on
std::shared_ptr<const Sequence> first_frames(std::unique_ptr<Sequence> all, std::size_t at_most,
                                             std::optional<Trajectory> truth = std::nullopt,
                                             bool gives_imu = false);

/// Every n-th frame of a sequence, starting with the first, as a camera with that lower rate sees
/// them.
std::shared_ptr<const Sequence> every_nth(std::shared_ptr<const Sequence> all, std::size_t n);

}  // namespace mh
