// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace mh::gazebo {

/// The names in use in one scope of a document that libsdformat reads.
class Names {
 public:
  /// Reserves a free, valid name: the given one, or one close to it.
  std::string take(const char* given);

 private:
  /// Names in use, each with the next number to try for a copy, so that thousands of copies of the
  /// same name are not tried one by one.
  std::map<std::string, int> taken_;
};

}  // namespace mh::gazebo
