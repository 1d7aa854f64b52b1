// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "scenes/scene.hpp"

namespace mh {

/// Flushes denormals to zero on this thread while it lives, as Embree asks for.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

/// Which faces a ray can meet: bits of RTCRay::mask.
inline constexpr unsigned kOpaqueFaces = 1;
inline constexpr unsigned kLuminousFaces = 2;  ///< faces of materials that emit light
inline constexpr unsigned kAllFaces = ~0U;

/// Where faces have holes: what an intersection filter asks. A texel is whole or a hole, without
/// blending, so that depth and labels are those of one surface.
struct CutOuts {
  struct Face {
    std::array<Eigen::Vector2f, 3> uvs;
    std::uint16_t material = 0;
  };
  std::vector<Face> faces;                           // by primitive
  std::vector<SharedGrid<std::uint8_t>> opacity_of;  // by material
  bool is_hole(unsigned primitive, float u, float v) const;
};

/// What stops a ray, or what a ray passes and is tinted by (Material::transmission).
enum class Faces { kSurfaces, kGlass };

/// Surfaces or panes of a scene in an Embree hierarchy; owns all that it needs. Tracing is safe
/// from several threads. One place for the differences between Embree 3 and 4.
class EmbreeScene {
 public:
  /// @param portable pins the instruction set to AVX2, so that results agree across processors.
  /// @param watertight no ray slips between two faces that share an edge; a fifth slower. Without
  /// it
  ///                   one in two million of a camera's rays does, and many that start on a face.
  /// @throws MachineError if Embree fails (out of memory, or no AVX2 where it is pinned).
  EmbreeScene(const Scene& scene, int build_threads, bool portable, bool watertight = false,
              Faces which = Faces::kSurfaces);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Traces 16 rays to their first hits; lanes whose `valid` is 0 are left alone.
  void intersect16(const int* valid, RTCRayHit16& rays, bool coherent) const;
  /// The same ray by ray: what packets are measured against.
  void intersect_each(RTCRayHit16& rays) const;
  /// Tells for 16 rays whether anything is in the way: their tfar becomes -infinity.
  void occluded16(const int* valid, RTCRay16& rays) const;

  /// Index in Scene::triangles of a hit.
  std::uint32_t face_of(unsigned geometry_id, unsigned primitive_id) const {
    return faces_[first_[geometry_id] + primitive_id];
  }
  /// The same, as a list: faces()[first_faces()[geometry] + primitive].
  const std::vector<std::uint32_t>& faces() const { return faces_; }
  const std::array<std::uint32_t, 8>& first_faces() const { return first_; }

 private:
  void intersect1(RTCRayHit& ray) const;
  void attach(const Scene& scene, const std::vector<std::uint32_t>& faces, unsigned mask,
              CutOuts* cut_outs = nullptr);

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::vector<std::uint32_t> faces_;      // one geometry after another
  std::array<std::uint32_t, 8> first_{};  // in faces_, by geometry id
  unsigned geometries_ = 0;
  CutOuts cut_outs_;
};

}  // namespace mh
