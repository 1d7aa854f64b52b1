// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace mh::gazebo {

/// The names taken in one scope of a document that libsdformat reads.
class Names {
 public:
  /// Takes a name that is free and passes: the given one, or nearly that.
  std::string take(const char* given);

 private:
  /// With the number that the next copy of each may try: names of thousands of one name are not to
  /// be tried one by one.
  std::map<std::string, int> taken_;
};

}  // namespace mh::gazebo
