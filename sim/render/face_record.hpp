// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <array>
#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"
#include "sim/render/texture.hpp"

namespace mh {

/// What shading needs for every face; a quantity that varies over the face is stored as its value
/// at corner 0 and its differences to corners 1 and 2. Numbers are half floats. The field after a
/// color is read along with it, as a fourth channel that is ignored.
struct alignas(32) FaceRecord {
  /// Light x vertex color x base color x exposure: linear RGB that the face reflects with a white
  /// texture.
  std::array<std::uint16_t, 3> gain{};
  InstanceId instance = 0;
  std::array<std::uint16_t, 3> gain_step1{};
  std::uint16_t class_id = kVoid;
  std::array<std::uint16_t, 4> gain_step2{};
  std::array<std::uint16_t, 4> emission{};  ///< linear RGB x exposure
};
static_assert(sizeof(FaceRecord) == 32);

/// What shading needs in addition if the face has a texture.
struct alignas(32) FaceTexture {
  float u = 0, v = 0, du1 = 0, dv1 = 0;  // texture coordinates
  float du2 = 0, dv2 = 0;
  float texels = 0;  ///< twice the face's area in texels of level 0
  std::uint32_t texture = TextureTable::kWhite;
};
static_assert(sizeof(FaceTexture) == 32);

/// A face's record and texture, in one cache line.
struct alignas(64) TexturedFace {
  FaceRecord record;
  FaceTexture texture;
};

/// Records of the faces of a scene, and the textures that they refer to.
class FaceRecords {
 public:
  /// @param order  faces in the order of their records
  FaceRecords(const Scene& scene, const std::vector<std::uint32_t>& order, float exposure);

  /// Whether any face has a texture.
  bool textured() const { return !textured_faces_.empty(); }
  /// The records by position in `order`, stride() bytes apart.
  const FaceRecord* data() const {
    return textured() ? &textured_faces_.front().record : plain_faces_.data();
  }
  std::size_t stride() const { return textured() ? sizeof(TexturedFace) : sizeof(FaceRecord); }
  /// Index of the last record, which is not a face's but that of a ray that hits nothing: the sky's
  /// light, class void, instance 0.
  int nothing() const {
    return static_cast<int>(textured() ? textured_faces_.size() : plain_faces_.size()) - 1;
  }
  /// Texture of a record of data(), if any face has a texture.
  static const FaceTexture& texture_of(const FaceRecord* record) {
    return reinterpret_cast<const TexturedFace*>(record)->texture;
  }
  const TextureTable& textures() const { return textures_; }

 private:
  // Only one of the two is filled.
  std::vector<FaceRecord> plain_faces_;
  std::vector<TexturedFace> textured_faces_;
  TextureTable textures_;
};

/// Loads eight half floats as floats.
inline __m256 load_halves(const std::uint16_t* from) {
  return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
}

}  // namespace mh
