// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "slam/core/labels.hpp"
#include "slam/occupancy/voxel_map.hpp"

namespace mh {

/// An object in a map: connected voxels of one class that the views did not show as separate
/// detections.
struct MapObject {
  std::string name;  ///< class and number, e.g. "chair 2"; unique in a map
  ClassId class_id = kVoid;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();  ///< of its box, map frame
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero(),
                  max_m = Eigen::Vector3d::Zero();  ///< corners of its box
  /// Share of the votes in its voxels that are for its class, times min(1, voxels / (4 x
  /// min_voxels)): 0 to 1.
  double score = 0;
  std::size_t voxels = 0;
};

struct ObjectsConfig {
  int min_voxels = 6;  ///< smaller clusters are label noise
  /// Voxels of one class that touch are connected, unless they belong to objects that are apart
  /// (DetectedObjects). A cluster with at most a quarter of the voxels of another one is merged
  /// into it, unless the two are apart, if the gap between their boxes is at most this,
  double gap_m = 0.10;
  /// or at most this where one is above the other, such as a seat and its legs: the seat's rim is
  /// thin.
  double stacked_gap_m = 0.25;
  double min_label_share = 0.5;  ///< of a voxel's votes that must be for its class
};

/// Whether a class is a kind of object, not structure (wall, floor, ceiling, ...), unknown or a
/// person.
bool is_thing(ClassId class_id);

/// Finds the objects of a map, computed from its voxels alone: they move with the map. Ordered by
/// class, then by number; the largest of a class is number 1.
std::vector<MapObject> find_objects(const VoxelMap& map, const ObjectsConfig& config = {});

/// Indices of the objects meant by a name, which is that of one object ("chair 2") or of a class
/// ("refrigerator", synonyms too); best score first.
/// @throws InputError with a suggestion if the name is unknown, or nothing in this map has it.
std::vector<std::size_t> objects_named(const std::vector<MapObject>& objects,
                                       std::string_view name);

/// As JSON: `objects`, each with name, class, class_id, score, center_m, min_m, max_m, voxels.
std::string objects_json(const std::vector<MapObject>& objects, double resolution_m);

}  // namespace mh
