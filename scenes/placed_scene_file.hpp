// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scenes/mesh_io/label_rules.hpp"
#include "scenes/scene_frame.hpp"
#include "slam/core/labels.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// A mesh file and its pose.
struct PlacedObject {
  std::string name;  ///< unique in its scene
  std::filesystem::path file;
  Eigen::Affine3d scene_from_object = Eigen::Affine3d::Identity();
  std::optional<ClassId> class_id;  ///< class of the whole file; nullopt: classes as in the file
  std::optional<UpAxis> up;         ///< of the file
};

/// Content of a YAML file that lists mesh files and their poses:
///
///   name: living room
///   labels: {"*curtain*": curtain, Floor: floor}     # optional: see LabelRules
///   objects:
///     - file: models/sofa.gltf        # relative to the YAML file, or absolute
///       name: sofa                    # optional, default: the file's; unique
///       class: sofa                   # optional: the whole file is one object of this class
///       position_m: [0, -2.4, 0]      # optional
///       rpy_deg: [0, 0, 180]          # optional: about the fixed axes x, y, z, in this order
///       scale: 1                      # optional: one number, or three
///       up: y                         # optional: the file's up axis; default: as below
///   up: z                             # optional: for all files that state none
///   floor_z_m: 0                      # optional: height of the floor; default: detected
struct PlacedScene {
  std::string name;
  LabelRules rules;
  SceneFrame frame;
  std::vector<PlacedObject> objects;
};

/// @param folder  the folder that file names are relative to
/// @param name    name of a scene whose file states none
/// @throws InputError "file:line: place: value".
PlacedScene read_placed_scene(YamlReader yaml, const std::filesystem::path& folder,
                              const std::string& name);

/// Rotation about the fixed axes x, y, z in this order (URDF's and SDF's convention).
Eigen::Matrix3d rotation_of_rpy(const Eigen::Vector3d& rpy_rad);

}  // namespace mh
