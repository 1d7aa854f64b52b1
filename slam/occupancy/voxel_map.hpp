// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "slam/core/labels.hpp"
#include "slam/occupancy/detected_objects.hpp"
#include "slam/occupancy/voxel_view.hpp"

namespace mh {

enum class VoxelState : std::uint8_t { kUnknown, kFree, kOccupied };

/// How many views show a voxel as a class.
struct ClassVote {
  ClassId class_id = kVoid;
  std::uint16_t views = 0;
  friend bool operator==(const ClassVote&, const ClassVote&) = default;
};

/// A voxel as a map knows it. It covers [index, index + 1) times the resolution along each axis.
struct Voxel {
  Eigen::Vector3i index = Eigen::Vector3i::Zero();
  std::uint16_t hits = 0;    ///< views with a return in it
  std::uint16_t misses = 0;  ///< views that looked through it
  bool occupied = false;
  ClassId label = kVoid;          ///< the class with the most votes, ties to the smallest id
  std::uint16_t label_views = 0;  ///< number of votes for this class
  std::uint32_t votes = 0;        ///< number of votes for any class

  Eigen::Vector3d center_m(double resolution_m) const {
    return resolution_m * (index.cast<double>().array() + 0.5).matrix();
  }
};

/// Log-odds that a view adds to a voxel, and their limits: the defaults of OctoMap, Hornung et al.,
/// Autonomous Robots 2013. A voxel is occupied if its log-odds are at least 0, as in OctoMap.
inline constexpr float kHitLogOdds = 0.85F, kMissLogOdds = -0.4F, kLeastLogOdds = -2.0F,
                       kMostLogOdds = 3.5F;

/// An octree of occupancy and classes: an OctoMap tree whose nodes count the views that hit them,
/// those that looked through them, and the votes for their class. Log-odds are computed from the
/// counts and limited at the end; OctoMap limits them after each update. So a view can be removed
/// exactly, and equal sets of views give equal maps whatever happened in between. Frame: z up.
class VoxelMap {
 public:
  /// @param resolution_m  side of a voxel, positive
  explicit VoxelMap(double resolution_m = 0.05);
  ~VoxelMap();
  VoxelMap(VoxelMap&&) noexcept;
  VoxelMap& operator=(VoxelMap&&) noexcept;

  double resolution_m() const;
  /// Removes one view and adds another; only voxels in which they differ are touched.
  /// @param before  was added earlier; nullptr: nothing is removed
  /// @param after   nullptr: nothing is added
  void replace(const VoxelView* before, const VoxelView* after);

  /// Records which objects its voxels belong to; later calls of replace() do not update it.
  void set_detected(DetectedObjects objects);
  const DetectedObjects& detected() const;

  /// Whether z = 0 of the map's frame is a floor (z up). If no floor was found, the frame is a
  /// camera's, and heights in it are meaningless. Default: true.
  void set_on_floor(bool on_floor);
  bool on_floor() const;

  VoxelState state_at(const Eigen::Vector3d& point_m) const;
  /// Calls visit for every known voxel, in the octree's order.
  void for_each(const std::function<void(const Voxel&)>& visit) const;
  /// Votes of the voxel at a point, ordered by class; empty if it has none.
  std::vector<ClassVote> votes_at(const Eigen::Vector3d& point_m) const;
  std::size_t voxel_count() const;
  bool empty() const { return voxel_count() == 0; }
  /// Memory of nodes, their arrays of children and votes, without the allocator's overhead.
  std::size_t memory_bytes() const;

  /// Writes OctoMap's binary format (each voxel free, occupied or unknown; no classes).
  void write_bt(std::ostream& out) const;
  /// Writes an OctoMap file of a ColorOcTree, in which occupied voxels have the color of their
  /// class: octovis shows it, and every reader of OctoMap reads it. The counts follow after the
  /// tree, where those readers stop, so that read_ot() restores this map exactly.
  void write_ot(std::ostream& out) const;
  /// Reads what write_ot() wrote.
  /// @param in    seekable
  /// @param name  the file's name in messages
  /// @throws InputError if it is damaged or without counts (another program's file).
  static VoxelMap read_ot(std::istream& in, const std::string& name);

  /// The same to and from files. @throws InputError naming the file.
  void save_bt(const std::filesystem::path& file) const;
  void save_ot(const std::filesystem::path& file) const;
  static VoxelMap load_ot(const std::filesystem::path& file);
  /// Loads an octree from any program: OcTree or ColorOcTree, .ot or .bt. Without our counts, each
  /// voxel counts as hit or seen through by a single view, without a class.
  /// @param notes receives a line in that case @throws InputError naming the file
  static VoxelMap load_octree(const std::filesystem::path& file, std::vector<std::string>& notes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mh
