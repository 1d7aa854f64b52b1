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

/// Flushes denormals to zero on this thread during its lifetime, as Embree recommends.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

/// Which faces a ray can hit: bits of RTCRay::mask.
inline constexpr unsigned kOpaqueFaces = 1;
inline constexpr unsigned kLuminousFaces = 2;  ///< faces of materials that emit light
inline constexpr unsigned kAllFaces = ~0U;

/// Holes in faces, for an intersection filter. A texel is either opaque or a hole, without
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

/// Faces that stop a ray, or faces that a ray passes through and is tinted by
/// (Material::transmission).
enum class Faces { kSurfaces, kGlass };

/// The surfaces or panes of a scene in an Embree BVH; owns everything that it needs. Tracing is
/// thread-safe. Hides the differences between Embree 3 and 4.
class EmbreeScene {
 public:
  /// @param portable    pins the instruction set to AVX2, so that results agree across processors.
  /// @param watertight  no ray slips between two faces that share an edge; 1/5 slower. Otherwise,
  ///                    one in two million camera rays slips through, and so do many rays that
  ///                    start on a face.
  /// @throws MachineError if Embree fails (out of memory, or no AVX2 when pinned to it).
  EmbreeScene(const Scene& scene, int build_threads, bool portable, bool watertight = false,
              Faces which = Faces::kSurfaces);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Traces 16 rays to their first hits; lanes whose `valid` is 0 are left alone.
  void intersect16(const int* valid, RTCRayHit16& rays, bool coherent) const;
  /// The same, one ray at a time: the baseline that packets are compared with.
  void intersect_each(RTCRayHit16& rays) const;
  /// Tests for 16 rays whether anything is in the way: the tfar of an occluded one becomes
  /// -infinity.
  void occluded16(const int* valid, RTCRay16& rays) const;

  /// Returns a hit's index in Scene::triangles.
  std::uint32_t face_of(unsigned geometry_id, unsigned primitive_id) const {
    return faces_[first_[geometry_id] + primitive_id];
  }
  /// The same as a list: faces()[first_faces()[geometry] + primitive].
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
