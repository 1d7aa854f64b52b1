// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo/lights.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mh::gazebo {

Light light_of(const sdf::Light& light, const Eigen::Affine3d& world_from_light) {
  const auto diffuse = light.Diffuse();
  // Gazebo shows albedo x diffuse x cosine; we show albedo x irradiance / pi, hence the factor pi.
  const float gain = std::numbers::pi_v<float> * static_cast<float>(light.Intensity());
  const Eigen::Vector3f color =
      gain * Eigen::Vector3f(diffuse.R(), diffuse.G(), diffuse.B()).cwiseMax(0.0F);
  if (light.Type() == sdf::LightType::DIRECTIONAL) {
    const auto d = light.Direction();
    const Eigen::Vector3d way = world_from_light.linear() * Eigen::Vector3d(d.X(), d.Y(), d.Z());
    Light sun{.kind = Light::Kind::kSun, .color = color};
    if (way.norm() > 0.0) sun.direction = way.normalized().cast<float>();
    return sun;
  }
  constexpr double kReference_m = 2.0;
  const double fades = light.ConstantAttenuationFactor() +
                       kReference_m * light.LinearAttenuationFactor() +
                       kReference_m * kReference_m * light.QuadraticAttenuationFactor();
  const double share = kReference_m * kReference_m / std::max(fades, 0.1);
  return {.kind = Light::Kind::kSphere,
          .position_m = world_from_light.translation().cast<float>(),
          .color = static_cast<float>(share) * color};
}

float edge_for_light_m(const Scene& scene) {
  double area_m2 = 0.0;
  for (const auto& [a, b, c] : scene.triangles)
    area_m2 += 0.5 * (scene.positions_m[b] - scene.positions_m[a])
                         .cross(scene.positions_m[c] - scene.positions_m[a])
                         .cast<double>()
                         .norm();
  constexpr double kMostFaces = 1e6, kFacesPerSquare = 4.0;  // at most, since edges are halved
  return static_cast<float>(std::max(1.0, std::sqrt(kFacesPerSquare * area_m2 / kMostFaces)));
}

}  // namespace mh::gazebo
