// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "slam/core/se3.hpp"

namespace mh {

/// A rigid part of a robot.
struct Link {
  std::string name;
  double mass_kg = 0;  ///< 0 = a frame without a body
};

/// How a link moves relative to its parent.
struct Joint {
  enum class Kind { kFixed, kTurning, kSliding };
  std::string name, parent, child;
  Kind kind = Kind::kFixed;
  SE3 parent_from_child;                            ///< with the joint at position 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit, in the child's frame
  // Limits of position (rad or m), velocity (the same per second) and effort (N m or N); infinite
  // if there are none.
  double lower = 0, upper = 0, velocity = 0, effort = 0;
};

/// A robot as a tree of links.
struct KinematicTree {
  std::string name, root;
  std::vector<Link> links = {};
  std::vector<Joint> joints = {};  ///< parents before children

  double mass_kg() const;
  /// @throws InputError if there is no joint with this name.
  const Joint& joint(std::string_view name) const;
  /// Returns the pose of a link with the joints at these positions, omitted ones at 0. Positions
  /// beyond a joint's limits are used unchanged. @throws InputError if there is no such link or
  /// joint.
  SE3 root_from(std::string_view link, const std::map<std::string, double>& positions = {}) const;
};

/// Reads a URDF with urdfdom. @throws InputError naming file and link or joint: not XML or not a
/// URDF, a joint to a missing link, a link with two parents, a cycle of joints, a negative mass,
/// reversed limits.
/// @param warnings  receives a line for each inertia that no body can have (inertias are not used
///                  here)
KinematicTree load_urdf(const std::filesystem::path& file,
                        std::vector<std::string>* warnings = nullptr);

}  // namespace mh
