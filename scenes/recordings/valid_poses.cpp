// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/valid_poses.hpp"

#include <fmt/format.h>

#include "slam/core/trajectory_io.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"

namespace mh {

std::optional<Trajectory> read_truth(const std::filesystem::path& file,
                                     std::vector<std::string>& notes) {
  Trajectory poses = parse_valid_poses(read_text(file), file.string(), notes);
  if (!poses.empty()) return poses;
  notes.push_back(fmt::format("{}: holds no pose: there is no truth", file.string()));
  return std::nullopt;
}

void note_no_file(const std::filesystem::path& truth, std::vector<std::string>& notes) {
  if (is_there(truth) && !is_file(truth))
    notes.push_back(fmt::format("{}: is not a file: there is no truth", truth.string()));
}

}  // namespace mh
