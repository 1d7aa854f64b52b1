// SPDX-License-Identifier: Apache-2.0
#include <immintrin.h>

#include <array>
#include <cmath>
#include <limits>

#include "sim/render/colour.hpp"
#include "sim/render/embree_scene.hpp"
#include "sim/render/face_record.hpp"
#include "sim/render/parallel.hpp"
#include "sim/render/renderer.hpp"

namespace mh {
namespace {

constexpr int kTile = 4;  // a packet is a tile of 4 x 4 pixels
constexpr int kLanes = 16;
constexpr int kEdgeSamples = 2;  // beside the centre
// A pixel lies on an edge where its inverse depth departs by this share from the mean of its two
// neighbours'. A plane departs by nothing, the corner of a box at 2 m by 1e-3: edges within an
// object count where its depth jumps, not where its surface bends.
constexpr float kEdgeBend = 5e-3F;
// Where an edge pixel is sampled beside its centre, px: a third of it each, in columns and rows.
struct Offset {
  float x, y;
};
constexpr std::array<Offset, kEdgeSamples> kOffsets = {
    {{1.0F / 3.0F, -1.0F / 3.0F}, {-1.0F / 3.0F, 1.0F / 3.0F}}};

/// Everything of one picture that does not change from tile to tile.
struct View {
  View(const Camera& camera, const SE3& world_from_camera)
      : width(camera.width_px),
        height(camera.height_px),
        rotation(world_from_camera.rotation().cast<float>()),
        origin(world_from_camera.translation().cast<float>()),
        pixel_width(static_cast<float>(1.0 / camera.fx_px)),
        pixel_height(static_cast<float>(1.0 / camera.fy_px)) {
    for (int x = 0; x < width; ++x)
      column.push_back(static_cast<float>((x - camera.cx_px) / camera.fx_px));
    for (int y = 0; y < height; ++y)
      row.push_back(static_cast<float>((y - camera.cy_px) / camera.fy_px));
  }

  int width, height;
  Eigen::Matrix3f rotation;         // world_from_camera
  Eigen::Vector3f origin;           // m, world
  float pixel_width, pixel_height;  // at unit depth
  std::vector<float> column, row;   // where the pixels' centres lie at unit depth
};

/// Sixteen rays from the camera. Directions have camera z = 1, so that the distance along a ray is
/// the depth.
struct alignas(64) Packet {
  RTCRayHit16 rays;
  alignas(64) std::array<int, kLanes> valid;

  explicit Packet(const View& view) {
    for (int i = 0; i < kLanes; ++i) {
      rays.ray.org_x[i] = view.origin.x();
      rays.ray.org_y[i] = view.origin.y();
      rays.ray.org_z[i] = view.origin.z();
      rays.ray.tnear[i] = 0.0F;
      rays.ray.time[i] = 0.0F;
      rays.ray.mask[i] = kAllFaces;  // Debian's Embree tests masks: 0 would hit nothing
      rays.ray.id[i] = 0;
      rays.ray.flags[i] = 0;
    }
  }

  /// Aims a lane through the point (a, b, 1) of the camera's frame.
  void aim(const View& view, int lane, float a, float b) {
    const Eigen::Matrix3f& r = view.rotation;
    rays.ray.dir_x[lane] = r(0, 0) * a + r(0, 1) * b + r(0, 2);
    rays.ray.dir_y[lane] = r(1, 0) * a + r(1, 1) * b + r(1, 2);
    rays.ray.dir_z[lane] = r(2, 0) * a + r(2, 1) * b + r(2, 2);
    rays.ray.tfar[lane] = std::numeric_limits<float>::infinity();
    rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  }
  bool hit(int lane) const { return rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID; }
};

/// Shares of the faces' own areas (twice, m2) that one pixel sees, per lane.
std::array<float, kLanes> footprints(const View& view, const Packet& packet) {
  const RTCHit16& hit = packet.rays.hit;
  const RTCRay16& ray = packet.rays.ray;
  std::array<float, kLanes> footprint;
  for (int i = 0; i < kLanes; ++i) {
    const float facing =
        hit.Ng_x[i] * ray.dir_x[i] + hit.Ng_y[i] * ray.dir_y[i] + hit.Ng_z[i] * ray.dir_z[i];
    // A pixel cuts depth^2 / (fx fy) out of the plane z = depth; a face of unit normal n shows
    // 1 / |n . d| of that behind it, d having camera z = 1; and Ng = n x twice the face's area.
    const float depth = ray.tfar[i];
    footprint[static_cast<std::size_t>(i)] =
        depth * depth * view.pixel_width * view.pixel_height / std::abs(facing);
  }
  return footprint;
}

Rgb8 encode(__m128 linear) {
  alignas(16) std::array<int, 4> index;
  _mm_store_si128(reinterpret_cast<__m128i*>(index.data()),
                  _mm_cvtps_epi32(_mm_mul_ps(linear, _mm_set1_ps(kSrgbTableMax))));
  const std::uint8_t* table = srgb_table();
  return {table[index[0]], table[index[1]], table[index[2]]};
}

struct Pixel {
  int x, y;
};

/// The pixels of a band of rows at which something begins, tile by tile, so that those traced
/// together lie together; the picture's rim is left out.
void find_edges(const RenderedFrame& frame, int y0, std::vector<Pixel>& edges) {
  edges.clear();
  const int w = frame.depth_m.width(), h = frame.depth_m.height();
  // Inverse depths a, b, c are in line where 2/b = 1/a + 1/c.
  const auto bent = [](float a, float b, float c) {
    const float across = 2.0F * a * c, through = b * (a + c);
    return std::abs(across - through) > kEdgeBend * through;
  };
  for (int x0 = 0; x0 < w; x0 += kTile)
    for (int y = std::max(1, y0); y < std::min(h - 1, y0 + kTile); ++y) {
      const float* z = frame.depth_m.row(y).data();
      const InstanceId* id = frame.instances.row(y).data();
      for (int x = std::max(1, x0); x < std::min(w - 1, x0 + kTile); ++x) {
        const bool other = (id[x] != id[x - 1]) | (id[x] != id[x + 1]) | (id[x] != id[x - w]) |
                           (id[x] != id[x + w]);
        if (other | bent(z[x - 1], z[x], z[x + 1]) | bent(z[x - w], z[x], z[x + w]))
          edges.push_back({x, y});
      }
    }
}

class EmbreeRenderer final : public Renderer {
 public:
  EmbreeRenderer(const Scene& scene, const RenderConfig& config)
      : config_(config),
        bvh_(scene, config.threads, config.portable),
        surfaces_(make_surfaces(scene, config.exposure)) {
    const std::vector<Eigen::Vector3f> base = base_colours(scene);
    for (const std::vector<std::uint32_t>& faces : bvh_.faces()) {
      std::vector<FaceRecord>& records = records_.emplace_back();
      records.reserve(faces.size());
      for (const std::uint32_t f : faces)
        records.push_back(make_record(scene, surfaces_, base, f, config.exposure));
    }
    Eigen::Vector3f sky = Eigen::Vector3f::Zero();
    for (const Light& light : scene.lights)
      if (light.kind == Light::Kind::kSky) sky += light.colour * config.exposure;
    sky = sky.cwiseMin(1.0F);
    sky_ = _mm_setr_ps(sky.x(), sky.y(), sky.z(), 0.0F);
  }

  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    const int w = camera.width_px, h = camera.height_px;
    RenderedFrame frame{Grid2d<Rgb8>(w, h), Grid2d<float>(w, h), Grid2d<ClassId>(w, h),
                        Grid2d<InstanceId>(w, h)};
    const View view(camera, world_from_camera);
    const int tile_rows = (h + kTile - 1) / kTile;
    parallel_for(tile_rows, config_.threads, [&](int row) {
      const FlushDenormals flush;
      Packet packet(view);
      for (int x = 0; x < w; x += kTile) render_tile(view, x, row * kTile, packet, frame);
    });
    if (!config_.smooth_edges) return frame;
    parallel_for(tile_rows, config_.threads, [&](int row) {
      const FlushDenormals flush;
      Packet packet(view);
      std::vector<Pixel> edges;
      find_edges(frame, row * kTile, edges);
      for (std::size_t first = 0; first < edges.size(); first += kLanes / kEdgeSamples)
        smooth(view, edges, first, packet, frame);
    });
    return frame;
  }

 private:
  void render_tile(const View& view, int x0, int y0, Packet& packet, RenderedFrame& frame) const {
    for (int i = 0; i < kLanes; ++i) {
      const int x = x0 + i % kTile, y = y0 + i / kTile;
      packet.valid[static_cast<std::size_t>(i)] = x < view.width && y < view.height ? -1 : 0;
      packet.aim(view, i, view.column[static_cast<std::size_t>(std::min(x, view.width - 1))],
                 view.row[static_cast<std::size_t>(std::min(y, view.height - 1))]);
    }
    bvh_.intersect16(packet.valid.data(), packet.rays, true);
    const auto footprint = footprints(view, packet);
    for (int i = 0; i < kLanes; ++i) {
      if (packet.valid[static_cast<std::size_t>(i)] == 0) continue;
      const int x = x0 + i % kTile, y = y0 + i / kTile;
      frame.colour(x, y) = encode(radiance(packet, i, footprint[static_cast<std::size_t>(i)]));
      if (!packet.hit(i)) continue;
      const FaceRecord& record = record_at(packet, i);
      frame.depth_m(x, y) = packet.rays.ray.tfar[i];
      frame.classes(x, y) = record.class_id;
      frame.instances(x, y) = record.instance;
    }
  }

  /// Averages the colours of a packet's edge pixels over their samples, in linear light.
  void smooth(const View& view, const std::vector<Pixel>& edges, std::size_t first, Packet& packet,
              RenderedFrame& frame) const {
    constexpr std::size_t kPixels = kLanes / kEdgeSamples;
    const std::size_t count = std::min(kPixels, edges.size() - first);
    for (int i = 0; i < kLanes; ++i) {
      const std::size_t pixel = static_cast<std::size_t>(i) / kEdgeSamples;
      packet.valid[static_cast<std::size_t>(i)] = pixel < count ? -1 : 0;
      const auto [x, y] = edges[first + std::min(pixel, count - 1)];
      const Offset& offset = kOffsets[static_cast<std::size_t>(i) % kEdgeSamples];
      packet.aim(view, i, view.column[static_cast<std::size_t>(x)] + offset.x * view.pixel_width,
                 view.row[static_cast<std::size_t>(y)] + offset.y * view.pixel_height);
    }
    bvh_.intersect16(packet.valid.data(), packet.rays, true);
    const auto footprint = footprints(view, packet);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
      Rgb8& colour = frame.colour(edges[first + pixel].x, edges[first + pixel].y);
      __m128 sum = _mm_setr_ps(srgb_to_linear(colour.r), srgb_to_linear(colour.g),
                               srgb_to_linear(colour.b), 0.0F);
      for (int s = 0; s < kEdgeSamples; ++s) {
        const int lane = static_cast<int>(pixel) * kEdgeSamples + s;
        sum = _mm_add_ps(sum, radiance(packet, lane, footprint[static_cast<std::size_t>(lane)]));
      }
      colour = encode(_mm_mul_ps(sum, _mm_set1_ps(1.0F / (kEdgeSamples + 1))));
    }
  }

  const FaceRecord& record_at(const Packet& packet, int lane) const {
    return records_[packet.rays.hit.geomID[lane]][packet.rays.hit.primID[lane]];
  }

  /// Linear, x exposure, within [0, 1].
  __m128 radiance(const Packet& packet, int lane, float footprint) const {
    if (!packet.hit(lane)) return sky_;
    const FaceRecord& record = record_at(packet, lane);
    return shade(record, surfaces_[record.surface], packet.rays.hit.u[lane],
                 packet.rays.hit.v[lane], footprint);
  }

  RenderConfig config_;
  EmbreeScene bvh_;
  std::vector<Surface> surfaces_;
  std::vector<std::vector<FaceRecord>> records_;  // by geometry and primitive
  __m128 sky_;                                    // linear x exposure
};

}  // namespace

std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RenderConfig& config) {
  validate(scene);
  return std::make_unique<EmbreeRenderer>(scene, config);
}

}  // namespace mh
