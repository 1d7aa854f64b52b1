// SPDX-License-Identifier: Apache-2.0
#include "sim/render/embree_scene.hpp"

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr unsigned kFlushToZeroAndDenormalsAreZero = 0x8040;  // bits of MXCSR

void check(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE)
    throw MachineError(
        fmt::format("Embree failed to {} (error {})", what, static_cast<int>(error)));
}

/// Lets rays continue through holes.
void pass_holes(const RTCFilterFunctionNArguments* hits) {
  const auto& cut_outs = *static_cast<const CutOuts*>(hits->geometryUserPtr);
  for (unsigned i = 0; i < hits->N; ++i)
    if (hits->valid[i] != 0 &&
        cut_outs.is_hole(RTCHitN_primID(hits->hit, hits->N, i), RTCHitN_u(hits->hit, hits->N, i),
                         RTCHitN_v(hits->hit, hits->N, i)))
      hits->valid[i] = 0;
}

}  // namespace

bool CutOuts::is_hole(unsigned primitive, float u, float v) const {
  const Face& face = faces[primitive];
  const Grid2d<std::uint8_t>& opacity = opacity_of[face.material];
  const Eigen::Vector2f place = (1.0F - u - v) * face.uvs[0] + u * face.uvs[1] + v * face.uvs[2];
  const auto texel = [](float at, int size) {
    return std::min(size - 1, static_cast<int>((at - std::floor(at)) * static_cast<float>(size)));
  };
  return opacity(texel(place.x(), opacity.width()), texel(place.y(), opacity.height())) <
         kOpaqueFrom;
}

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
  _mm_setcsr(saved_ | kFlushToZeroAndDenormalsAreZero);
}
FlushDenormals::~FlushDenormals() {
  _mm_setcsr(saved_);
}

EmbreeScene::EmbreeScene(const Scene& scene, int build_threads, bool portable, bool watertight,
                         Faces which) {
  const FlushDenormals flush;
  const std::string settings =
      fmt::format("threads={}{}", std::max(1, build_threads), portable ? ",isa=avx2" : "");
  device_ = rtcNewDevice(settings.c_str());
  check(device_, "start");
  scene_ = rtcNewScene(device_);

  std::vector<std::uint32_t> opaque, luminous, cut_out;
  for (std::uint32_t f = 0; f < scene.triangles.size(); ++f) {
    const Material* material =
        scene.materials.empty() ? nullptr : &scene.materials[scene.material_of[f]];
    if ((material != nullptr && material->is_pane()) != (which == Faces::kGlass)) continue;
    const bool emits = material != nullptr && !material->emission.isZero();
    const bool has_holes = !scene.uvs.empty() && material != nullptr && !material->opacity.empty();
    (emits ? luminous : has_holes ? cut_out : opaque).push_back(f);
  }
  attach(scene, opaque, kOpaqueFaces);
  attach(scene, luminous, kLuminousFaces);
  if (!cut_out.empty()) {
    for (const Material& material : scene.materials)
      cut_outs_.opacity_of.push_back(material.opacity);
    for (const std::uint32_t f : cut_out) {
      const auto& t = scene.triangles[f];
      cut_outs_.faces.push_back({.uvs = {scene.uvs[t[0]], scene.uvs[t[1]], scene.uvs[t[2]]},
                                 .material = scene.material_of[f]});
    }
    attach(scene, cut_out, kOpaqueFaces, &cut_outs_);
  }
  if (watertight) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcCommitScene(scene_);
  check(device_, "build the hierarchy");
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void EmbreeScene::attach(const Scene& scene, const std::vector<std::uint32_t>& faces, unsigned mask,
                         CutOuts* cut_outs) {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree allocates the buffers: it reads 16 bytes past a vertex buffer's end.
  auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
      std::max<std::size_t>(1, scene.positions_m.size())));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), faces.size()));
  check(device_, "allocate the scene");
  for (std::size_t v = 0; v < scene.positions_m.size(); ++v)
    std::memcpy(positions + 3 * v, scene.positions_m[v].data(), 3 * sizeof(float));
  for (std::size_t i = 0; i < faces.size(); ++i)
    std::memcpy(indices + 3 * i, scene.triangles[faces[i]].data(), 3 * sizeof(std::uint32_t));
  rtcSetGeometryMask(geometry, mask);
  if (cut_outs != nullptr) {
    rtcSetGeometryUserData(geometry, cut_outs);
    rtcSetGeometryIntersectFilterFunction(geometry, pass_holes);
    rtcSetGeometryOccludedFilterFunction(geometry, pass_holes);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_, geometry, geometries_);
  rtcReleaseGeometry(geometry);
  first_[geometries_++] = static_cast<std::uint32_t>(faces_.size());
  faces_.insert(faces_.end(), faces.begin(), faces.end());
}

void EmbreeScene::intersect_each(RTCRayHit16& rays) const {
  for (int i = 0; i < 16; ++i) {
    RTCRayHit one{};
    one.ray.org_x = rays.ray.org_x[i], one.ray.org_y = rays.ray.org_y[i];
    one.ray.org_z = rays.ray.org_z[i], one.ray.tfar = rays.ray.tfar[i];
    one.ray.dir_x = rays.ray.dir_x[i], one.ray.dir_y = rays.ray.dir_y[i];
    one.ray.dir_z = rays.ray.dir_z[i], one.ray.mask = rays.ray.mask[i];
    one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect1(one);
    rays.ray.tfar[i] = one.ray.tfar;
    rays.hit.Ng_x[i] = one.hit.Ng_x, rays.hit.Ng_y[i] = one.hit.Ng_y;
    rays.hit.Ng_z[i] = one.hit.Ng_z, rays.hit.u[i] = one.hit.u, rays.hit.v[i] = one.hit.v;
    rays.hit.primID[i] = one.hit.primID, rays.hit.geomID[i] = one.hit.geomID;
  }
}

#if RTC_VERSION_MAJOR >= 4

void EmbreeScene::intersect1(RTCRayHit& ray) const {
  rtcIntersect1(scene_, &ray);
}

void EmbreeScene::intersect16(const int* valid, RTCRayHit16& rays, bool coherent) const {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  if (coherent) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, scene_, &rays, &arguments);
}

void EmbreeScene::occluded16(const int* valid, RTCRay16& rays) const {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid, scene_, &rays, &arguments);
}

#else

void EmbreeScene::intersect1(RTCRayHit& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_, &context, &ray);
}

void EmbreeScene::intersect16(const int* valid, RTCRayHit16& rays, bool coherent) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcIntersect16(valid, scene_, &context, &rays);
}

void EmbreeScene::occluded16(const int* valid, RTCRay16& rays) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene_, &context, &rays);
}

#endif

}  // namespace mh
