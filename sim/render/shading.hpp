// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "sim/render/embree_scene.hpp"
#include "sim/render/face_record.hpp"
#include "sim/render/packet.hpp"

namespace mh {

/// What the sixteen rays of a packet hit, on the way to the image.
struct Seen {
  alignas(32) std::array<const FaceRecord*, kLanes> record;
  alignas(32) std::array<float, kLanes> depth_m;
  std::array<bool, 2> textured;  // whether any of the eight lanes is
  std::array<TextureTable::Place, 2> place;
  std::array<TextureTable::Lookup, 2> lookup;
};

/// Linear RGB of sixteen lanes.
struct Radiance {
  __m256 of[kLanes / 2];  // lanes 2i and 2i + 1
};

/// Turns hits into light in four steps, each of which prefetches the memory that the next one
/// needs: if each step is run over many packets, there are hardly any stalls.
class Shading {
 public:
  Shading(const Scene& scene, const EmbreeScene& bvh, float exposure)
      : first_faces_(bvh.first_faces()), records_(scene, bvh.faces(), exposure) {}

  /// Step 1: what was hit.
  void find_records(const Packet& packet, Seen& seen) const;
  /// Step 2: where in its texture.
  /// @param pixel_area  area that a ray represents, at unit depth
  void find_places(const Packet& packet, float pixel_area, Seen& seen) const;
  /// Step 3: which texels are needed.
  void find_texels(Seen& seen) const {
    for (std::size_t half = 0; half < 2; ++half)
      if (seen.textured[half]) records_.textures().look_up(seen.place[half], seen.lookup[half]);
  }
  /// Step 4: linear RGB x exposure, not below 0.
  Radiance shade(const Packet& packet, const Seen& seen) const;

 private:
  std::array<std::uint32_t, 8> first_faces_;  // by geometry
  FaceRecords records_;
};

}  // namespace mh
