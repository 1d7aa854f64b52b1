// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <array>
#include <cstdint>
#include <vector>

#include "scenes/scene.hpp"
#include "sim/render/texture.hpp"

namespace mh {

/// What shading needs of every face; what changes over the face is kept as its value at corner 0
/// and its steps to corners 1 and 2. Half floats. What lies between the colors is read along with
/// them, as a fourth channel that means nothing.
struct alignas(32) FaceRecord {
  /// Light x vertex color x base color x exposure: linear RGB that the face reflects of what a
  /// white texture would.
  std::array<std::uint16_t, 3> gain{};
  InstanceId instance = 0;
  std::array<std::uint16_t, 3> gain_step1{};
  std::uint16_t class_id = kVoid;
  std::array<std::uint16_t, 4> gain_step2{};
  std::array<std::uint16_t, 4> emission{};  ///< linear RGB x exposure
};
static_assert(sizeof(FaceRecord) == 32);

/// What it needs beside that where the face has a texture.
struct alignas(32) FaceTexture {
  float u = 0, v = 0, du1 = 0, dv1 = 0;  // texture coordinates
  float du2 = 0, dv2 = 0;
  float texels = 0;  ///< twice the face's area in texels of level 0
  std::uint32_t texture = TextureTable::kWhite;
};
static_assert(sizeof(FaceTexture) == 32);

/// Both, in one line of the cache.
struct alignas(64) TexturedFace {
  FaceRecord record;
  FaceTexture texture;
};

/// Records of the faces of a scene, and the pictures that they refer to.
class FaceRecords {
 public:
  /// @param order  faces in the order in which their records are wanted
  FaceRecords(const Scene& scene, const std::vector<std::uint32_t>& order, float exposure);

  /// Whether any face has a texture.
  bool textured() const { return !textured_faces_.empty(); }
  /// By place in `order`, stride() bytes from one to the next.
  const FaceRecord* data() const {
    return textured() ? &textured_faces_.front().record : plain_faces_.data();
  }
  std::size_t stride() const { return textured() ? sizeof(TexturedFace) : sizeof(FaceRecord); }
  /// Where one lies last that is no face's, but what a ray sees that hits nothing: the sky's light,
  /// class void, instance 0.
  int nothing() const {
    return static_cast<int>(textured() ? textured_faces_.size() : plain_faces_.size()) - 1;
  }
  /// Of one of data(), where any face has a texture.
  static const FaceTexture& texture_of(const FaceRecord* record) {
    return reinterpret_cast<const TexturedFace*>(record)->texture;
  }
  const TextureTable& textures() const { return textures_; }

 private:
  // One of the two is filled.
  std::vector<FaceRecord> plain_faces_;
  std::vector<TexturedFace> textured_faces_;
  TextureTable textures_;
};

/// Eight half floats as floats.
inline __m256 load_halves(const std::uint16_t* from) {
  return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
}

}  // namespace mh
