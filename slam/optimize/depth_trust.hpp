// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "slam/core/camera.hpp"
#include "slam/optimize/pose.hpp"

namespace mh {

/// How much a frame's depths disagree with its image: a chi-square statistic, divided by the lower
/// quartile that it has if depth errors are independent, with standard deviation
/// Camera::disparity_sigma_px. nullopt if fewer than 30 observations have depth, or if these do not
/// determine the three motions that change depth.
///
/// At a pose that minimizes the sum of the depths' cost and the image's cost, the gradient g of the
/// former is balanced by that of the latter. With H = H_image + H_depth, g has the covariance C =
/// H_depth - H_depth H^-1 H_depth, and g^T C^-1 g is chi-square with 3 degrees of freedom: depths
/// change with the motion along the optical axis and about the two other axes. Depth errors that
/// are correlated over a part of the image (warped depth, a wrong scale, depth read at a wrong
/// pixel) pull the pose harder than independent errors do, however small each error is, and it is
/// this pull that harms a pose. This is the test of the information matrix (White, Econometrica
/// 50(1), 1982) with frames as clusters.
/// @pre camera_from_world minimizes the observations' residuals
std::optional<double> depth_disagreement(std::span<const PoseObservation> observations,
                                         const SE3& camera_from_world, const Camera& camera);

/// The standard deviation of disparity after one more frame. It is determined by the frames that
/// agree best, since in others the map may be at fault: a quarter of all frames should have a
/// disagreement below 1. Stochastic approximation (Robbins and Monro 1951) of this quantile on a
/// logarithmic scale.
/// @param frames  number of frames on which the estimate is based so far
double learned_disparity_sigma_px(double disparity_sigma_px, int frames, double disagreement);

}  // namespace mh
