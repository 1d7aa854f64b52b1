// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/valid_poses.hpp"

#include <cstddef>

#include <fmt/format.h>

#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/text_file.hpp"
#include "slam/core/trajectory_io.hpp"

namespace mh {

Trajectory read_valid_poses(const std::filesystem::path& file, std::vector<std::string>& notes) {
  std::size_t left_out = 0;
  std::string first_fault;
  Trajectory poses = parse_valid_tum(read_text(file), file.string(), [&](const InputError& error) {
    if (left_out++ == 0) first_fault = error.what();
  });
  if (left_out > 0)
    notes.push_back(fmt::format("{}: {} left out of the truth; {}", file.string(),
                                counted(left_out, "line is", "lines are"), first_fault));
  return poses;
}

void note_no_file(const std::filesystem::path& truth, std::vector<std::string>& notes) {
  if (is_there(truth) && !is_file(truth))
    notes.push_back(fmt::format("{}: is not a file: there is no truth in it", truth.string()));
}

}  // namespace mh
