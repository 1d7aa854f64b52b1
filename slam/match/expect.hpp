// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"
#include "slam/map/map.hpp"
#include "slam/match/match.hpp"
#include "slam/optimize/pose.hpp"

namespace mh {

/// scale^octave: the standard deviation (px) of a keypoint found at that octave.
float octave_scale(const FeatureConfig& config, int octave);

/// Predicts where and at which octave a landmark appears to a camera; nullopt if it is outside the
/// image, at a distance at which no octave can match it, or seen from more than 60 degrees off its
/// mean viewing direction.
/// @param radius_px  search radius at octave 0; grows with the predicted octave's scale.
std::optional<ProjectionTarget> expect(const Landmark& landmark, const SE3& camera_from_world,
                                       const Eigen::Vector3d& camera_in_world, const Camera& camera,
                                       const FeatureConfig& features, float radius_px);

/// A landmark seen at a feature, as input of the optimizers.
PoseObservation observe(const Eigen::Vector3d& point_in_world, const Keypoint& keypoint,
                        const Camera& camera, const FeatureConfig& features);

/// All landmarks that an image's features are matched to, as input of the optimizers.
/// @param landmarks  per feature; invalid = none
/// @param feature_of  receives the feature of each observation
std::vector<PoseObservation> observe(const Features& features,
                                     const std::vector<LandmarkId>& landmarks, const Map& map,
                                     const Camera& camera, const FeatureConfig& config,
                                     std::vector<std::uint32_t>& feature_of);

/// Point (m, world) behind a keypoint with depth.
Eigen::Vector3d unproject(const Keypoint& keypoint, const Camera& camera,
                          const SE3& world_from_camera);

}  // namespace mh
