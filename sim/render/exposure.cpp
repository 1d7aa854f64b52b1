// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "sim/render/bake.hpp"
#include "sim/render/color.hpp"
#include "sim/render/embree_scene.hpp"
#include "sim/render/texture.hpp"
#include "slam/core/random.hpp"

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

constexpr int kRays = 16;
constexpr int kViewpoints = 64;  // per room
constexpr float kEyeM = 1.1F;    // the height of a robot's camera
constexpr float kElevationRad = 0.6F;

struct Place {
  Eigen::AlignedBox3f box;
  const Room* room = nullptr;  // null: the whole bounding box
};

/// Where viewpoints are sampled: in the rooms or, without a plan, in the whole scene.
std::vector<Place> places(const Scene& scene) {
  std::vector<Place> places;
  for (const Room& room : scene.rooms) {
    Place bounds{{}, &room};
    const float eye_m = static_cast<float>(scene.floor.middle_m.z()) + kEyeM;
    for (const Eigen::Vector2d& p : room.polygon_m)
      bounds.box.extend(Vector3f(static_cast<float>(p.x()), static_cast<float>(p.y()), eye_m));
    places.push_back(bounds);
  }
  if (!places.empty()) return places;
  Place all;
  for (const Vector3f& p : scene.positions_m) all.box.extend(p);
  return {all};
}

/// Luminance of the light that leaves a face at a hit.
class Meter {
 public:
  explicit Meter(const Scene& scene) : scene_(scene) {
    for (const Material& material : scene.materials)
      albedo_.push_back(
          mean_linear(material.texture).cwiseProduct(srgb_to_linear(material.base_color)));
  }

  float at(std::uint32_t face, float u, float v) const {
    const auto& t = scene_.triangles[face];
    const std::array<float, 3> share = {1.0F - u - v, u, v};
    Vector3f out = Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      Vector3f corner = Vector3f::Ones();
      if (!scene_.light.empty()) corner = corner.cwiseProduct(scene_.light[t[k]]);
      if (!scene_.colors.empty()) corner = corner.cwiseProduct(srgb_to_linear(scene_.colors[t[k]]));
      out += share[k] * corner;
    }
    if (!albedo_.empty()) {
      const std::uint16_t material = scene_.material_of[face];
      out = out.cwiseProduct(albedo_[material]) + scene_.materials[material].emission;
    }
    return luminance(out);
  }

 private:
  const Scene& scene_;
  std::vector<Vector3f> albedo_;
};

/// Appends what sixteen rays from a point see; nothing if the point is inside something, where most
/// rays hit back faces.
void look_around(const EmbreeScene& bvh, const Meter& meter, const Vector3f& eye,
                 const RandomStream& stream, std::vector<float>& seen) {
  alignas(64) RTCRayHit16 packet;
  alignas(64) std::array<int, kRays> valid;
  valid.fill(-1);
  for (int i = 0; i < kRays; ++i) {
    const auto index = static_cast<std::uint64_t>(2 * i);
    const double heading = 2.0 * std::numbers::pi * (i + stream.uniform(index)) / kRays;
    const double rise = stream.uniform(index + 1, -kElevationRad, kElevationRad);
    packet.ray.org_x[i] = eye.x(), packet.ray.org_y[i] = eye.y(), packet.ray.org_z[i] = eye.z();
    packet.ray.dir_x[i] = static_cast<float>(std::cos(rise) * std::cos(heading));
    packet.ray.dir_y[i] = static_cast<float>(std::cos(rise) * std::sin(heading));
    packet.ray.dir_z[i] = static_cast<float>(std::sin(rise));
    packet.ray.tnear[i] = 0.0F, packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.ray.time[i] = 0.0F, packet.ray.mask[i] = kAllFaces;
    packet.ray.id[i] = 0, packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  bvh.intersect16(valid.data(), packet, false);
  int backs = 0;
  std::vector<float> found;
  for (int i = 0; i < kRays; ++i) {
    if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    backs += packet.hit.Ng_x[i] * packet.ray.dir_x[i] + packet.hit.Ng_y[i] * packet.ray.dir_y[i] +
                 packet.hit.Ng_z[i] * packet.ray.dir_z[i] >
             0.0F;
    found.push_back(meter.at(bvh.face_of(packet.hit.geomID[i], packet.hit.primID[i]),
                             packet.hit.u[i], packet.hit.v[i]));
  }
  if (2 * backs <= kRays) seen.insert(seen.end(), found.begin(), found.end());
}

}  // namespace

float suggest_exposure(const Scene& scene, float median_radiance) {
  if (scene.triangles.empty()) return 1.0F;
  const FlushDenormals flush;
  const EmbreeScene bvh(scene, 1, false);
  const Meter meter(scene);
  std::vector<float> seen;
  std::uint64_t name = 0;
  for (const Place& place : places(scene))
    for (int i = 0; i < kViewpoints; ++i) {
      const RandomStream stream = RandomStream(0).fork(name++);
      const Vector3f share(static_cast<float>(stream.uniform(100)),
                           static_cast<float>(stream.uniform(101)),
                           static_cast<float>(stream.uniform(102)));
      const Vector3f eye = place.box.min() + share.cwiseProduct(place.box.sizes());
      if (place.room == nullptr || inside(*place.room, eye.x(), eye.y()))
        look_around(bvh, meter, eye, stream, seen);
    }
  if (seen.empty()) return 1.0F;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  return *middle > 0.0F ? median_radiance / *middle : 1.0F;
}

}  // namespace mh
