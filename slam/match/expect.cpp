// SPDX-License-Identifier: Apache-2.0
#include "slam/match/expect.hpp"

#include <algorithm>
#include <cmath>

#include "slam/features/scale.hpp"

namespace mh {
namespace {
// If this view is more than 60 degrees off the mean viewing direction, the patch looks different.
constexpr double kMinViewCosine = 0.5;
// Octaves are predicted from distances known to a few percent, so the range is extended by this
// factor.
constexpr double kDistanceSlack = 1.2;
}  // namespace

float octave_scale(const FeatureConfig& config, int octave) {
  return static_cast<float>(level_scale(config, octave));
}

std::optional<ProjectionTarget> expect(const Landmark& landmark, const SE3& camera_from_world,
                                       const Eigen::Vector3d& camera_in_world, const Camera& camera,
                                       const FeatureConfig& features, float radius_px) {
  const Eigen::Vector3d point = camera_from_world * landmark.position_in_world;
  if (point.z() < 0.05) return std::nullopt;
  const Eigen::Vector2d pixel = camera.project(point);
  if (!camera.in_image(pixel.x(), pixel.y())) return std::nullopt;
  const double distance = point.norm();
  if (distance > landmark.max_distance_m * kDistanceSlack ||
      distance < landmark.min_distance_m / kDistanceSlack)
    return std::nullopt;
  const Eigen::Vector3d ray = landmark.position_in_world - camera_in_world;
  if (ray.dot(landmark.mean_direction) < kMinViewCosine * distance) return std::nullopt;

  const double ratio = landmark.max_distance_m / distance;
  const int octave =
      std::clamp(static_cast<int>(std::lround(std::log(ratio) / log_of_scale(features))), 0,
                 features.levels - 1);
  return ProjectionTarget{
      .u_px = static_cast<float>(pixel.x()),
      .v_px = static_cast<float>(pixel.y()),
      .radius_px = radius_px * octave_scale(features, octave),
      .min_octave = octave - 1,
      .max_octave = octave + 1,
      .descriptor = &landmark.descriptor,
      .label = landmark.label,
  };
}

PoseObservation observe(const Eigen::Vector3d& point_in_world, const Keypoint& keypoint,
                        const Camera& camera, const FeatureConfig& features) {
  return {.point_in_world = point_in_world,
          .u_px = keypoint.u_px,
          .v_px = keypoint.v_px,
          .disparity_px = keypoint.depth_m > 0 ? camera.disparity_px(keypoint.depth_m) : -1.0,
          .sigma_px = octave_scale(features, keypoint.octave)};
}

std::vector<PoseObservation> observe(const Features& features,
                                     const std::vector<LandmarkId>& landmarks, const Map& map,
                                     const Camera& camera, const FeatureConfig& config,
                                     std::vector<std::uint32_t>& feature_of) {
  std::vector<PoseObservation> observations;
  feature_of.clear();
  for (std::uint32_t i = 0; i < landmarks.size(); ++i)
    if (landmarks[i].valid()) {
      observations.push_back(
          observe(map.at(landmarks[i]).position_in_world, features.keypoints[i], camera, config));
      feature_of.push_back(i);
    }
  return observations;
}

Eigen::Vector3d unproject(const Keypoint& keypoint, const Camera& camera,
                          const SE3& world_from_camera) {
  return world_from_camera * camera.unproject(keypoint.u_px, keypoint.v_px, keypoint.depth_m);
}

}  // namespace mh
