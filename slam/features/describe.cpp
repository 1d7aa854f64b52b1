// SPDX-License-Identifier: Apache-2.0
#include "slam/features/describe.hpp"

#include <cassert>
#include <cmath>
#include <cstring>

#include "slam/features/brief_pattern.hpp"

namespace mh {
namespace {

constexpr int kRadius_px = 15;
constexpr int kRowLength = 32;  // 31 pixels and a masked one fill whole SIMD registers

// 255 inside the disk, 0 outside; row v + radius, column u + radius. The outline is a circle
// rounded to pixels, made symmetric about the diagonals.
struct Disc {
  std::uint8_t mask[2 * kRadius_px + 1][kRowLength] = {};

  constexpr Disc() {
    for (int v = -kRadius_px; v <= kRadius_px; ++v)
      for (int u = -kRadius_px; u <= kRadius_px; ++u) {
        const int far = u * u > v * v ? u * u : v * v;
        const int near = u * u + v * v - far;
        // The pixel is inside if n = sqrt(far) is at most s = sqrt(r^2 - near) rounded to the
        // nearest integer. For an integer n, n <= round(s) means n - 1/2 <= s, so 4 far - 4 n + 1
        // <= 4 (r^2 - near).
        int n = 0;
        while (n * n < far) ++n;
        const bool inside = 4 * far - 4 * n + 1 <= 4 * (kRadius_px * kRadius_px - near);
        mask[v + kRadius_px][u + kRadius_px] = inside ? 255 : 0;
      }
  }
};
constexpr Disc kDisc;

// The pattern as floats, in the memory order in which the rotation reads it.
struct Pattern {
  alignas(32) float x[512] = {};
  alignas(32) float y[512] = {};

  // All first points, then all second points.
  constexpr Pattern() {
    for (int i = 0; i < 256; ++i) {
      x[i] = kBriefPattern[i].x1;
      y[i] = kBriefPattern[i].y1;
      x[256 + i] = kBriefPattern[i].x2;
      y[256 + i] = kBriefPattern[i].y2;
    }
  }
};
constexpr Pattern kPattern;

// Packs eight bytes of 0 or 1 into eight bits, the first byte lowest: the product moves byte i, at
// bit 8 i, to bit 56 + i.
std::uint64_t pack(const std::uint8_t* bytes) {
  std::uint64_t x = 0;
  std::memcpy(&x, bytes, sizeof x);
  return (x * 0x0102040810204080ULL) >> 56;
}

[[maybe_unused]] bool has_patch(const cv::Mat& image, int x, int y) {
  return x >= kPatchReach_px && y >= kPatchReach_px && x < image.cols - kPatchReach_px &&
         y < image.rows - kPatchReach_px;
}

}  // namespace

float orientation_deg(const cv::Mat& image, int x, int y) {
  assert(has_patch(image, x, y));
  // Column sums of I and v * I. 31 * 255 and 120 * 255 fit into 16 bits.
  alignas(32) std::int16_t sum[kRowLength] = {};
  alignas(32) std::int16_t sum_v[kRowLength] = {};
  for (int v = -kRadius_px; v <= kRadius_px; ++v) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(y + v) + x - kRadius_px;
    const std::uint8_t* mask = kDisc.mask[v + kRadius_px];
    for (int i = 0; i < kRowLength; ++i) {
      const auto value = static_cast<std::int16_t>(row[i] & mask[i]);
      sum[i] = static_cast<std::int16_t>(sum[i] + value);
      sum_v[i] = static_cast<std::int16_t>(sum_v[i] + v * value);
    }
  }
  int moment_u = 0, moment_v = 0;
  for (int i = 0; i < kRowLength; ++i) {
    moment_u += (i - kRadius_px) * sum[i];
    moment_v += sum_v[i];
  }
  const auto degrees =
      static_cast<float>(std::atan2(static_cast<double>(moment_v), moment_u) * 180.0 / CV_PI);
  const float positive = degrees < 0 ? degrees + 360.0F : degrees;
  return positive < 360.0F ? positive : 0.0F;
}

Descriptor describe(const cv::Mat& blurred, int x, int y, float angle_rad) {
  assert(has_patch(blurred, x, y));
  const auto cosine = static_cast<float>(std::cos(static_cast<double>(angle_rad)));
  const auto sine = static_cast<float>(std::sin(static_cast<double>(angle_rad)));
  const auto step = static_cast<float>(blurred.step);

  alignas(32) std::int32_t offset[512];
  for (int i = 0; i < 512; ++i) {
    const float u = std::nearbyint(kPattern.x[i] * cosine - kPattern.y[i] * sine);
    const float v = std::nearbyint(kPattern.x[i] * sine + kPattern.y[i] * cosine);
    offset[i] = static_cast<int>(v * step + u);  // integers below 2^24: exact
  }

  const std::uint8_t* center = blurred.ptr<std::uint8_t>(y) + x;
  alignas(32) std::uint8_t value[512];
  for (int i = 0; i < 512; ++i) value[i] = center[offset[i]];
  alignas(32) std::uint8_t less[256];
  for (int i = 0; i < 256; ++i) less[i] = value[i] < value[256 + i];

  Descriptor descriptor{};
  for (int i = 0; i < 32; ++i) descriptor[i / 8] |= pack(less + 8 * i) << (8 * (i % 8));
  return descriptor;
}

}  // namespace mh
