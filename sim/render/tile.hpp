// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "sim/render/encode.hpp"
#include "sim/render/packet.hpp"
#include "sim/render/renderer.hpp"
#include "sim/render/shading.hpp"

namespace mh {

/// Rows of one output of a tile, on the way to an image.
template <class T, int kWidth, int kHeight, std::size_t kSpare = 0>
class TileRows {
 public:
  /// Points to column x of row y; kSpare bytes are writable past the row's end.
  T* at(int x, int y) { return reinterpret_cast<T*>(bytes_.data() + kStride * row(y)) + x; }

  /// Copies the part inside the image to (x0, y0) and beyond. Whole cache lines are written by
  /// streaming stores: an image is larger than the caches, and fetching a line only to overwrite
  /// all of it costs more than shading it.
  void store(int x0, int y0, Grid2d<T>& grid) const {
    const int columns = std::min(kWidth, grid.width() - x0);
    for (int y = 0; y < std::min(kHeight, grid.height() - y0); ++y) {
      const std::byte* from = bytes_.data() + kStride * row(y);
      T* to = &grid(x0, y0 + y);
      if (columns == kWidth && reinterpret_cast<std::uintptr_t>(to) % kLine == 0)
        stream(from, reinterpret_cast<__m256i*>(to));
      else
        std::memcpy(to, from, static_cast<std::size_t>(columns) * sizeof(T));
    }
  }

 private:
  static constexpr std::size_t kLine = 64, kRowBytes = kWidth * sizeof(T);
  static constexpr std::size_t kStride = kRowBytes + (kSpare + 31) / 32 * 32;
  static_assert(kRowBytes % kLine == 0);

  static std::size_t row(int y) { return static_cast<std::size_t>(y); }
  static void stream(const std::byte* from, __m256i* to) {
    const auto* words = reinterpret_cast<const __m256i*>(from);
    for (std::size_t i = 0; i < kRowBytes / sizeof(__m256i); ++i)
      _mm256_stream_si256(to + i, _mm256_load_si256(words + i));
  }

  alignas(kLine) std::array<std::byte, kStride * kHeight> bytes_;
};

/// A row of packets, rendered.
class Tile {
 public:
  static constexpr int kPackets = 16, kWidth = kSide * kPackets, kHeight = kSide;

  /// Sets what the lanes of packet k show; packets of a row are set from left to right.
  void set(std::size_t k, const Radiance& light, const Seen& seen) {
    const int x = kSide * static_cast<int>(k);
    static_assert(kSide == 4 && kLanes == 16);
    encode(&light.of[0], color_.at(x, 0), color_.at(x, 1));
    encode(&light.of[4], color_.at(x, 2), color_.at(x, 3));
    for (int y = 0; y < kSide; ++y) {
      const auto lane = static_cast<std::size_t>(kSide * y);
      _mm_store_ps(depth_m_.at(x, y), _mm_load_ps(&seen.depth_m[lane]));
      name(&seen.record[lane], instances_.at(x, y), classes_.at(x, y));
    }
  }

  /// Stores the whole tile at its place in a frame; other threads see it after _mm_sfence().
  void store(int x0, int y0, RenderedFrame& frame) const {
    color_.store(x0, y0, frame.color);
    depth_m_.store(x0, y0, frame.depth_m);
    classes_.store(x0, y0, frame.classes);
    instances_.store(x0, y0, frame.instances);
  }

 private:
  /// Instance and class of four faces.
  static void name(const FaceRecord* const* records, InstanceId* instances, ClassId* classes) {
    static_assert(offsetof(FaceRecord, instance) == 6 && offsetof(FaceRecord, class_id) == 14);
    const auto names = [&](std::size_t i) {  // each in the upper half of a word
      const auto* first = reinterpret_cast<const float*>(records[i]);
      const auto* second = reinterpret_cast<const float*>(records[i + 1]);
      return _mm_castps_si128(_mm_shuffle_ps(_mm_load_ps(first), _mm_load_ps(second), 0xDD));
    };
    const __m128i mixed =
        _mm_packus_epi32(_mm_srli_epi32(names(0), 16), _mm_srli_epi32(names(2), 16));
    const __m128i sorted = _mm_shuffle_epi8(
        mixed, _mm_setr_epi8(0, 1, 4, 5, 8, 9, 12, 13, 2, 6, 10, 14, -1, -1, -1, -1));
    static_assert(sizeof(InstanceId) == 2 && sizeof(ClassId) == 1);
    _mm_storel_epi64(reinterpret_cast<__m128i*>(instances), sorted);
    const int four = _mm_extract_epi32(sorted, 2);
    std::memcpy(classes, &four, 4);
  }

  TileRows<Rgb8, kWidth, kHeight, kSpareAfterEncode> color_;
  TileRows<float, kWidth, kHeight> depth_m_;
  TileRows<ClassId, kWidth, kHeight> classes_;
  TileRows<InstanceId, kWidth, kHeight> instances_;
};

}  // namespace mh
