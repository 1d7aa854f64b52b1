// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "slam/optimize/pose.hpp"

namespace mh {

/// RANSAC over EPnP (Lepetit, Moreno-Noguer, Fua, IJCV 2009; OpenCV's) on four observations at a
/// time, as ORB-SLAM2 searches for a pose: a consensus has at least half of the observations, and
/// at least config.min_inliers of them. After each consensus, the largest one so far is solved
/// again from all of its inliers and, if still large enough, offered; at the end, the largest of
/// all is offered as it is. Draws depend only on the stream.
/// @param accept  receives an offered pose with its inliers; returning true ends the search
void for_each_epnp_consensus(std::span<const PoseObservation> observations, const Camera& camera,
                             const RansacConfig& config, const PoseConfig& pose,
                             RandomStream stream,
                             const std::function<bool(const PoseEstimate&)>& accept);

}  // namespace mh
