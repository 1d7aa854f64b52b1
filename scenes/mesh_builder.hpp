// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "scenes/materials/materials.hpp"
#include "scenes/scene.hpp"

namespace mh {

using MaterialId = std::uint16_t;  ///< index into Scene::materials

/// Appearance of a box.
struct BoxStyle {
  float bevel_m = 0.004F;  ///< chamfer of all edges; 0 = sharp
  int grain_axis = -1;     ///< 0, 1, 2: u (the wood grain) runs along x, y, z; -1: along the
                           ///< longest side
};

/// Radii of a round body at its two ends.
struct EndRadii {
  float a_m, b_m;
};

/// Plane of a flat shape: u_axis x v_axis is its normal.
struct Plane {
  Eigen::Vector3f origin, u_axis, v_axis;
};

/// Builds shapes into a Scene. Shapes are given in meters in the current frame (see push); texture
/// coordinates are kept in meters and divided by the material's tile size by finish(). Neighboring
/// faces of one shape share their vertices bit for bit, so that no ray slips between them. Faces
/// are counter-clockwise seen from outside.
class MeshBuilder {
 public:
  /// The material of a spec, created once per distinct spec and emission (linear radiance).
  MaterialId material(const MaterialSpec& spec, const Eigen::Vector3f& emission = {0, 0, 0});

  /// Starts an object: everything added from now on belongs to it. @pre the name is new.
  InstanceId begin_instance(const std::string& name, ClassId class_id);
  /// Continues an object begun earlier (0: no object, class void).
  void resume_instance(InstanceId id);
  InstanceId current_instance() const { return instance_; }

  /// Maximum edge length of tessellated flat faces (m).
  float max_edge_m = 0.12F;
  /// Divides max_edge_m and all other step sizes: small rooms can afford finer lighting.
  float detail = 1.0F;
  /// If false, materials get no texture; textures take most of the time.
  bool painted = true;

  /// Enters a nested frame: outer_from_inner applies to everything until pop().
  void push(const Eigen::Isometry3f& outer_from_inner);
  void pop();

  void box(MaterialId material, const Eigen::Vector3f& min_m, const Eigen::Vector3f& max_m,
           const BoxStyle& style = {});
  /// A straight bar from a to b with a rectangular cross section; `side` is the direction of its
  /// width.
  void beam(MaterialId material, const Eigen::Vector3f& a, const Eigen::Vector3f& b, float width_m,
            float depth_m, const Eigen::Vector3f& side = {1, 0, 0});
  /// A flat parallelogram, seen from the side where u runs right and v runs down; texture
  /// coordinates go from uv0 at `corner` (upper left) to uv0 + uv_size, in meters on the image;
  /// uv_size defaults to the parallelogram's own size, so that images appear once.
  void image(MaterialId material, const Eigen::Vector3f& corner, const Eigen::Vector3f& right,
             const Eigen::Vector3f& down, const Eigen::Vector2f& uv0 = {0, 0},
             std::optional<Eigen::Vector2f> uv_size = std::nullopt);
  /// A flat rectangular grid with given breaks along two directions and an optional mask of cells
  /// to omit (holes for doors and windows).
  void panel(MaterialId material, const Plane& plane, std::span<const float> u_breaks,
             std::span<const float> v_breaks,
             const std::function<bool(float u, float v)>& leave_out = nullptr);
  /// Round body between two centers (a cone if the radii differ), optionally closed by caps.
  void cylinder(MaterialId material, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                const EndRadii& radii, int sides = 16, bool caps = true);
  /// Revolves a profile of (radius, height) around the z axis through `center`. The outside is to
  /// the right of the profile's direction: faces of a profile that is listed upward point outward.
  void lathe(MaterialId material, const Eigen::Vector3f& center,
             std::span<const Eigen::Vector2f> profile, int sides = 24);
  /// A polygon in the xy plane (counter-clockwise, star-shaped about its mean) extruded along z.
  void prism(MaterialId material, std::span<const Eigen::Vector2f> outline, float z0_m, float z1_m);
  /// A tube along a polyline with a radius at each point.
  void tube(MaterialId material, std::span<const Eigen::Vector3f> points,
            std::span<const float> radii_m, int sides = 8);
  void tube(MaterialId material, std::span<const Eigen::Vector3f> points, float radius_m,
            int sides = 8);
  /// A soft box: edges rounded by radius_m, top and bottom bulging by bulge_m.
  void cushion(MaterialId material, const Eigen::Vector3f& center, const Eigen::Vector3f& size_m,
               float radius_m, float bulge_m = 0.0F, float edge_m = 0.07F);
  /// A surface given by point(s, t), s and t in [0, 1], with nu x nv cells; size_m is its size on
  /// the texture.
  void sheet(MaterialId material, const std::function<Eigen::Vector3f(float, float)>& point, int nu,
             int nv, const Eigen::Vector2f& size_m);
  /// A pointed leaf from `root` along `way` (unit), drooping by `droop` (share of its length).
  void leaf(MaterialId material, const Eigen::Vector3f& root, const Eigen::Vector3f& way,
            float length_m, float width_m, float droop);

  /// Adds lights, rooms and a name to the scene being built.
  Scene& scene() { return scene_; }
  /// Converts texture coordinates to repeats of the materials, computes the objects' boxes and
  /// returns the scene; the builder cannot be used afterward.
  Scene finish();

 private:
  using Grid = std::vector<std::uint32_t>;
  std::uint32_t vertex(MaterialId material, const Eigen::Vector3f& local,
                       const Eigen::Vector2f& uv);
  void triangle(MaterialId material, std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void grid_faces(MaterialId material, const Grid& grid, int nu, int nv, bool flip);
  void disc(MaterialId material, const Eigen::Vector3f& center,
            const std::vector<Eigen::Vector3f>& ring, bool flip);
  int cells(float length_m) const;

  Scene scene_;
  std::vector<MaterialId> material_of_vertex_;
  std::vector<Eigen::Isometry3f> frames_{Eigen::Isometry3f::Identity()};
  std::map<std::string, MaterialId> materials_;
  InstanceId instance_ = 0;
  ClassId class_ = kVoid;
  std::uint64_t shape_count_ = 0;
};

/// Values from a to b in equal steps of at most `step`, both ends included; the given stops between
/// them are hit exactly.
std::vector<float> breaks(float a, float b, float step, std::vector<float> stops = {});

Eigen::Isometry3f translation(float x, float y, float z);
Eigen::Isometry3f turn_z(float angle_rad);
/// Rotation about a unit axis through the origin.
Eigen::Isometry3f turn(const Eigen::Vector3f& axis, float angle_rad);

}  // namespace mh
