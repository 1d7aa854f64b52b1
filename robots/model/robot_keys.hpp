// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace mh {

/// A key of a robot's file, as load_robot() reads it. Numbers are those of robot_fields.hpp; for
/// the rest, tests check that this list agrees with the loader.
struct RobotKey {
  std::string mapping;  ///< where it is: "base.limits"; NAME means any name
  std::string key;
  std::string value;  ///< "[0.1, 1000]" for a number, else a description
  std::string meaning;
  bool required = true;
};

/// Every key, in the order of the file.
std::vector<RobotKey> robot_keys();

}  // namespace mh
