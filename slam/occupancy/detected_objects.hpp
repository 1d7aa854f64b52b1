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

/// The place of a voxel as one number; equal places have equal numbers. 2^20 voxels each way.
std::uint64_t key_of(const Eigen::Vector3i& voxel);

/// Which detected object each voxel of a map is of, and which objects are known to be two: two
/// chairs that touch are one body of voxels, but two detections.
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
  std::unordered_map<std::uint64_t, Id> at_;  // only looked up, never walked
};

/// Recognizes objects from view to view: a detection is of an object that had at least a quarter of
/// its voxels before, or of a new one. Those that agree in the most voxels find each other first.
class DetectionAssociation {
 public:
  /// Views in order of time: each is compared with what the earlier ones told.
  void add(const VoxelView& view);
  /// Each voxel with a class is of the object of this class that most views gave it to. Objects are
  /// apart if more views showed two detections where they are than one.
  DetectedObjects objects(const VoxelMap& map) const;

 private:
  using Object = std::uint32_t;
  struct Votes {
    Object object = 0;
    std::uint32_t views = 0;
  };
  struct Pair {
    std::uint32_t together = 0, apart = 0;  ///< views
  };
  struct Detection;

  Object most_voted(const std::vector<Votes>& votes, ClassId class_id) const;
  std::vector<Detection> detections_of(const VoxelView& view) const;
  /// Gives each detection its object. The largest agreements first, and no object twice: it has one
  /// detection in a view.
  void recognize(std::vector<Detection>& detections);
  /// Counts which objects of one class they show as one and which as two.
  void compare(const std::vector<Detection>& detections);

  std::vector<ClassId> classes_;                                 ///< of each object
  std::unordered_map<std::uint64_t, std::vector<Votes>> votes_;  // only looked up, never walked
  std::map<std::pair<Object, Object>, Pair> pairs_;              ///< the smaller first
};

}  // namespace mh
