// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace mh {

/// A key of a robot's file, as load_robot() reads it; tests hold the two equal.
struct RobotKey {
  std::string_view mapping;  ///< where it stands: "base.limits"; NAME stands for any name
  std::string_view key;
  std::string_view value;  ///< "[0.1, 1000]" of a number, else what it is in words
  std::string_view meaning;
  bool required = true;
};

/// Every key, in the order of the file.
std::span<const RobotKey> robot_keys();

}  // namespace mh
