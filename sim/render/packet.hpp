// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <immintrin.h>

#include <array>
#include <limits>
#include <vector>

#include "sim/render/embree_scene.hpp"
#include "slam/core/camera.hpp"
#include "slam/core/se3.hpp"

namespace mh {

inline constexpr int kSide = 4;  ///< a packet is a square of 4 x 4 pixels
inline constexpr int kLanes = 16;

/// Where a ray passes through a pixel, px from its center.
struct Offset {
  float x = 0, y = 0;
};
struct Pixel {
  int x = 0, y = 0;
};

/// Everything about an image that does not change between tiles. The direction through a pixel is
/// column + row, with z = 1 in the camera's frame, so that the distance along a ray is the depth.
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

  /// Returns what an offset within a pixel adds to its direction.
  std::array<float, 3> beside(const Offset& offset) const {
    const float a = offset.x * pixel_width, b = offset.y * pixel_height;
    return {rotation(0, 0) * a + rotation(0, 1) * b, rotation(1, 0) * a + rotation(1, 1) * b,
            rotation(2, 0) * a + rotation(2, 1) * b};
  }
  static std::size_t whole(int pixels) {
    return static_cast<std::size_t>((pixels + kSide - 1) / kSide * kSide);
  }

  int width, height;
  Eigen::Matrix3f rotation;                       // world_from_camera
  Eigen::Vector3f origin;                         // m, world
  float pixel_width, pixel_height;                // at unit depth
  std::array<std::vector<float>, 3> column, row;  // world x, y, z; padded to whole packets
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

  /// Aims the packet at the pixels from (x0, y0) on.
  void aim(const View& view, int x0, int y0, const Offset& offset = {}) {
    const std::array<float*, 3> direction = {rays.ray.dir_x, rays.ray.dir_y, rays.ray.dir_z};
    const std::array<float, 3> beside = view.beside(offset);
    for (std::size_t k = 0; k < 3; ++k) {
      const __m128 column =
          _mm_add_ps(_mm_loadu_ps(view.column[k].data() + x0), _mm_set1_ps(beside[k]));
      const float* row = view.row[k].data() + y0;
      for (int y = 0; y < kSide; ++y)
        _mm_store_ps(direction[k] + kSide * y, _mm_add_ps(column, _mm_set1_ps(row[y])));
    }
    forget_hits();
  }

  /// Aims one lane.
  void aim(const View& view, int lane, const Pixel& pixel, const Offset& offset) {
    const std::array<float*, 3> direction = {rays.ray.dir_x, rays.ray.dir_y, rays.ray.dir_z};
    const std::array<float, 3> beside = view.beside(offset);
    for (std::size_t k = 0; k < 3; ++k)
      direction[k][lane] = view.column[k][static_cast<std::size_t>(pixel.x)] +
                           view.row[k][static_cast<std::size_t>(pixel.y)] + beside[k];
  }

  void forget_hits() {
    for (int i = 0; i < kLanes; ++i) {
      rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
      rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
  }
};

}  // namespace mh
