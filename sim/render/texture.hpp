// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "sim/render/simd.hpp"
#include "slam/core/grid2d.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// Mean color of an image in linear light; white if it is empty.
Eigen::Vector3f mean_linear(const Grid2d<Rgb8>& image);

/// The same image at full size, 1/2, 1/4, ... down to one texel (at most kMipLevels levels),
/// averaged over areas in linear light.
inline constexpr int kMipLevels = 16;
std::vector<Grid2d<Eigen::Vector3f>> mip_pyramid(const Grid2d<Rgb8>& image);

/// The textures of a scene with their mip pyramids, filtered in linear light. They repeat. Texel
/// centers are at half-integers; (u, v) = (0, 0) is the outer corner of the first texel.
///
/// Laid out for lookups without branches: texels are three 16-bit channels, each level has a copy
/// of its first column and row at its end, so that the neighbors of a lookup are one load of 16
/// bytes each (the last four are ignored), and the last level is repeated, so that the next coarser
/// one always exists.
class TextureTable {
 public:
  /// A texture of one white texel, which every table contains.
  static constexpr std::uint32_t kWhite = 0;

  TextureTable() { add(Grid2d<Rgb8>(1, 1, {255, 255, 255})); }

  /// Reserves memory for images about to be added, so that the table never takes more than they
  /// need.
  /// @throws InputError if there are more texels than it can count.
  void reserve(std::span<const Grid2d<Rgb8>* const> images);
  /// @returns the position of the image's level 0 in the table.
  std::uint32_t add(const Grid2d<Rgb8>& image);

  /// What eight lanes read.
  struct Lookup {
    /// The left texels of four pairs: fine upper and lower, coarse upper and lower.
    alignas(32) std::array<std::array<unsigned, 8>, 4> texels;
    /// Weights out of 65536, four of 16 bits per lane. Across: fine left and right, coarse left and
    /// right, which sum to one; down: fine upper and lower, coarse upper and lower.
    alignas(32) std::array<std::uint64_t, 8> across, down;
  };

  /// Where eight lanes sample.
  struct Place {
    Float8 u, v;   // within [0, 1)
    Float8 blend;  // share of the coarser level
    alignas(32) std::array<unsigned, 8> level;
  };
  /// Prepares a trilinear lookup at (u, v). Separate from look_up, so that one can proceed while
  /// another waits.
  /// @param first   results of add(), stored as the bits of floats
  /// @param texels  texels of level 0 that a pixel covers. The level at which the pixel would cover
  ///                one texel is read: half the base-2 logarithm of this, to within 0.05.
  Place place(Float8 first, Float8 u, Float8 v, Float8 texels) const;
  /// Fills in a lookup and prefetches its texels.
  void look_up(const Place& place, Lookup& lookup) const;

  /// The filtered colors of a lane and the next one: linear RGB, channel 3 = 0.
  __m256 filter2(const Lookup& lookup, std::size_t lane) const {
    const __m128i both = _mm_unpacklo_epi64(filter(lookup, lane), filter(lookup, lane + 1));
    return _mm256_mul_ps(_mm256_set1_ps(1.0F / kOne),
                         _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(both)));
  }

 private:
  static constexpr float kOne = 65535.0F;
  static constexpr std::size_t kBehind = 2;

  /// The filtered color of a lane, in 16-bit numbers.
  __m128i filter(const Lookup& lookup, std::size_t lane) const {
    const auto at = [&](std::size_t pair) { return texel(lookup.texels[pair][lane]); };
    const __m256i upper = pairs(at(0), at(2));
    const __m256i lower = pairs(at(1), at(3));
    const __m256i down = _mm256_set1_epi64x(static_cast<std::int64_t>(lookup.down[lane]));
    const __m256i across = _mm256_set1_epi64x(static_cast<std::int64_t>(lookup.across[lane]));
    const __m256i column =
        _mm256_add_epi16(_mm256_mulhi_epu16(upper, _mm256_shuffle_epi8(down, spread(0, 0, 4, 4))),
                         _mm256_mulhi_epu16(lower, _mm256_shuffle_epi8(down, spread(2, 2, 6, 6))));
    const __m256i shares =
        _mm256_mulhi_epu16(column, _mm256_shuffle_epi8(across, spread(0, 2, 4, 6)));
    const __m128i left_right =
        _mm_add_epi16(_mm256_castsi256_si128(shares), _mm256_extracti128_si256(shares, 1));
    // Left texel's three channels and the right one's: channel 3 of the sum is ignored.
    const __m128i sum = _mm_add_epi16(left_right, _mm_srli_si128(left_right, 6));
    return _mm_blend_epi16(sum, _mm_setzero_si128(), 1 << 3);
  }

  struct Level {
    float width = 0, height = 0;
    std::int32_t offset = 0;  // of the first texel, in texels
    std::int32_t stride = 0;  // texels per row
  };

  const std::uint16_t* texel(unsigned index) const {
    return texels_.data() + 3 * static_cast<std::size_t>(index);
  }
  /// Two neighboring texels at each of two places.
  static __m256i pairs(const std::uint16_t* a, const std::uint16_t* b) {
    return _mm256_inserti128_si256(
        _mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(a))),
        _mm_loadu_si128(reinterpret_cast<const __m128i*>(b)), 1);
  }
  /// Picks the 16-bit number at byte a, b, c, d for the three channels of each of four texels, with
  /// a 0 after every two texels.
  static __m256i spread(int a, int b, int c, int d) {
    const auto twice = [](int at) { return static_cast<short>(at | (at + 1) << 8); };
    constexpr short kZero = -1;
    return _mm256_setr_epi16(twice(a), twice(a), twice(a), twice(b), twice(b), twice(b), kZero,
                             kZero, twice(c), twice(c), twice(c), twice(d), twice(d), twice(d),
                             kZero, kZero);
  }

  std::vector<Level> levels_;
  std::vector<std::uint16_t> texels_;  // and kBehind more, so that no load reads past the end
};

}  // namespace mh
