// SPDX-License-Identifier: Apache-2.0
#include <immintrin.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "sim/render/colour.hpp"
#include "sim/render/embree_scene.hpp"
#include "sim/render/face_record.hpp"
#include "sim/render/parallel.hpp"
#include "sim/render/renderer.hpp"

namespace mh {
namespace {

constexpr int kSide = 4;  // a packet is a square of 4 x 4 pixels
constexpr int kLanes = 16;
// Packets are traced a tile at a time and then shaded: the hierarchy and the shading do not push
// each other out of the caches, and the rays are long in memory when the tracer loads them.
constexpr int kTileWidth = 64, kTileHeight = 16;
constexpr int kPackets = kTileWidth * kTileHeight / kLanes;
constexpr int kEdgeBlock = 16;   // edges are followed within squares of so many pixels
constexpr int kEdgeSamples = 2;  // beside the centre
// A pixel lies on an edge where its inverse depth departs by this share from the mean of its two
// neighbours'. A plane departs by nothing, the corner of a box at 2 m by 1e-3: edges within an
// object count where its depth jumps, not where its surface bends.
constexpr float kEdgeBend = 5e-3F;
// Where an edge pixel is sampled beside its centre, px: a third of it each, in columns and rows.
struct Offset {
  float x, y;
};
struct Pixel {
  int x, y;
};
constexpr std::array<Offset, kEdgeSamples> kOffsets = {
    {{1.0F / 3.0F, -1.0F / 3.0F}, {-1.0F / 3.0F, 1.0F / 3.0F}}};

/// Everything of one picture that does not change from tile to tile. The direction through a pixel
/// is column + row, with z = 1 in the camera's frame, so that the distance along a ray is the
/// depth.
struct View {
  View(const Camera& camera, const SE3& world_from_camera)
      : width(camera.width_px),
        height(camera.height_px),
        rotation(world_from_camera.rotation().cast<float>()),
        origin(world_from_camera.translation().cast<float>()),
        pixel_width(static_cast<float>(1.0 / camera.fx_px)),
        pixel_height(static_cast<float>(1.0 / camera.fy_px)) {
    for (std::vector<float>& axis : column) axis.resize(whole(width));
    for (std::vector<float>& axis : row) axis.resize(whole(height));
    for (std::size_t x = 0; x < whole(width); ++x) {
      const double a = (static_cast<double>(x) - camera.cx_px) / camera.fx_px;
      for (int k = 0; k < 3; ++k) column[k][x] = rotation(k, 0) * static_cast<float>(a);
    }
    for (std::size_t y = 0; y < whole(height); ++y) {
      const double b = (static_cast<double>(y) - camera.cy_px) / camera.fy_px;
      for (int k = 0; k < 3; ++k)
        row[k][y] = rotation(k, 1) * static_cast<float>(b) + rotation(k, 2);
    }
  }

  static std::size_t whole(int pixels) {
    return static_cast<std::size_t>((pixels + kSide - 1) / kSide * kSide);
  }

  int width, height;
  Eigen::Matrix3f rotation;                       // world_from_camera
  Eigen::Vector3f origin;                         // m, world
  float pixel_width, pixel_height;                // at unit depth
  std::array<std::vector<float>, 3> column, row;  // world x, y, z; whole packets of them
};

/// Sixteen rays from the camera.
struct alignas(64) Packet {
  RTCRayHit16 rays{};

  void start(const View& view) {
    for (int i = 0; i < kLanes; ++i) {
      rays.ray.org_x[i] = view.origin.x();
      rays.ray.org_y[i] = view.origin.y();
      rays.ray.org_z[i] = view.origin.z();
      rays.ray.mask[i] = kAllFaces;  // Debian's Embree tests masks: 0 would hit nothing
    }
  }

  /// Aims it at the pixels from (x0, y0) on.
  void aim(const View& view, int x0, int y0) {
    const std::array<float*, 3> direction = {rays.ray.dir_x, rays.ray.dir_y, rays.ray.dir_z};
    for (std::size_t k = 0; k < 3; ++k) {
      const __m128 column = _mm_loadu_ps(view.column[k].data() + x0);
      for (int y = 0; y < kSide; ++y)
        _mm_store_ps(
            direction[k] + kSide * y,
            _mm_add_ps(column, _mm_set1_ps(view.row[k][static_cast<std::size_t>(y0 + y)])));
    }
    forget_hits();
  }

  /// Aims a lane beside a pixel's centre.
  void aim(const View& view, int lane, const Pixel& pixel, const Offset& offset) {
    const std::array<float*, 3> direction = {rays.ray.dir_x, rays.ray.dir_y, rays.ray.dir_z};
    const float a = offset.x * view.pixel_width, b = offset.y * view.pixel_height;
    for (int k = 0; k < 3; ++k)
      direction[k][lane] = view.column[k][pixel.x] + view.row[k][pixel.y] +
                           (view.rotation(k, 0) * a + view.rotation(k, 1) * b);
  }

  void forget_hits() {
    for (int i = 0; i < kLanes; ++i) {
      rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
      rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
  }
};

/// What the sixteen rays of a packet hit, on its way to the picture.
struct Seen {
  alignas(32) std::array<int, kLanes> record;  // index of FaceRecord
  alignas(32) std::array<float, kLanes> depth_m;
  std::array<InstanceId, kLanes> instance;
  std::array<ClassId, kLanes> class_id;
  std::array<bool, 2> textured;  // whether any of eight lanes is
  std::array<TextureTable::Lookup, 2> lookup;
};

/// Linear RGB of sixteen lanes.
struct Light {
  __m128 of[kLanes];
};

/// To sRGB, what is brighter than white as white.
Rgb8 encode(__m128 linear) {
  const __m128 within = _mm_min_ps(_mm_max_ps(linear, _mm_setzero_ps()), _mm_set1_ps(1.0F));
  const __m128i level = _mm_cvtps_epi32(_mm_mul_ps(within, _mm_set1_ps(kSrgbTableMax)));
  const auto index = static_cast<std::uint64_t>(_mm_cvtsi128_si64(_mm_packus_epi32(level, level)));
  const std::uint8_t* table = srgb_table();
  return {table[index & 0xFFFF], table[index >> 16 & 0xFFFF], table[index >> 32 & 0xFFFF]};
}

/// Whether an edge runs through each of eight pixels, as bits.
unsigned edge_bits(const float* z, const InstanceId* id, std::ptrdiff_t width) {
  // Inverse depths a, b, c are in line where 2/b = 1/a + 1/c.
  const Float8 middle = load8(z);
  const auto bent = [&](const float* before, const float* after) -> Int8 {
    const Float8 a = load8(before), c = load8(after);
    const Float8 across = 2.0F * a * c, through = middle * (a + c);
    return abs8(across - through) > kEdgeBend * through;
  };
  const auto load_ids = [](const InstanceId* from) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
  };
  const __m128i own = load_ids(id);
  const auto same = [&](const InstanceId* other) { return _mm_cmpeq_epi16(own, load_ids(other)); };
  const __m128i inside = _mm_and_si128(_mm_and_si128(same(id - 1), same(id + 1)),
                                       _mm_and_si128(same(id - width), same(id + width)));
  const Int8 other = ~(Int8)_mm256_cvtepi16_epi32(inside);
  const Int8 edge = other | bent(z - 1, z + 1) | bent(z - width, z + width);
  return static_cast<unsigned>(_mm256_movemask_ps((__m256)edge));
}

/// The pixels of a band of rows at which something begins, block by block, so that those traced
/// together lie together; the picture's rim is left out.
void find_edges(const RenderedFrame& frame, int y0, std::vector<Pixel>& edges) {
  edges.clear();
  const int w = frame.depth_m.width(), h = frame.depth_m.height();
  const int y1 = std::min(h - 1, y0 + kEdgeBlock);
  for (int x0 = 1; x0 < w - 1; x0 += kEdgeBlock)
    for (int y = std::max(1, y0); y < y1; ++y)
      for (int x = x0; x < std::min(w - 1, x0 + kEdgeBlock); x += 8) {
        // The last eight of a row would read beyond its end: they are moved back, bits with them.
        const int from = std::max(1, std::min(x, w - 1 - 8));
        unsigned bits =
            edge_bits(&frame.depth_m(from, y), &frame.instances(from, y), w) >> (x - from);
        for (; bits != 0; bits &= bits - 1) edges.push_back({x + std::countr_zero(bits), y});
      }
}

class EmbreeRenderer final : public Renderer {
 public:
  EmbreeRenderer(const Scene& scene, const RenderConfig& config)
      : config_(config),
        bvh_(scene, config.threads, config.portable),
        records_(scene, bvh_.faces(), config.exposure) {}

  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    const int w = camera.width_px, h = camera.height_px;
    RenderedFrame frame{Grid2d<Rgb8>(w, h), Grid2d<float>(w, h), Grid2d<ClassId>(w, h),
                        Grid2d<InstanceId>(w, h)};
    const View view(camera, world_from_camera);
    parallel_for((h + kTileHeight - 1) / kTileHeight, config_.threads, [&](int row) {
      const FlushDenormals flush;
      std::vector<Packet> packets(kPackets);
      for (Packet& packet : packets) packet.start(view);
      std::vector<Seen> seen(kPackets);
      for (int x = 0; x < w; x += kTileWidth)
        render_tile(view, x, row * kTileHeight, packets, seen, frame);
    });
    if (!config_.smooth_edges || w < 10 || h < 3) return frame;
    parallel_for((h + kEdgeBlock - 1) / kEdgeBlock, config_.threads, [&](int row) {
      const FlushDenormals flush;
      Packet packet;
      packet.start(view);
      std::vector<Pixel> edges;
      find_edges(frame, row * kEdgeBlock, edges);
      for (std::size_t first = 0; first < edges.size(); first += kLanes / kEdgeSamples)
        smooth(view, edges, first, packet, frame);
    });
    return frame;
  }

 private:
  void render_tile(const View& view, int x0, int y0, std::vector<Packet>& packets,
                   std::vector<Seen>& seen, RenderedFrame& frame) const {
    const int x1 = std::min(x0 + kTileWidth, view.width);
    const int y1 = std::min(y0 + kTileHeight, view.height);
    const auto for_each = [&](const auto& work) {
      std::size_t k = 0;
      for (int y = y0; y < y1; y += kSide)
        for (int x = x0; x < x1; x += kSide, ++k) work(k, x, y);
    };
    for_each([&](std::size_t k, int x, int y) { packets[k].aim(view, x, y); });
    alignas(64) std::array<int, kLanes> all;
    all.fill(-1);
    for_each([&](std::size_t k, int, int) { bvh_.intersect16(all.data(), packets[k].rays, true); });
    for_each([&](std::size_t k, int, int) { find_records(packets[k], seen[k]); });
    for_each([&](std::size_t k, int, int) { find_texels(view, packets[k], seen[k]); });
    for_each([&](std::size_t k, int x, int y) { write(packets[k], seen[k], x, y, frame); });
  }

  /// Looks up what was hit, and asks for its record early.
  void find_records(const Packet& packet, Seen& seen) const {
    const RTCHit16& hit = packet.rays.hit;
    const __m256i first = (__m256i)load8(bvh_.first_faces().data());
    for (std::size_t i = 0; i < kLanes; i += 8) {
      const Int8 geometry = load8(hit.geomID + i);
      const Int8 miss = geometry == splat(-1);
      const Int8 place =
          load8(hit.primID + i) + (Int8)_mm256_permutevar8x32_epi32(first, (__m256i)geometry);
      store8(seen.record.data() + i, miss ? splat(records_.nothing()) : place);
      const Float8 depth = load8(packet.rays.ray.tfar + i);
      _mm256_store_ps(seen.depth_m.data() + i, miss ? splat(0.0F) : depth);
    }
    for (const int index : seen.record)
      _mm_prefetch(reinterpret_cast<const char*>(records_.data() + index), _MM_HINT_T0);
  }

  /// Looks up which texels the lanes need, and asks for them early.
  void find_texels(const View& view, const Packet& packet, Seen& seen) const {
    const RTCHit16& hit = packet.rays.hit;
    const RTCRay16& ray = packet.rays.ray;
    for (std::size_t i = 0; i < kLanes; i += 8) {
      std::array<const float*, 8> place, size;
      for (std::size_t k = 0; k < 8; ++k) {
        const FaceRecord& record = records_.data()[seen.record[i + k]];
        place[k] = &record.u;
        size[k] = &record.du2;
        seen.instance[i + k] = record.instance;
        seen.class_id[i + k] = static_cast<ClassId>(record.class_id);
      }
      const auto [du2, dv2, texels, texture] = load_fields(size);
      const __m256i plain = (__m256i)((Int8)texture == splat(int{TextureTable::kWhite}));
      seen.textured[i / 8] = _mm256_movemask_epi8(plain) != -1;
      if (!seen.textured[i / 8]) continue;
      const auto [u, v, du1, dv1] = load_fields(place);
      const Float8 along1 = load8(hit.u + i), along2 = load8(hit.v + i);
      // A pixel cuts depth^2 / (fx fy) out of the plane z = depth; a face of unit normal n shows
      // 1 / |n . d| of that behind it, d having camera z = 1; and Ng = n x twice its area.
      const Float8 facing = load8(hit.Ng_x + i) * load8(ray.dir_x + i) +
                            load8(hit.Ng_y + i) * load8(ray.dir_y + i) +
                            load8(hit.Ng_z + i) * load8(ray.dir_z + i);
      const Float8 depth = load8(seen.depth_m.data() + i);
      const Float8 seen_texels =
          depth * depth * (view.pixel_width * view.pixel_height) * texels / abs8(facing);
      seen.lookup[i / 8] = records_.textures().look_up(
          texture, u + along1 * du1 + along2 * du2, v + along1 * dv1 + along2 * dv2, seen_texels);
    }
  }

  /// Linear RGB x exposure of the sixteen lanes.
  Light shade(const Packet& packet, const Seen& seen) const {
    Light light;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const FaceRecord& record = records_.data()[seen.record[i]];
      __m128 colour = gain_at(record, packet.rays.hit.u[i], packet.rays.hit.v[i]);
      if (seen.textured[i / 8])
        colour = _mm_mul_ps(colour, records_.textures().filter(seen.lookup[i / 8], i % 8));
      light.of[i] = _mm_add_ps(colour, load_halves(record.emission.data()));
    }
    return light;
  }

  void write(const Packet& packet, const Seen& seen, int x0, int y0, RenderedFrame& frame) const {
    const Light light = shade(packet, seen);
    std::array<Rgb8, kLanes> colour;
    for (std::size_t i = 0; i < kLanes; ++i) colour[i] = encode(light.of[i]);
    const auto columns = static_cast<std::size_t>(std::min(kSide, frame.colour.width() - x0));
    const int rows = std::min(kSide, frame.colour.height() - y0);
    const auto copy = [&](auto& to, const auto& from) {
      for (int y = 0; y < rows; ++y) {
        auto* row = &to(x0, y0 + y);
        const auto* lanes = from.data() + kSide * y;
        if (columns == kSide)
          std::memcpy(row, lanes, kSide * sizeof(*row));
        else
          std::memcpy(row, lanes, columns * sizeof(*row));
      }
    };
    copy(frame.colour, colour);
    copy(frame.depth_m, seen.depth_m);
    copy(frame.classes, seen.class_id);
    copy(frame.instances, seen.instance);
  }

  /// Averages the colours of a packet's edge pixels over their samples, in linear light.
  void smooth(const View& view, const std::vector<Pixel>& edges, std::size_t first, Packet& packet,
              RenderedFrame& frame) const {
    constexpr std::size_t kPixels = kLanes / kEdgeSamples;
    const std::size_t count = std::min(kPixels, edges.size() - first);
    alignas(64) std::array<int, kLanes> valid;
    for (int i = 0; i < kLanes; ++i) {
      const std::size_t pixel = static_cast<std::size_t>(i) / kEdgeSamples;
      valid[static_cast<std::size_t>(i)] = pixel < count ? -1 : 0;
      packet.aim(view, i, edges[first + std::min(pixel, count - 1)],
                 kOffsets[static_cast<std::size_t>(i) % kEdgeSamples]);
    }
    packet.forget_hits();
    bvh_.intersect16(valid.data(), packet.rays, true);
    Seen seen;
    find_records(packet, seen);
    find_texels(view, packet, seen);
    const Light light = shade(packet, seen);
    for (std::size_t pixel = 0; pixel < count; ++pixel) {
      Rgb8& colour = frame.colour(edges[first + pixel].x, edges[first + pixel].y);
      __m128 sum = _mm_setr_ps(srgb_to_linear(colour.r), srgb_to_linear(colour.g),
                               srgb_to_linear(colour.b), 0.0F);
      for (std::size_t s = 0; s < kEdgeSamples; ++s)
        sum = _mm_add_ps(sum, _mm_min_ps(light.of[pixel * kEdgeSamples + s], _mm_set1_ps(1.0F)));
      colour = encode(_mm_mul_ps(sum, _mm_set1_ps(1.0F / (kEdgeSamples + 1))));
    }
  }

  RenderConfig config_;
  EmbreeScene bvh_;
  FaceRecords records_;
};

}  // namespace

std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const RenderConfig& config) {
  validate(scene);
  return std::make_unique<EmbreeRenderer>(scene, config);
}

}  // namespace mh
