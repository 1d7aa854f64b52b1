// SPDX-License-Identifier: Apache-2.0
#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "sim/render/color.hpp"
#include "sim/render/edges.hpp"
#include "sim/render/embree_scene.hpp"
#include "sim/render/packet.hpp"
#include "sim/render/parallel.hpp"
#include "sim/render/renderer.hpp"
#include "sim/render/shading.hpp"
#include "sim/render/tile.hpp"

namespace mh {
namespace {

// All packets of a tile are traced before any is shaded, so that the BVH and the shading data do
// not evict each other from the caches. All its rays are set up before any is traced, so that they
// have reached memory by the time the tracer loads them.

constexpr float kDepth16PerM = 5000.0F;

// Where an edge pixel is sampled in addition to its center: offset by 1/3 of a pixel in columns and
// rows.
constexpr std::array<Offset, 2> kEdgeOffsets = {
    {{1.0F / 3.0F, -1.0F / 3.0F}, {-1.0F / 3.0F, 1.0F / 3.0F}}};
constexpr std::size_t kEdgeSamples = kEdgeOffsets.size();
constexpr std::array<Offset, 4> kQuarters = {
    {{-0.25F, -0.25F}, {0.25F, -0.25F}, {-0.25F, 0.25F}, {0.25F, 0.25F}}};

/// What a packet's lanes show, and the image that it goes to.
template <class T>
struct Output {
  const T* lanes;
  Grid2d<T>& grid;
};

/// Working memory of a thread.
struct Scratch {
  explicit Scratch(const View& view) : packets(Tile::kPackets), seen(Tile::kPackets) {
    for (Packet& packet : packets) packet.start(view);
  }
  std::vector<Packet> packets;
  std::vector<Seen> seen;
  std::vector<Radiance> light;  // only when supersampling
  Tile tile;
  FlushDenormals flush;
};
struct EdgeScratch {
  explicit EdgeScratch(const View& view) { packet.start(view); }
  Packet packet;
  std::vector<Pixel> edges;
  FlushDenormals flush;
};

/// The panes of a scene, if it has any.
class Glass {
 public:
  Glass(const Scene& scene, const RenderConfig& config)
      : bvh_(scene, config.threads, config.portable, false, Faces::kGlass) {
    for (const std::uint16_t material : scene.material_of)
      transmission_.push_back(scene.materials[material].transmission);
  }

  /// Dims the light of a packet's lanes by the panes between camera and surface.
  void dim(const Packet& packet, Radiance& light) const {
    RTCRayHit16 rays = packet.rays;
    alignas(64) std::array<int, kLanes> valid;
    valid.fill(-1);
    for (bool any = true; any;) {
      for (int i = 0; i < kLanes; ++i) rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      bvh_.intersect16(valid.data(), rays, true);
      any = false;
      for (std::size_t i = 0; i < kLanes; ++i) {
        if (valid[i] != 0 && rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
          any = true;
          const Eigen::Vector3f& share =
              transmission_[bvh_.face_of(rays.hit.geomID[i], rays.hit.primID[i])];
          const __m128 of_lane = _mm_setr_ps(share.x(), share.y(), share.z(), 0.0F);
          const __m128 none = _mm_set1_ps(1.0F);
          light.of[i / 2] =
              _mm256_mul_ps(light.of[i / 2], i % 2 == 0 ? _mm256_set_m128(none, of_lane)
                                                        : _mm256_set_m128(of_lane, none));
          rays.ray.tnear[i] = std::nextafter(rays.ray.tfar[i], std::numeric_limits<float>::max());
          rays.ray.tfar[i] = packet.rays.ray.tfar[i];
        } else {
          valid[i] = 0;
        }
      }
    }
  }

 private:
  EmbreeScene bvh_;
  std::vector<Eigen::Vector3f> transmission_;  // by face
};

class EmbreeRenderer final : public Renderer {
 public:
  EmbreeRenderer(const Scene& scene, const RenderConfig& config)
      : config_(config),
        lit_(!scene.light.empty()),
        bvh_(scene, config.threads, config.portable),
        shading_(scene, bvh_, config.exposure) {
    if (std::ranges::any_of(scene.materials, &Material::is_pane)) glass_.emplace(scene, config);
  }

  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    return render_rows(camera, world_from_camera, 0, camera.height_px);
  }

  /// Traces and smooths whole blocks, so that the packets are the same as for the whole image.
  RenderedFrame render_rows(const Camera& camera, const SE3& world_from_camera, int first,
                            int last) const override {
    check_projection(camera);
    const View view(camera, world_from_camera);
    RenderedFrame frame = empty_frame(view.width, view.height);
    const int first_block = std::max(0, first) / kEdgeBlock;
    const int end_block = (std::min(last, view.height) + kEdgeBlock - 1) / kEdgeBlock;
    // Finding an edge takes the rows above and below it.
    const int first_tile = std::max(0, first_block * kEdgeBlock - 1) / Tile::kHeight;
    const int end_tile = std::min(end_block * kEdgeBlock / Tile::kHeight + 1,
                                  (view.height + Tile::kHeight - 1) / Tile::kHeight);
    parallel_for(
        end_tile - first_tile, config_.threads, [&] { return Scratch(view); },
        [&](int row, Scratch& scratch) {
          for (int x = 0; x < view.width; x += Tile::kWidth)
            render_tile(view, x, (first_tile + row) * Tile::kHeight, scratch, frame);
          _mm_sfence();
        });
    if (config_.antialiasing != Antialiasing::kEdges) return frame;
    parallel_for(
        end_block - first_block, config_.threads, [&] { return EdgeScratch(view); },
        [&](int row, EdgeScratch& scratch) {
          find_edges(frame, (first_block + row) * kEdgeBlock, scratch.edges);
          for (std::size_t edge = 0; edge < scratch.edges.size(); edge += kLanes / kEdgeSamples)
            smooth(view, scratch.edges, edge, scratch.packet, frame);
        });
    return frame;
  }

  Grid2d<float> render_depth(const Camera& camera, const SE3& world_from_camera) const override {
    check_projection(camera);
    const View view(camera, world_from_camera);
    Grid2d<float> depth_m(view.width, view.height, Unfilled{});
    parallel_for(
        (view.height + kSide - 1) / kSide, config_.threads, [&] { return Scratch(view); },
        [&](int row, Scratch& scratch) {
          alignas(64) std::array<int, kLanes> all;
          all.fill(-1);
          for (int x0 = 0; x0 < view.width; x0 += Tile::kWidth) {
            const int count = std::min(Tile::kPackets, (view.width - x0 + kSide - 1) / kSide);
            for (int k = 0; k < count; ++k)
              scratch.packets[static_cast<std::size_t>(k)].aim(view, x0 + kSide * k, row * kSide);
            for (int k = 0; k < count; ++k) {
              Packet& packet = scratch.packets[static_cast<std::size_t>(k)];
              bvh_.intersect16(all.data(), packet.rays, true);
              const std::array<float, kLanes> lanes = depths_of(packet);
              copy(x0 + kSide * k, row * kSide, view.width, view.height,
                   Output{lanes.data(), depth_m});
            }
          }
        });
    return depth_m;
  }

  std::vector<float> depth_at(const Camera& camera, const SE3& world_from_camera,
                              std::span<const Eigen::Vector2i> pixels) const override {
    check_projection(camera);
    const View view(camera, world_from_camera);
    const FlushDenormals flush;
    Packet packet;
    packet.start(view);
    alignas(64) std::array<int, kLanes> all;
    all.fill(-1);
    std::vector<float> depths;
    while (depths.size() < pixels.size()) {
      for (std::size_t i = 0; i < kLanes; ++i) {
        const Eigen::Vector2i& pixel = pixels[std::min(depths.size() + i, pixels.size() - 1)];
        packet.aim(view, static_cast<int>(i), {pixel.x(), pixel.y()}, {});
      }
      packet.forget_hits();
      bvh_.intersect16(all.data(), packet.rays, false);
      const std::array<float, kLanes> lanes = depths_of(packet);
      depths.insert(depths.end(), lanes.begin(), lanes.end());
    }
    depths.resize(pixels.size());
    return depths;
  }

 private:
  RenderedFrame empty_frame(int w, int h) const {
    RenderedFrame frame;
    frame.color = Grid2d<Rgb8>(w, h, Unfilled{});
    frame.depth_m = Grid2d<float>(w, h, Unfilled{});
    frame.classes = Grid2d<ClassId>(w, h, Unfilled{});
    frame.instances = Grid2d<InstanceId>(w, h, Unfilled{});
    if (lit_) frame.exposure = config_.exposure;
    const ExtraOutputs& extra = config_.extra;
    if (extra.depth16) frame.depth16 = Grid2d<std::uint16_t>(w, h);
    if (extra.faces) frame.faces = Grid2d<std::uint32_t>(w, h, kNoFace);
    if (extra.barycentric) frame.barycentric = Grid2d<std::array<float, 2>>(w, h);
    if (extra.points) frame.points_m = Grid2d<Eigen::Vector3f>(w, h, Eigen::Vector3f::Zero());
    return frame;
  }

  static std::array<float, kLanes> depths_of(const Packet& packet) {
    std::array<float, kLanes> depths;
    for (std::size_t i = 0; i < kLanes; ++i)
      depths[i] =
          packet.rays.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? 0.0F : packet.rays.ray.tfar[i];
    return depths;
  }

  /// The light that reaches the camera from what a packet's lanes show.
  Radiance light_of(const Packet& packet, const Seen& seen) const {
    Radiance light = shading_.shade(packet, seen);
    if (glass_) glass_->dim(packet, light);
    return light;
  }

  void render_tile(const View& view, int x0, int y0, Scratch& scratch, RenderedFrame& frame) const {
    const int count = std::min(Tile::kPackets, (view.width - x0 + kSide - 1) / kSide);
    const auto for_each = [&](const auto& work) {
      for (int k = 0; k < count; ++k) work(static_cast<std::size_t>(k), x0 + kSide * k);
    };
    const float pixel_area = view.pixel_width * view.pixel_height;
    std::vector<Packet>& packets = scratch.packets;
    std::vector<Seen>& seen = scratch.seen;
    const bool supersample = config_.antialiasing == Antialiasing::kSupersample;
    if (supersample) {
      scratch.light.assign(Tile::kPackets, Radiance{});
      for (const Offset& offset : kQuarters) {
        trace_tile(view, y0, for_each, offset, 0.25F * pixel_area, scratch);
        for_each([&](std::size_t k, int) {
          const Radiance light = light_of(packets[k], seen[k]);
          for (std::size_t i = 0; i < kLanes / 2; ++i)
            scratch.light[k].of[i] =
                _mm256_add_ps(scratch.light[k].of[i],
                              _mm256_mul_ps(_mm256_set1_ps(0.25F), up_to_white(light.of[i])));
        });
      }
    }
    trace_tile(view, y0, for_each, {}, pixel_area, scratch);
    for_each([&](std::size_t k, int x) {
      scratch.tile.set(k, supersample ? scratch.light[k] : light_of(packets[k], seen[k]), seen[k]);
      if (any_extra()) write_extra(packets[k], seen[k], x, y0, frame);
    });
    scratch.tile.store(x0, y0, frame);
  }

  template <class ForEach>
  void trace_tile(const View& view, int y0, const ForEach& for_each, const Offset& offset,
                  float pixel_area, Scratch& scratch) const {
    alignas(64) std::array<int, kLanes> all;
    all.fill(-1);
    std::vector<Packet>& packets = scratch.packets;
    std::vector<Seen>& seen = scratch.seen;
    for_each([&](std::size_t k, int x) { packets[k].aim(view, x, y0, offset); });
    // The records that a packet prefetches arrive while the next one is traced.
    for_each([&](std::size_t k, int) {
      bvh_.intersect16(all.data(), packets[k].rays, true);
      shading_.find_records(packets[k], seen[k]);
    });
    for_each([&](std::size_t k, int) { shading_.find_places(packets[k], pixel_area, seen[k]); });
    for_each([&](std::size_t k, int) { shading_.find_texels(seen[k]); });
  }

  /// Writes a packet's lanes to their places; those outside the image are skipped.
  template <class... T>
  static void copy(int x0, int y0, int width, int height, Output<T>... outputs) {
    const auto copy_rows = [&](auto rows, auto columns) {
      for (int y = 0; y < rows; ++y) {
        const int to = (y0 + y) * width + x0;
        (std::copy_n(outputs.lanes + kSide * y, columns, outputs.grid.data() + to), ...);
      }
    };
    if (width - x0 >= kSide && height - y0 >= kSide) {
      constexpr std::integral_constant<int, kSide> kWhole;  // a fixed size compiles to single moves
      copy_rows(kWhole, kWhole);
    } else {
      copy_rows(std::min(kSide, height - y0), std::min(kSide, width - x0));
    }
  }

  bool any_extra() const {
    const ExtraOutputs& extra = config_.extra;
    return extra.depth16 || extra.faces || extra.barycentric || extra.points;
  }

  void write_extra(const Packet& packet, const Seen& seen, int x0, int y0,
                   RenderedFrame& frame) const {
    const RTCHit16& hit = packet.rays.hit;
    const RTCRay16& ray = packet.rays.ray;
    std::array<std::uint16_t, kLanes> depth16{};
    std::array<std::uint32_t, kLanes> face;
    std::array<std::array<float, 2>, kLanes> barycentric{};
    std::array<Eigen::Vector3f, kLanes> point;
    point.fill(Eigen::Vector3f::Zero());
    face.fill(kNoFace);
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const float depth = seen.depth_m[i];
      const float units = depth * kDepth16PerM + 0.5F;
      depth16[i] = units < 65536.0F ? static_cast<std::uint16_t>(units) : std::uint16_t{0};
      face[i] = bvh_.face_of(hit.geomID[i], hit.primID[i]);
      barycentric[i] = {hit.u[i], hit.v[i]};
      point[i] = {ray.org_x[i] + depth * ray.dir_x[i], ray.org_y[i] + depth * ray.dir_y[i],
                  ray.org_z[i] + depth * ray.dir_z[i]};
    }
    const int w = frame.color.width(), h = frame.color.height();
    if (config_.extra.depth16) copy(x0, y0, w, h, Output{depth16.data(), frame.depth16});
    if (config_.extra.faces) copy(x0, y0, w, h, Output{face.data(), frame.faces});
    if (config_.extra.barycentric)
      copy(x0, y0, w, h, Output{barycentric.data(), frame.barycentric});
    if (config_.extra.points) copy(x0, y0, w, h, Output{point.data(), frame.points_m});
  }

  /// Averages the colors of a packet's edge pixels over their samples, in linear light.
  void smooth(const View& view, const std::vector<Pixel>& edges, std::size_t first, Packet& packet,
              RenderedFrame& frame) const {
    constexpr std::size_t kPixels = kLanes / kEdgeSamples;
    const std::size_t count = std::min(kPixels, edges.size() - first);
    alignas(64) std::array<int, kLanes> valid;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::size_t pixel = i / kEdgeSamples;
      valid[i] = pixel < count ? -1 : 0;
      packet.aim(view, static_cast<int>(i), edges[first + std::min(pixel, count - 1)],
                 kEdgeOffsets[i % kEdgeSamples]);
    }
    packet.forget_hits();
    bvh_.intersect16(valid.data(), packet.rays, true);
    Seen seen;
    shading_.find_records(packet, seen);
    shading_.find_places(packet, view.pixel_width * view.pixel_height, seen);
    shading_.find_texels(seen);
    const Radiance light = light_of(packet, seen);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
      Rgb8& color = frame.color(edges[first + pixel].x, edges[first + pixel].y);
      static_assert(kEdgeSamples == 2);
      const __m256 two = up_to_white(light.of[pixel]);
      const __m128 center = _mm_setr_ps(srgb_to_linear(color.r), srgb_to_linear(color.g),
                                        srgb_to_linear(color.b), 0.0F);
      const __m128 sum = _mm_add_ps(
          center, _mm_add_ps(_mm256_castps256_ps128(two), _mm256_extractf128_ps(two, 1)));
      const __m256 mean = _mm256_castps128_ps256(_mm_mul_ps(sum, _mm_set1_ps(1.0F / 3.0F)));
      const __m256 means[] = {mean, mean, mean, mean};
      std::array<Rgb8, 16> encoded;
      encode(means, &encoded[0], &encoded[8]);
      color = encoded[0];
    }
  }

  RenderConfig config_;
  bool lit_;
  EmbreeScene bvh_;
  Shading shading_;
  std::optional<Glass> glass_;
};

}  // namespace

std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RenderConfig& config) {
  validate(scene);
  return std::make_unique<EmbreeRenderer>(scene, config);
}

}  // namespace mh
