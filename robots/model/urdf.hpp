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
  double mass_kg = 0;                                       ///< 0 = a frame without a body
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();       ///< of mass, in the link's frame
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  ///< about it, the link's axes
};

/// How a link moves against its parent.
struct Joint {
  enum class Kind { kFixed, kTurning, kSliding };
  std::string name, parent, child;
  Kind kind = Kind::kFixed;
  SE3 parent_from_child;                            ///< at position 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit, in the child's frame
  // Radians, meters, per second; newton meters or newtons. Without limits: infinite.
  double lower = 0, upper = 0, velocity = 0, effort = 0;
};

/// A robot as a tree of links.
struct KinematicTree {
  std::string name, root;
  std::vector<Link> links = {};
  std::vector<Joint> joints = {};  ///< parents before children

  double mass_kg() const;
  /// @throws InputError if there is none of that name.
  const Joint& joint(std::string_view name) const;
  /// Where a link is, the joints at these positions, those left out at 0. Positions beyond a
  /// joint's limits are taken as they come. @throws InputError if there is no such link or joint.
  SE3 root_from(std::string_view link, const std::map<std::string, double>& positions = {}) const;
};

/// Reads a URDF by urdfdom. @throws InputError naming file and link or joint: no XML or no URDF, a
/// joint to a link that is missing, a link with two parents, joints in a circle, a mass that is
/// negative, an inertia that no body has, limits the wrong way round.
KinematicTree load_urdf(const std::filesystem::path& file);

}  // namespace mh
