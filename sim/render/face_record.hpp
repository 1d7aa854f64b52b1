// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <array>
#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"
#include "sim/render/texture.hpp"

namespace mh {

/// All that shading needs of a face, in one cache line; what changes over the face is kept as its
/// value at corner 0 and its steps to corners 1 and 2.
struct alignas(64) FaceRecord {
  float u = 0, v = 0, du1 = 0, dv1 = 0;  // texture coordinates
  float du2 = 0, dv2 = 0;
  float texels = 0;  ///< twice its area in texels of level 0
  std::uint32_t texture = TextureTable::kWhite;
  /// Light x vertex colour x base colour x exposure; half floats, as are the next three.
  std::array<std::uint16_t, 3> gain{};
  InstanceId instance = 0;
  std::array<std::uint16_t, 3> gain_step1{};
  std::uint16_t class_id = kVoid;
  std::array<std::uint16_t, 4> gain_step2{};
  std::array<std::uint16_t, 4> emission{};  ///< linear RGB x exposure
};
static_assert(sizeof(FaceRecord) == 64);

/// Records of the faces of a scene, and the pictures that they refer to.
class FaceRecords {
 public:
  /// @param order  faces in the order in which their records are wanted
  FaceRecords(const Scene& scene, const std::vector<std::uint32_t>& order, float exposure);

  /// By place in `order`; one more at the end is what a ray sees that hits nothing: the sky's
  /// light, class void, instance 0.
  const FaceRecord* data() const { return records_.data(); }
  int nothing() const { return static_cast<int>(records_.size()) - 1; }
  const TextureTable& textures() const { return textures_; }

 private:
  std::vector<FaceRecord> records_;
  TextureTable textures_;
};

/// Four half floats (the fourth may be anything) as floats.
inline __m128 load_halves(const std::uint16_t* from) {
  return _mm_cvtph_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)));
}

/// Linear RGB that a face reflects of what a white texture would (channel 3 is noise).
inline __m128 gain_at(const FaceRecord& record, float u, float v) {
  const __m128 along1 = _mm_mul_ps(_mm_set1_ps(u), load_halves(record.gain_step1.data()));
  const __m128 along2 = _mm_mul_ps(_mm_set1_ps(v), load_halves(record.gain_step2.data()));
  return _mm_add_ps(_mm_add_ps(load_halves(record.gain.data()), along1), along2);
}

}  // namespace mh
