// SPDX-License-Identifier: Apache-2.0
#include "sim/render/shading.hpp"

#include "sim/render/simd.hpp"

namespace mh {

void Shading::find_records(const Packet& packet, Seen& seen) const {
  const RTCHit16& hit = packet.rays.hit;
  const __m256i first = (__m256i)load8(first_faces_.data());
  const __m256i records = _mm256_set1_epi64x(reinterpret_cast<std::intptr_t>(records_.data()));
  const __m256i stride = _mm256_set1_epi64x(static_cast<std::int64_t>(records_.stride()));
  const auto store_four = [&](const FaceRecord** to, __m128i indices) {
    const __m256i bytes = _mm256_mul_epu32(_mm256_cvtepu32_epi64(indices), stride);
    _mm256_store_si256(reinterpret_cast<__m256i*>(to), _mm256_add_epi64(records, bytes));
  };
  for (std::size_t i = 0; i < kLanes; i += 8) {
    const Int8 geometry = load8(hit.geomID + i);
    const Int8 miss = geometry == splat(-1);
    const Int8 place =
        load8(hit.primID + i) + (Int8)_mm256_permutevar8x32_epi32(first, (__m256i)geometry);
    const auto index = (__m256i)(miss ? splat(records_.nothing()) : place);
    store_four(seen.record.data() + i, _mm256_castsi256_si128(index));
    store_four(seen.record.data() + i + 4, _mm256_extracti128_si256(index, 1));
    const Float8 depth = load8(packet.rays.ray.tfar + i);
    _mm256_store_ps(seen.depth_m.data() + i, miss ? splat(0.0F) : depth);
  }
  for (const FaceRecord* record : seen.record)
    _mm_prefetch(reinterpret_cast<const char*>(record), _MM_HINT_T0);
}

void Shading::find_places(const Packet& packet, float pixel_area, Seen& seen) const {
  const RTCHit16& hit = packet.rays.hit;
  const RTCRay16& ray = packet.rays.ray;
  seen.textured = {};
  if (!records_.textured()) return;
  for (std::size_t i = 0; i < kLanes; i += 8) {
    std::array<const float*, 8> place, size;
    std::uint32_t textures = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      const FaceTexture& face = FaceRecords::texture_of(seen.record[i + k]);
      place[k] = &face.u;
      size[k] = &face.du2;
      textures |= face.texture;
    }
    static_assert(TextureTable::kWhite == 0);
    seen.textured[i / 8] = textures != 0;
    if (textures == 0) continue;
    const auto [du2, dv2, texels, texture] = load_fields(size);
    const auto [u, v, du1, dv1] = load_fields(place);
    const Float8 along1 = load8(hit.u + i), along2 = load8(hit.v + i);
    // A pixel covers depth^2 / (fx fy) of the plane z = depth; on a face of unit normal n, it
    // covers 1 / |n . d| times that, with d scaled to camera z = 1; and Ng is n times twice the
    // face's area.
    const Float8 facing = load8(hit.Ng_x + i) * load8(ray.dir_x + i) +
                          load8(hit.Ng_y + i) * load8(ray.dir_y + i) +
                          load8(hit.Ng_z + i) * load8(ray.dir_z + i);
    const Float8 depth = load8(seen.depth_m.data() + i);
    const Float8 seen_texels = depth * depth * pixel_area * texels / abs8(facing);
    seen.place[i / 8] = records_.textures().place(texture, u + along1 * du1 + along2 * du2,
                                                  v + along1 * dv1 + along2 * dv2, seen_texels);
  }
}

Radiance Shading::shade(const Packet& packet, const Seen& seen) const {
  const __m256 one = _mm256_set1_ps(1.0F);
  Radiance light;
  for (std::size_t i = 0; i < kLanes; i += 2) {
    __m256 gain[2], rest[2];
    for (std::size_t k = 0; k < 2; ++k) {
      const FaceRecord& record = *seen.record[i + k];
      const __m256 u = _mm256_broadcast_ss(packet.rays.hit.u + i + k);
      const __m256 v = _mm256_broadcast_ss(packet.rays.hit.v + i + k);
      // Each register holds two fields: the gain and its first step, or its second step and the
      // emission.
      const __m256 first = load_halves(record.gain.data());
      rest[k] = load_halves(record.gain_step2.data());
      gain[k] =
          _mm256_add_ps(_mm256_mul_ps(first, _mm256_blend_ps(one, u, 0xF0)),
                        _mm256_mul_ps(rest[k], _mm256_blend_ps(_mm256_setzero_ps(), v, 0x0F)));
    }
    __m256 color = _mm256_add_ps(_mm256_permute2f128_ps(gain[0], gain[1], 0x20),
                                 _mm256_permute2f128_ps(gain[0], gain[1], 0x31));
    if (seen.textured[i / 8])
      color = _mm256_mul_ps(color, records_.textures().filter2(seen.lookup[i / 8], i % 8));
    light.of[i / 2] = _mm256_add_ps(color, _mm256_permute2f128_ps(rest[0], rest[1], 0x31));
  }
  return light;
}

}  // namespace mh
