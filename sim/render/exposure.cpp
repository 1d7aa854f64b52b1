// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "sim/render/bake.hpp"
#include "sim/render/colour.hpp"
#include "sim/render/texture.hpp"

namespace mh {
namespace {

using Eigen::Vector3f;

bool inside(const Room& room, double x, double y) {
  bool odd = false;
  const auto& p = room.polygon_m;
  for (std::size_t i = 0, j = p.size() - 1; i < p.size(); j = i++)
    if ((p[i].y() > y) != (p[j].y() > y) &&
        x < (p[j].x() - p[i].x()) * (y - p[i].y()) / (p[j].y() - p[i].y()) + p[i].x())
      odd = !odd;
  return odd;
}

/// Whether a point just before a face's front lies in a room (or the scene has no plan).
bool shows_into_a_room(const Scene& scene, const Vector3f& centre, const Vector3f& normal) {
  constexpr float kBeforeM = 0.05F;
  const Vector3f p = centre + kBeforeM * normal;
  return scene.rooms.empty() || std::any_of(scene.rooms.begin(), scene.rooms.end(),
                                            [&](const Room& r) { return inside(r, p.x(), p.y()); });
}

}  // namespace

float suggest_exposure(const Scene& scene, float median_radiance) {
  Vector3f one = Vector3f::Ones();
  std::vector<Vector3f> albedo;
  for (const Material& material : scene.materials)
    albedo.push_back(
        mean_linear(material.texture).cwiseProduct(srgb_to_linear(material.base_colour)));
  std::vector<std::pair<float, float>> radiance_and_area;
  double total = 0.0;
  for (std::size_t f = 0; f < scene.triangles.size(); ++f) {
    const auto& t = scene.triangles[f];
    const Vector3f &a = scene.positions_m[t[0]], &b = scene.positions_m[t[1]],
                   &c = scene.positions_m[t[2]];
    const Vector3f n = (b - a).cross(c - a);
    const float area = 0.5F * n.norm();
    if (area <= 0.0F || !shows_into_a_room(scene, (a + b + c) / 3.0F, n.normalized())) continue;
    Vector3f out = Vector3f::Zero();
    for (const std::uint32_t v : t)
      out += (scene.light.empty() ? one : scene.light[v])
                 .cwiseProduct(scene.colours.empty() ? one : srgb_to_linear(scene.colours[v])) /
             3.0F;
    if (!albedo.empty()) out = out.cwiseProduct(albedo[scene.material_of[f]]);
    radiance_and_area.emplace_back(luminance(out), area);
    total += area;
  }
  std::sort(radiance_and_area.begin(), radiance_and_area.end());
  double passed = 0.0;
  for (const auto& [radiance, area] : radiance_and_area) {
    passed += area;
    if (passed >= 0.5 * total) return radiance > 0.0F ? median_radiance / radiance : 1.0F;
  }
  return 1.0F;
}

}  // namespace mh
