// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/matrix_poses.hpp"

#include <fmt/format.h>

#include "scenes/scannet/recording.hpp"
#include "slam/io/error.hpp"

namespace mh {

void MatrixPoses::add(Stamp stamp_ns, const std::string& text, const std::string& where) {
  try {
    if (const auto pose = pose_of(parse_matrix(text, where), where))
      poses_.push_back({stamp_ns, *pose});
    else
      miss(fmt::format("{}: holds a number that is not finite", where));
  } catch (const InputError& error) {
    miss(error.what());
  }
}

void MatrixPoses::add_absent(const std::string& where) {
  miss(fmt::format("{}: is missing", where));
}

void MatrixPoses::miss(const std::string& fault) {
  if (missing_++ == 0) first_fault_ = fault;
}

void MatrixPoses::note(const std::string& recording, std::vector<std::string>& notes) const {
  if (missing_ == 0) return;
  notes.push_back(fmt::format("{}: {} of {} frames have no valid pose and are without truth; {}",
                              recording, missing_, missing_ + poses_.size(), first_fault_));
}

}  // namespace mh
