// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "scenes/instance_id.hpp"
#include "scenes/shared_grid.hpp"
#include "slam/core/labels.hpp"
#include "slam/core/rgbd_frame.hpp"

namespace mh {

/// The lowest visible opacity, of 255: glTF's usual cutoff of 0.5.
inline constexpr std::uint8_t kOpaqueFrom = 128;

/// Appearance of a surface. Texel (x, y) of the texture covers u in [x/w, (x+1)/w), v in [y/h,
/// (y+1)/h); v grows downward in the image; the texture repeats.
struct Material {
  std::string name;
  Rgb8 base_color{255, 255, 255};  ///< sRGB; multiplies the texture and the vertex colors
  SharedGrid<Rgb8> texture;        ///< sRGB; empty = base_color alone
  /// Opacity of each texel: below kOpaqueFrom it is a hole. Empty = opaque; otherwise of the
  /// texture's size.
  SharedGrid<std::uint8_t> opacity{};
  Eigen::Vector2f tile_m{1.0F, 1.0F};  ///< physical size of one repeat of the texture, if known
  Eigen::Vector3f emission = Eigen::Vector3f::Zero();  ///< linear radiance added to reflected light
  /// Share of light (linear RGB) that a thin pane, such as glass or a gauze curtain, transmits;
  /// zero = none. A pane tints what is behind it and has no depth or label of its own.
  Eigen::Vector3f transmission = Eigen::Vector3f::Zero();
  bool is_pane() const { return !transmission.isZero(0.0F); }
};

/// An object (or a wall, a floor) with an instance id.
struct Instance {
  InstanceId id = 0;
  ClassId class_id = kVoid;
  std::string name;  ///< unique in the scene, e.g. "kitchen/chair_2"
  Eigen::Vector3f min_m = Eigen::Vector3f::Zero(),
                  max_m = Eigen::Vector3f::Zero();  ///< box in the world frame
};

struct Light {
  enum class Kind { kSun, kSphere, kSky, kAmbient };
  Kind kind = Kind::kSphere;
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();  ///< sphere: center
  Eigen::Vector3f direction = {0.0F, 0.0F, -1.0F};       ///< sun: direction in which its light
                                                         ///< travels, unit
  float radius_m = 0.05F;                                ///< sphere: radius
  float angular_radius_rad = 0.00465F;                   ///< sun: half its apparent size
  /// Linear RGB. Sun: irradiance on a surface facing it; sky: radiance of rays that leave the
  /// scene; sphere: radiant intensity (irradiance at 1 m); ambient: irradiance / pi on every
  /// surface, as a substitute for indirect light.
  Eigen::Vector3f color = Eigen::Vector3f::Ones();
};

struct Room {
  std::string name;
  std::vector<Eigen::Vector2d> polygon_m;  ///< inner floor outline, counter-clockwise
  bool is_box = false;  ///< without a plan: the polygon is only the bounding box of a floor
  bool contains(const Eigen::Vector2d& place_m) const;
};

/// The plane to stand and drive on. Houses built here have it at z = 0; for other files it is
/// detected (scenes/floor.hpp).
struct Floor {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  ///< a point on it
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();       ///< its normal
  /// Anything up to this height above the plane is part of the floor: rugs, thresholds, the bumps
  /// of a scan.
  double rough_m = 0.03;
  std::optional<double> area_m2 = {};  ///< of its faces seen from above; overlaps count once

  /// Whether the floor is the plane z = 0.
  bool is_level_zero() const { return middle_m.z() == 0.0 && up == Eigen::Vector3d::UnitZ(); }
};

/// The visible world: one indexed triangle mesh with a material, a class and an instance per face.
/// World frame z up, meters. Faces are visible and lit from both sides.
struct Scene {
  std::string name;

  // Per vertex. uvs and colors are empty where the source has none; all sizes match otherwise.
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<Rgb8> colors;  ///< sRGB
  /// Baked light, linear RGB: irradiance / pi, so that outgoing radiance = albedo * light.
  /// Empty = unlit: shown at full albedo.
  std::vector<Eigen::Vector3f> light;

  // Per face.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint16_t> material_of;  ///< index into materials
  std::vector<ClassId> class_of;
  std::vector<InstanceId> instance_of;

  std::vector<Material> materials;
  std::vector<Instance> instances;  ///< ordered by id; ids are 1 .. n, gaps allowed
  std::vector<Light> lights;
  std::vector<Room> rooms;  ///< empty for meshes without a plan
  Floor floor;

  /// Area of the rooms or, without a plan, of the floor's faces.
  double floor_area_m2() const;
};

/// Checks every index and size. @throws InputError naming what is inconsistent.
void validate(const Scene& scene);

/// Digest (xxh3-64) of everything visible in the scene: the key of results derived from it.
std::uint64_t digest(const Scene& scene);

}  // namespace mh
