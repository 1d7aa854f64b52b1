// SPDX-License-Identifier: Apache-2.0
#include "scenes/recorded/valid_poses.hpp"

#include <cstddef>
#include <sstream>

#include <fmt/format.h>

#include "slam/core/counted.hpp"
#include "slam/core/error.hpp"
#include "slam/core/text_file.hpp"
#include "slam/core/trajectory_io.hpp"

namespace mh {

Trajectory read_valid_poses(const std::filesystem::path& file, std::vector<std::string>& notes) {
  std::istringstream text(read_text(file));
  Trajectory poses;
  std::size_t left_out = 0;
  std::string first_fault;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    if (line.substr(0, line.find('#')).find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      // Blank lines before it, so that messages count as the file does.
      const TimedPose pose =
          parse_tum(std::string(static_cast<std::size_t>(number - 1), '\n') + line, file.string())
              .front();
      if (!poses.empty() && pose.stamp_ns <= poses.back().stamp_ns)
        throw InputError(fmt::format("{}:{}: stamp: {} does not come after {}", file.string(),
                                     number, format_stamp(pose.stamp_ns),
                                     format_stamp(poses.back().stamp_ns)));
      poses.push_back(pose);
    } catch (const InputError& error) {
      if (left_out++ == 0) first_fault = error.what();
    }
  }
  if (left_out > 0)
    notes.push_back(fmt::format("{}: {} left out of the truth; {}", file.string(),
                                counted(left_out, "line is", "lines are"), first_fault));
  return poses;
}

}  // namespace mh
