// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace mh {

/// A key of a robot's file, as load_robot() reads it. Numbers are those of robot_fields.hpp; of the
/// rest tests hold list and loader equal.
struct RobotKey {
  std::string mapping;  ///< where it stands: "base.limits"; NAME stands for any name
  std::string key;
  std::string value;  ///< "[0.1, 1000]" of a number, else what it is in words
  std::string meaning;
  bool required = true;
};

/// Every key, in the order of the file.
std::vector<RobotKey> robot_keys();

}  // namespace mh
