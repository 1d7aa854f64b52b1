// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "scenes/mesh_builder.hpp"
#include "slam/core/random.hpp"

namespace mh {

/// One piece of furniture under construction. Its frame: origin in the middle of its footprint on
/// the supporting surface, x along its width, -y to its front, z up; wall-mounted pieces have their
/// back at y = depth / 2. Everything stays within size_m.
class Piece {
 public:
  Piece(MeshBuilder& builder, std::string name, Eigen::Vector3f size,
        std::map<std::string, MaterialSpec> materials, RandomStream stream)
      : mesh(builder),
        size_m(size),
        random(stream),
        name_(std::move(name)),
        materials_(std::move(materials)),
        body_(builder.current_instance()) {}

  MeshBuilder& mesh;
  const Eigen::Vector3f size_m;  ///< width, depth, height
  const RandomStream random;     ///< of this piece alone

  /// The material of a role ("wood", "fabric"): the user's if given, otherwise `usual`. An image
  /// always has the size of `usual`.
  MaterialId material(const std::string& role, MaterialSpec usual,
                      const Eigen::Vector3f& emission = {0, 0, 0});
  /// A material that the user cannot change.
  MaterialId fixed(const MaterialSpec& spec, const Eigen::Vector3f& emission = {0, 0, 0}) {
    return mesh.material(spec, emission);
  }
  /// Starts a part that is a separate object ("bed" -> "bed/pillow_1"); body() ends it.
  void part(const std::string& suffix, std::string_view class_name);
  void body() { mesh.resume_instance(body_); }

 private:
  std::string name_;
  std::map<std::string, MaterialSpec> materials_;
  InstanceId body_;
};

enum class Mount { kFloor, kWall, kCeiling, kOnPiece };

/// A kind of furniture, as named in a house file.
struct FurnitureKind {
  std::string_view name;
  std::string_view class_name;  ///< see slam/core/labels.hpp
  Mount mount;
  std::string_view roles;  ///< roles of materials that may be overridden, space-separated
  Eigen::Vector3f size_m;  ///< default size
  void (*build)(Piece&);
  /// Lamps: height of the light source as a share of the lamp's height; negative: below the lamp.
  std::optional<float> bulb = std::nullopt;
};

/// All kinds, ordered by name.
std::span<const FurnitureKind> furniture_kinds();
/// The kind with that name; nullptr if there is none.
const FurnitureKind* find_furniture(std::string_view name);

}  // namespace mh
