// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "slam/occupancy/voxel_view.hpp"

namespace mh {

class VoxelMap;

/// The index of a voxel as one number, unique within 2^20 voxels in each direction.
std::uint64_t key_of(const Eigen::Vector3i& voxel);

/// Which detected object each voxel of a map belongs to, and which objects are known to be
/// separate: two chairs that touch are one cluster of voxels, but two detections.
class DetectedObjects {
 public:
  using Id = std::uint16_t;  ///< 0: none
  struct Entry {
    Eigen::Vector3i voxel = Eigen::Vector3i::Zero();
    Id object = 0;
  };

  DetectedObjects() = default;
  /// @param entries  of different voxels
  /// @param apart    pairs of objects, each with the smaller first
  DetectedObjects(std::vector<Entry> entries, std::set<std::pair<Id, Id>> apart);

  Id at(const Eigen::Vector3i& voxel) const;
  bool are_apart(Id a, Id b) const { return apart_.contains(std::minmax(a, b)); }

  /// Ordered by place (z, then y, then x).
  const std::vector<Entry>& entries() const { return entries_; }
  const std::set<std::pair<Id, Id>>& apart() const { return apart_; }

 private:
  std::vector<Entry> entries_;
  std::set<std::pair<Id, Id>> apart_;
  std::unordered_map<std::uint64_t, Id> at_;  // only looked up, never iterated over
};

/// Associates detections across views: a detection belongs to an object that already had at least a
/// quarter of the detection's voxels, otherwise to a new object. Pairs of a detection and an object
/// that share the most voxels are matched first.
class DetectionAssociation {
 public:
  /// Adds a view, which is compared with those added before: add views in order of time.
  void add(const VoxelView& view);
  /// Each voxel with a class belongs to the object of this class to which the largest number of
  /// views assigned it. Two objects are apart if more views showed them as two detections than as
  /// one.
  DetectedObjects objects(const VoxelMap& map) const;

 private:
  using Object = std::uint32_t;
  struct Votes {
    Object object = 0;
    std::uint32_t views = 0;
  };
  struct Pair {
    std::uint32_t together = 0, apart = 0;  ///< numbers of views
  };
  struct Detection;

  Object most_voted(const std::vector<Votes>& votes, ClassId class_id) const;
  std::vector<Detection> detections_of(const VoxelView& view) const;
  /// Assigns each detection its object: largest overlaps first, and no object twice, since an
  /// object has one detection per view.
  void recognize(std::vector<Detection>& detections);
  /// For each pair of objects of one class in a view, counts whether the detections show the two as
  /// one object or as two.
  void compare(const std::vector<Detection>& detections);

  std::vector<ClassId> classes_;  ///< of each object
  std::unordered_map<std::uint64_t, std::vector<Votes>>
      votes_;                                        // only looked up, never iterated over
  std::map<std::pair<Object, Object>, Pair> pairs_;  ///< keys have the smaller object first
};

}  // namespace mh
