// SPDX-License-Identifier: Apache-2.0
#include <immintrin.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "sim/render/colour.hpp"
#include "sim/render/embree_scene.hpp"
#include "sim/render/parallel.hpp"
#include "sim/render/renderer.hpp"
#include "sim/render/texture.hpp"

namespace mh {
namespace {

constexpr int kTile = 4;  // a packet is a tile of 4 x 4 pixels
constexpr int kLanes = 16;

/// All that shading needs of a face, in one cache line.
struct alignas(64) FaceRecord {
  std::array<float, 6> uv{};  // of its three corners
  /// Per corner: light x vertex colour x base colour x exposure; halves, the fourth unused.
  std::array<std::uint16_t, 12> gain{};
  float texels = 0;  // twice its area in texels of level 0
  std::uint16_t material = 0;
  InstanceId instance = 0;
  ClassId class_id = kVoid;
};
static_assert(sizeof(FaceRecord) == 64);

struct Surface {
  MipTexture texture;
  __m128 emission;  // x exposure
};

void store_halves(std::uint16_t* out, const Eigen::Vector3f& value) {
  const __m128i halves =
      _mm_cvtps_ph(_mm_setr_ps(value.x(), value.y(), value.z(), 0.0F), _MM_FROUND_TO_NEAREST_INT);
  std::memcpy(out, &halves, 4 * sizeof(std::uint16_t));
}

__m128 load_halves(const std::uint16_t* in) {
  return _mm_cvtph_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(in)));
}

FaceRecord make_record(const Scene& scene, const std::vector<Surface>& surfaces, std::size_t face,
                       float exposure) {
  FaceRecord record;
  record.class_id = scene.class_of[face];
  record.instance = scene.instance_of[face];
  Eigen::Vector3f base = Eigen::Vector3f::Ones();
  const MipTexture* texture = nullptr;
  if (!scene.materials.empty()) {
    record.material = scene.material_of[face];
    base = srgb_to_linear(scene.materials[record.material].base_colour);
    texture = &surfaces[record.material].texture;
    if (scene.uvs.empty() && !texture->empty()) base = base.cwiseProduct(texture->mean());
  }
  const auto& corners = scene.triangles[face];
  for (std::size_t k = 0; k < 3; ++k) {
    Eigen::Vector3f gain = base * exposure;
    if (!scene.colours.empty()) gain = gain.cwiseProduct(srgb_to_linear(scene.colours[corners[k]]));
    if (!scene.light.empty()) gain = gain.cwiseProduct(scene.light[corners[k]]);
    store_halves(record.gain.data() + 4 * k, gain);
    if (!scene.uvs.empty()) {
      record.uv[2 * k] = scene.uvs[corners[k]].x();
      record.uv[2 * k + 1] = scene.uvs[corners[k]].y();
    }
  }
  if (texture && !texture->empty()) {
    const auto& t = record.uv;
    const float twice_area_uv =
        std::abs((t[2] - t[0]) * (t[5] - t[1]) - (t[4] - t[0]) * (t[3] - t[1]));
    record.texels = twice_area_uv * static_cast<float>(texture->width()) *
                    static_cast<float>(texture->height());
  }
  return record;
}

/// log2 to within 0.09, which is all that the choice of a mip level needs.
float rough_log2(float x) {
  return static_cast<float>(std::bit_cast<std::int32_t>(x)) * 0x1.0p-23F - 127.0F;
}

/// Everything of one picture that does not change from tile to tile.
struct View {
  const Camera& camera;
  Eigen::Matrix3f rotation;     // world_from_camera
  Eigen::Vector3f origin;       // m, world
  float inverse_focal_product;  // 1 / (fx fy)
};

class EmbreeRenderer final : public Renderer {
 public:
  EmbreeRenderer(const Scene& scene, const RenderConfig& config)
      : config_(config), bvh_(scene, config.threads, config.portable) {
    for (const Material& material : scene.materials) {
      const Eigen::Vector3f e = material.emission * config.exposure;
      surfaces_.push_back({MipTexture(material.texture), _mm_setr_ps(e.x(), e.y(), e.z(), 0.0F)});
    }
    if (surfaces_.empty()) surfaces_.push_back({MipTexture(), _mm_setzero_ps()});
    records_.reserve(scene.triangles.size());
    for (std::size_t f = 0; f < scene.triangles.size(); ++f)
      records_.push_back(make_record(scene, surfaces_, f, config.exposure));
    if (scene.uvs.empty())  // the mean colours are in the records now
      for (Surface& surface : surfaces_) surface.texture = MipTexture();
    for (const Light& light : scene.lights)
      if (light.kind == Light::Kind::kSky)
        sky_ = {linear_to_srgb(light.colour.x() * config.exposure),
                linear_to_srgb(light.colour.y() * config.exposure),
                linear_to_srgb(light.colour.z() * config.exposure)};
  }

  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    const int w = camera.width_px, h = camera.height_px;
    RenderedFrame frame{Grid2d<Rgb8>(w, h), Grid2d<float>(w, h), Grid2d<ClassId>(w, h),
                        Grid2d<InstanceId>(w, h)};
    const View view{camera, world_from_camera.rotation().cast<float>(),
                    world_from_camera.translation().cast<float>(),
                    static_cast<float>(1.0 / (camera.fx_px * camera.fy_px))};
    const int tile_rows = (h + kTile - 1) / kTile;
    parallel_for(tile_rows, config_.threads, [&](int row) {
      const FlushDenormals flush;
      for (int x = 0; x < w; x += kTile) render_tile(view, x, row * kTile, frame);
    });
    return frame;
  }

 private:
  void render_tile(const View& view, int x0, int y0, RenderedFrame& frame) const {
    alignas(64) std::array<int, kLanes> valid;
    alignas(64) RTCRayHit16 packet;
    aim(view, x0, y0, valid, packet);
    bvh_.intersect16(valid.data(), packet, true);

    alignas(64) std::array<float, kLanes> footprint;  // m2 seen by a pixel x 2 area of the face
    for (int i = 0; i < kLanes; ++i) {
      const float facing = packet.hit.Ng_x[i] * packet.ray.dir_x[i] +
                           packet.hit.Ng_y[i] * packet.ray.dir_y[i] +
                           packet.hit.Ng_z[i] * packet.ray.dir_z[i];
      const float depth = packet.ray.tfar[i];
      // A pixel's cone cuts the plane z = depth in depth^2 / (fx fy); the face is tilted to that
      // plane's rays by |n . d| with d's camera z = 1, and Ng = n x 2 area.
      footprint[i] = depth * depth * view.inverse_focal_product / std::abs(facing);
    }
    for (int i = 0; i < kLanes; ++i) {
      if (valid[i] == 0) continue;
      const int x = x0 + i % kTile, y = y0 + i / kTile;
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
        frame.colour(x, y) = sky_;
        continue;
      }
      const std::uint32_t face = bvh_.face_of(packet.hit.geomID[i], packet.hit.primID[i]);
      const FaceRecord& record = records_[face];
      frame.depth_m(x, y) = packet.ray.tfar[i];
      frame.classes(x, y) = record.class_id;
      frame.instances(x, y) = record.instance;
      frame.colour(x, y) = shade(record, packet.hit.u[i], packet.hit.v[i], footprint[i]);
    }
  }

  /// Rays through the centres of a tile's pixels. Directions have camera z = 1, so that the
  /// distance along them is the depth.
  static void aim(const View& view, int x0, int y0, std::array<int, kLanes>& valid,
                  RTCRayHit16& packet) {
    const Camera& camera = view.camera;
    const Eigen::Matrix3f& r = view.rotation;
    for (int i = 0; i < kLanes; ++i) {
      const int x = x0 + i % kTile, y = y0 + i / kTile;
      valid[i] = x < camera.width_px && y < camera.height_px ? -1 : 0;
      const float a = static_cast<float>((x - camera.cx_px) / camera.fx_px);
      const float b = static_cast<float>((y - camera.cy_px) / camera.fy_px);
      packet.ray.dir_x[i] = r(0, 0) * a + r(0, 1) * b + r(0, 2);
      packet.ray.dir_y[i] = r(1, 0) * a + r(1, 1) * b + r(1, 2);
      packet.ray.dir_z[i] = r(2, 0) * a + r(2, 1) * b + r(2, 2);
      packet.ray.org_x[i] = view.origin.x();
      packet.ray.org_y[i] = view.origin.y();
      packet.ray.org_z[i] = view.origin.z();
      packet.ray.tnear[i] = 0.0F;
      packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
      packet.ray.time[i] = 0.0F;
      packet.ray.mask[i] = kAllFaces;  // Debian's Embree tests masks: 0 would hit nothing
      packet.ray.id[i] = static_cast<unsigned>(i);
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
  }

  Rgb8 shade(const FaceRecord& record, float u, float v, float footprint) const {
    const Surface& surface = surfaces_[record.material];
    const float w0 = 1.0F - u - v;
    __m128 colour = _mm_mul_ps(_mm_set1_ps(w0), load_halves(record.gain.data()));
    colour = _mm_add_ps(colour, _mm_mul_ps(_mm_set1_ps(u), load_halves(record.gain.data() + 4)));
    colour = _mm_add_ps(colour, _mm_mul_ps(_mm_set1_ps(v), load_halves(record.gain.data() + 8)));
    if (!surface.texture.empty()) {
      const float s = w0 * record.uv[0] + u * record.uv[2] + v * record.uv[4];
      const float t = w0 * record.uv[1] + u * record.uv[3] + v * record.uv[5];
      const float level = 0.5F * rough_log2(footprint * record.texels);
      colour = _mm_mul_ps(colour, _mm_mul_ps(surface.texture.sample(s, t, level),
                                             _mm_set1_ps(1.0F / MipTexture::kScale)));
    }
    colour = _mm_add_ps(colour, surface.emission);
    colour = _mm_min_ps(_mm_max_ps(colour, _mm_setzero_ps()), _mm_set1_ps(1.0F));
    alignas(16) std::array<int, 4> index;
    _mm_store_si128(reinterpret_cast<__m128i*>(index.data()),
                    _mm_cvtps_epi32(_mm_mul_ps(colour, _mm_set1_ps(kSrgbTableMax))));
    const std::uint8_t* table = srgb_table();
    return {table[index[0]], table[index[1]], table[index[2]]};
  }

  RenderConfig config_;
  EmbreeScene bvh_;
  std::vector<Surface> surfaces_;
  std::vector<FaceRecord> records_;
  Rgb8 sky_;
};

}  // namespace

std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RenderConfig& config) {
  validate(scene);
  return std::make_unique<EmbreeRenderer>(scene, config);
}

}  // namespace mh
