// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <array>
#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"
#include "sim/render/texture.hpp"

namespace mh {

/// A material, ready to shade with.
struct Surface {
  MipTexture texture;
  __m128 emission;  ///< linear RGB x exposure
};

/// One per material, at least one. Without texture coordinates the textures are left out: their
/// mean colours go into the faces' records.
std::vector<Surface> make_surfaces(const Scene& scene, float exposure);

/// All that shading needs of a face, in one cache line.
struct alignas(64) FaceRecord {
  std::array<float, 6> uv{};  ///< of its three corners
  /// Per corner: light x vertex colour x base colour x exposure; halves, the fourth unused.
  std::array<std::uint16_t, 12> gain{};
  float texels = 0;  ///< twice its area in texels of level 0
  std::uint16_t surface = 0;
  InstanceId instance = 0;
  ClassId class_id = kVoid;
};
static_assert(sizeof(FaceRecord) == 64);

/// Linear base colour of each material (at least one); see make_surfaces.
std::vector<Eigen::Vector3f> base_colours(const Scene& scene);

FaceRecord make_record(const Scene& scene, const std::vector<Surface>& surfaces,
                       const std::vector<Eigen::Vector3f>& base, std::size_t face, float exposure);

/// Linear RGB (channel 3 unused) that leaves a face at the barycentric place (u, v), within [0, 1].
/// @param footprint  area that one pixel sees of the face (m2) over twice the face's area
inline __m128 shade(const FaceRecord& record, const Surface& surface, float u, float v,
                    float footprint) {
  const auto gain = [&](std::size_t corner) {
    const std::uint16_t* halves = record.gain.data() + 4 * corner;
    return _mm_cvtph_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(halves)));
  };
  const float w = 1.0F - u - v;
  __m128 colour = _mm_mul_ps(_mm_set1_ps(w), gain(0));
  colour = _mm_add_ps(colour, _mm_mul_ps(_mm_set1_ps(u), gain(1)));
  colour = _mm_add_ps(colour, _mm_mul_ps(_mm_set1_ps(v), gain(2)));
  if (!surface.texture.empty()) {
    const float s = w * record.uv[0] + u * record.uv[2] + v * record.uv[4];
    const float t = w * record.uv[1] + u * record.uv[3] + v * record.uv[5];
    const float level = MipTexture::level_of(footprint * record.texels);
    colour = _mm_mul_ps(colour, surface.texture.sample(s, t, level));
  }
  colour = _mm_add_ps(colour, surface.emission);
  return _mm_min_ps(_mm_max_ps(colour, _mm_setzero_ps()), _mm_set1_ps(1.0F));
}

}  // namespace mh
