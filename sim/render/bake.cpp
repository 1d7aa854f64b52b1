// SPDX-License-Identifier: Apache-2.0
#include "sim/render/bake.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <stdexcept>

#include <xxhash.h>

#include "sim/render/bake_points.hpp"
#include "sim/render/bake_repair.hpp"
#include "sim/render/color.hpp"
#include "sim/render/embree_scene.hpp"
#include "sim/render/parallel.hpp"
#include "sim/render/texture.hpp"
#include "slam/core/random.hpp"

namespace mh {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// Incremented whenever the same scene and config would result in different light.
constexpr std::uint64_t kBakeVersion = 2;
constexpr int kRaysAtOnce = 16;
constexpr int kVerticesPerJob = 1024;
constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// No real surface reflects more, and interreflections must fade.
constexpr float kMaxAlbedo = 0.95F;
// A vertex is inside something if more than this share of its rays hit back faces.
constexpr float kInsideShare = 0.5F;
// A side with less than this share of the scene's mean light, and of the other side's, is dark,
// like the inside of a closed box that is turned inside out.
constexpr float kDarkShare = 0.02F;
/// Evenly spread points of the unit disc (Vogel's sunflower), rotated by a random angle and shifted
/// by a random share of a step: all vertices use the same low-discrepancy pattern, each with its
/// own rotation and shift.
class DiscPattern {
 public:
  explicit DiscPattern(int count) {
    const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i)
      directions_.emplace_back(static_cast<float>(std::cos(i * golden_angle)),
                               static_cast<float>(std::sin(i * golden_angle)));
  }
  int size() const { return static_cast<int>(directions_.size()); }
  /// Point i for the given turn (cosine, sine) and shift in [0, 1).
  Vector2f at(int i, const Vector2f& turn, float shift) const {
    const float radius = std::sqrt((static_cast<float>(i) + shift) / static_cast<float>(size()));
    const Vector2f& d = directions_[static_cast<std::size_t>(i)];
    return radius *
           Vector2f(d.x() * turn.x() - d.y() * turn.y(), d.x() * turn.y() + d.y() * turn.x());
  }

 private:
  std::vector<Vector2f> directions_;
};

struct Turn {
  Vector2f rotation;
  float shift;
};

Turn random_turn(const RandomStream& stream, std::uint64_t index) {
  const double angle = stream.uniform(2 * index, 0.0, 2.0 * std::numbers::pi);
  return {{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))},
          static_cast<float>(stream.uniform(2 * index + 1))};
}

/// Computes two unit vectors that form a right-handed frame with the unit vector n.
void make_frame(const Vector3f& n, Vector3f& a, Vector3f& b) {
  a = (std::abs(n.x()) > 0.7F ? Vector3f::UnitY() : Vector3f::UnitX()).cross(n).normalized();
  b = n.cross(a);
}

void set_ray(RTCRay16& rays, int lane, const Vector3f& origin, const Vector3f& direction, float end,
             unsigned mask) {
  rays.org_x[lane] = origin.x(), rays.org_y[lane] = origin.y(), rays.org_z[lane] = origin.z();
  rays.dir_x[lane] = direction.x(), rays.dir_y[lane] = direction.y();
  rays.dir_z[lane] = direction.z();
  rays.tnear[lane] = 0.0F, rays.tfar[lane] = end, rays.time[lane] = 0.0F;
  rays.mask[lane] = mask, rays.id[lane] = 0, rays.flags[lane] = 0;
}

int whole_packets(int count) {
  return (count + kRaysAtOnce - 1) / kRaysAtOnce * kRaysAtOnce;
}

struct Gathered {
  Vector3f light = Vector3f::Zero();
  bool inside = false;
};

class Baker {
 public:
  Baker(const Scene& scene, const BakeConfig& config, const BakeWatch& watch)
      : scene_(scene),
        config_(config),
        watch_(watch),
        bvh_(scene, config.threads, config.portable, true),
        points_(scene),
        hemisphere_(whole_packets(config.samples)),
        rough_(whole_packets((config.samples + 1) / 2)),
        shadow_(whole_packets(std::max(1, config.sun_samples))) {
    valid_.fill(-1);
    for (const Light& light : scene.lights) {
      if (light.kind == Light::Kind::kSky) sky_ += light.color;
      if (light.kind == Light::Kind::kAmbient) ambient_ += light.color;
    }
    find_albedo();
    find_glow();
  }

  Colors bake() {
    const std::size_t count = points_.size();
    Colors direct(count), indirect(count, Vector3f::Zero());
    std::vector<char> inside(count, 0);
    for_each_vertex([&](std::size_t v) { direct[v] = direct_light(v, 1.0F); });
    // Round 0 gathers only sky and emission; each later round adds one interreflection.
    for (int round = 0; round <= config_.bounces; ++round) {
      leaving_ = round == 0 ? Colors(count, Vector3f::Zero()) : light_leaving(direct, indirect);
      Colors next(count);
      for_each_vertex([&](std::size_t v) {
        const Gathered gathered = gather(v, 1.0F, round);
        next[v] = gathered.light;
        inside[v] = gathered.inside;
      });
      indirect = std::move(next);
      repair(inside, {points_, neighbors_}, config_.smoothing, direct, indirect);
    }
    leaving_ = light_leaving(direct, indirect);
    Colors light(count);
    double total = 0.0;
    for (std::size_t v = 0; v < count; ++v) {
      light[v] = direct[v] + indirect[v];
      total += luminance(light[v]);
    }
    const float dark =
        kDarkShare *
        static_cast<float>(total / static_cast<double>(std::max<std::size_t>(1, count)));
    for_each_vertex([&](std::size_t v) {
      if (inside[v] || luminance(light[v]) > dark) return;
      const Vector3f other = direct_light(v, -1.0F) + gather(v, -1.0F, config_.bounces).light;
      if (luminance(light[v]) <= kDarkShare * luminance(other)) light[v] = other;
    });
    if (!ambient_.isZero(0.0F))
      for (Vector3f& at_vertex : light) at_vertex += ambient_;
    return light;
  }

 private:
  template <class Work>
  void for_each_vertex(const Work& work) const {
    const int jobs = static_cast<int>((points_.size() + kVerticesPerJob - 1) / kVerticesPerJob);
    parallel_for(jobs, config_.threads, [&](int job) {
      const FlushDenormals flush;
      const std::size_t begin = static_cast<std::size_t>(job) * kVerticesPerJob;
      const std::size_t end = std::min(points_.size(), begin + kVerticesPerJob);
      for (std::size_t v = begin; v < end; ++v) work(v);
      note_job(jobs);
    });
  }

  /// Reports progress over all rounds: lamps and suns, each bounce, and the backs of dark
  /// surfaces.
  void note_job(int jobs_of_round) const {
    if (!watch_) return;
    const std::lock_guard lock(watching_);
    const int rounds = config_.bounces + 3;
    watch_(static_cast<double>(++jobs_done_) / (static_cast<double>(jobs_of_round) * rounds));
  }

  void find_albedo() {
    for (const Material& material : scene_.materials) {
      const Vector3f albedo =
          mean_linear(material.texture).cwiseProduct(srgb_to_linear(material.base_color));
      albedo_.push_back(albedo.cwiseMin(kMaxAlbedo));
    }
    if (albedo_.empty()) albedo_.push_back(Vector3f::Constant(kMaxAlbedo));
  }

  /// The radiance that each face emits; 0 for the faces of a lamp, whose light is computed from the
  /// lamp.
  void find_glow() {
    glow_.assign(scene_.triangles.size(), Vector3f::Zero());
    for (std::size_t f = 0; f < glow_.size(); ++f) {
      if (scene_.materials.empty()) break;
      const Vector3f& emission = scene_.materials[scene_.material_of[f]].emission;
      if (emission.isZero()) continue;
      const auto& t = scene_.triangles[f];
      const Vector3f center =
          (scene_.positions_m[t[0]] + scene_.positions_m[t[1]] + scene_.positions_m[t[2]]) / 3.0F;
      const bool of_a_lamp =
          std::any_of(scene_.lights.begin(), scene_.lights.end(), [&](const Light& light) {
            return light.kind == Light::Kind::kSphere &&
                   (light.position_m - center).norm() < std::max(0.3F, 3.0F * light.radius_m);
          });
      if (!of_a_lamp) glow_[f] = emission;
    }
  }

  /// Irradiance / pi from suns and lamps on one side of a vertex.
  Vector3f direct_light(std::size_t v, float side) const {
    Vector3f irradiance = Vector3f::Zero();
    for (std::size_t l = 0; l < scene_.lights.size(); ++l) {
      const Light& light = scene_.lights[l];
      if (light.kind == Light::Kind::kSky || light.kind == Light::Kind::kAmbient) continue;
      const Turn turn = random_turn(RandomStream(config_.seed).fork(1000 + l), v);
      irradiance +=
          light.color * (light.kind == Light::Kind::kSun ? sun_share(light, v, side, turn)
                                                         : lamp_share(light, v, side, turn));
    }
    return irradiance / kPi;
  }

  /// Mean over the sun's disc of cosine x visibility.
  float sun_share(const Light& sun, std::size_t v, float side, const Turn& turn) const {
    const Vector3f normal = side * points_.normal(v), to_sun = -sun.direction.normalized();
    if (normal.dot(to_sun) <= -sun.angular_radius_rad) return 0.0F;
    Vector3f a, b;
    make_frame(to_sun, a, b);
    return shadowed_mean(
        v, side, turn, [&](const Vector2f& p, const Vector3f&, Vector3f& way, float& end) {
          way = (to_sun + std::tan(sun.angular_radius_rad) * (p.x() * a + p.y() * b)).normalized();
          end = kInfinity;
          return normal.dot(way);
        });
  }

  /// Mean over the lamp's disc, as seen from the point, of cosine x visibility / distance^2.
  float lamp_share(const Light& lamp, std::size_t v, float side, const Turn& turn) const {
    const Vector3f normal = side * points_.normal(v);
    const float nearest = std::max(lamp.radius_m * lamp.radius_m, 1e-4F);
    return shadowed_mean(v, side, turn,
                         [&](const Vector2f& p, const Vector3f& origin, Vector3f& way, float& end) {
                           const Vector3f to_lamp = lamp.position_m - origin;
                           Vector3f a, b;
                           make_frame(to_lamp.normalized(), a, b);
                           way = to_lamp + lamp.radius_m * (p.x() * a + p.y() * b);
                           end = 0.999F;  // what is at the lamp does not block its light
                           const float square = way.squaredNorm();
                           return normal.dot(way) / std::sqrt(square) / std::max(square, nearest);
                         });
  }

  /// Mean of what `aim` returns for the points of the shadow pattern; a point counts as 0 if
  /// something opaque is in the way or the source is behind the surface.
  template <class Aim>
  float shadowed_mean(std::size_t v, float side, const Turn& turn, const Aim& aim) const {
    float sum = 0.0F;
    for (int first = 0; first < shadow_.size(); first += kRaysAtOnce) {
      alignas(64) RTCRay16 rays;
      alignas(64) std::array<int, kRaysAtOnce> valid;
      std::array<float, kRaysAtOnce> weight;
      bool any = false;
      for (int i = 0; i < kRaysAtOnce; ++i) {
        Vector3f way = Vector3f::UnitZ();
        float end = 0.0F;
        const Vector3f origin = points_.origin_m(v, first + i, turn.shift, side);
        weight[i] = aim(shadow_.at(first + i, turn.rotation, turn.shift), origin, way, end);
        valid[i] = weight[i] > 0.0F ? -1 : 0;
        any |= weight[i] > 0.0F;
        set_ray(rays, i, origin, way, end, kOpaqueFaces);
      }
      if (!any) continue;
      bvh_.occluded16(valid.data(), rays);
      for (int i = 0; i < kRaysAtOnce; ++i)
        if (valid[i] != 0 && rays.tfar[i] >= 0.0F) sum += weight[i];
    }
    return sum / static_cast<float>(shadow_.size());
  }

  /// Cosine-weighted mean of the radiance that arrives on one side of a vertex from sky, luminous
  /// faces and faces that reflect `leaving_`: irradiance / pi.
  Gathered gather(std::size_t v, float side, int round) const {
    const Vector3f normal = side * points_.normal(v);
    // Earlier rounds use fewer rays, since the last round averages out their noise over many faces.
    const DiscPattern& pattern = round < config_.bounces ? rough_ : hemisphere_;
    Vector3f a, b;
    make_frame(normal, a, b);
    const Turn turn =
        random_turn(RandomStream(config_.seed).fork(static_cast<std::uint64_t>(round)), v);
    Vector3f sum = Vector3f::Zero();
    int backs = 0;
    for (int first = 0; first < pattern.size(); first += kRaysAtOnce) {
      alignas(64) RTCRayHit16 packet;
      for (int i = 0; i < kRaysAtOnce; ++i) {
        const Vector2f p = pattern.at(first + i, turn.rotation, turn.shift);
        const float up = std::sqrt(std::max(0.0F, 1.0F - p.squaredNorm()));
        set_ray(packet.ray, i, points_.origin_m(v, first + i, turn.shift, side),
                p.x() * a + p.y() * b + up * normal, kInfinity, kAllFaces);
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      }
      bvh_.intersect16(valid_.data(), packet, false);
      for (int i = 0; i < kRaysAtOnce; ++i) {
        if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
          sum += sky_;
          continue;
        }
        sum += radiance_at(packet.hit, i);
        backs += packet.hit.Ng_x[i] * packet.ray.dir_x[i] +
                     packet.hit.Ng_y[i] * packet.ray.dir_y[i] +
                     packet.hit.Ng_z[i] * packet.ray.dir_z[i] >
                 0.0F;
      }
    }
    const auto rays = static_cast<float>(pattern.size());
    return {sum / rays, static_cast<float>(backs) > kInsideShare * rays};
  }

  Vector3f radiance_at(const RTCHit16& hit, int lane) const {
    const std::uint32_t face = bvh_.face_of(hit.geomID[lane], hit.primID[lane]);
    const auto& t = scene_.triangles[face];
    const float u = hit.u[lane], w = hit.v[lane];
    const Vector3f light =
        (1.0F - u - w) * leaving_[t[0]] + u * leaving_[t[1]] + w * leaving_[t[2]];
    const std::size_t material = scene_.materials.empty() ? 0 : scene_.material_of[face];
    return albedo_[material].cwiseProduct(light) + glow_[face];
  }

  /// Per vertex: light x vertex color; the material's factor is applied with the face.
  Colors light_leaving(const Colors& direct, const Colors& indirect) const {
    Colors leaving(direct.size());
    for (std::size_t v = 0; v < leaving.size(); ++v) {
      leaving[v] = direct[v] + indirect[v];
      if (!scene_.colors.empty())
        leaving[v] = leaving[v].cwiseProduct(srgb_to_linear(scene_.colors[v]));
    }
    return leaving;
  }

  const Scene& scene_;
  const BakeConfig config_;
  const BakeWatch& watch_;
  mutable std::mutex watching_;
  mutable int jobs_done_ = 0;
  EmbreeScene bvh_;
  BakePoints points_;
  VertexNeighbors neighbors_{scene_};
  DiscPattern hemisphere_, rough_, shadow_;
  alignas(64) std::array<int, kRaysAtOnce> valid_{};
  Colors albedo_;  // by material
  Colors glow_;    // by face
  Vector3f sky_ = Vector3f::Zero(), ambient_ = Vector3f::Zero();
  Colors leaving_;  // by vertex, of the previous round
};

}  // namespace

std::uint64_t digest(const BakeConfig& config) {
  const std::array<std::uint64_t, 7> fields = {kBakeVersion,
                                               static_cast<std::uint64_t>(config.samples),
                                               static_cast<std::uint64_t>(config.bounces),
                                               static_cast<std::uint64_t>(config.sun_samples),
                                               static_cast<std::uint64_t>(config.smoothing),
                                               config.seed,
                                               config.portable};
  return XXH3_64bits(fields.data(), sizeof(fields));
}

void bake_light(Scene& scene, const BakeConfig& config, const BakeWatch& watch) {
  if (config.samples < 1 || config.bounces < 0 || config.sun_samples < 0 || config.smoothing < 0)
    throw std::invalid_argument("bake_light: negative count, or samples is 0");
  validate(scene);
  scene.light = Baker(scene, config, watch).bake();
}

}  // namespace mh
