// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "slam/core/trajectory.hpp"

namespace mh {

/// Collects true poses that a data set writes as 4x4 matrices. A frame whose text is not a pose (a
/// wrong number of values, a value that is not finite, not a rotation) has no ground truth, and is
/// counted.
class MatrixPoses {
 public:
  /// @param text   16 numbers, row by row
  /// @param where  file and place, for the note
  void add(Stamp stamp_ns, const std::string& text, const std::string& where);
  /// Counts a frame for which the data set has no pose.
  void add_absent(const std::string& where);

  /// The poses, in the order in which they were added.
  const Trajectory& poses() const { return poses_; }
  /// Adds a line about the frames without a pose, if there are any.
  void note(const std::string& recording, std::vector<std::string>& notes) const;

 private:
  void miss(const std::string& fault);

  Trajectory poses_;
  std::size_t missing_ = 0;
  std::string first_fault_;
};

}  // namespace mh
