// SPDX-License-Identifier: Apache-2.0
#include "bench/systems/recorded_run.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "bench/systems/child_process.hpp"
#include "bench/systems/frames_read.hpp"
#include "bench/systems/outside_error.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTrajectory = "trajectory.txt";

/// Returns the frame that a stamp refers to; nullopt if none is within the tolerance.
std::optional<Stamp> frame_of(Stamp stamp_ns, std::span<const Stamp> frames) {
  const auto next = std::lower_bound(frames.begin(), frames.end(), stamp_ns - kStampTolerance_ns);
  std::optional<Stamp> best;
  for (auto it = next; it != frames.end() && *it <= stamp_ns + kStampTolerance_ns; ++it)
    if (!best || std::abs(*it - stamp_ns) < std::abs(*best - stamp_ns)) best = *it;
  return best;
}

/// The trajectory that the program wrote: a file in its own folder, not a link out of it.
/// @param home  the folder's canonical path, before the program ran
std::string written_text(const fs::path& home, ChildProcess& child) {
  constexpr std::uintmax_t kLongest = std::uintmax_t{64} << 20;  // a trajectory is about 1e5 bytes
  const fs::path trajectory = home / kTrajectory;
  std::error_code error;
  if (!fs::exists(trajectory, error)) child.fail("ended well but wrote no trajectory");
  require_readable(trajectory);
  const fs::path file = fs::canonical(trajectory, error);
  if (error || *file.lexically_relative(home).begin() == "..")
    child.fail("made its trajectory a link to outside its folder");
  if (const auto bytes = fs::file_size(file, error); bytes > kLongest)
    child.fail(
        fmt::format("wrote a trajectory of {} MB, {} MB is the most", bytes >> 20, kLongest >> 20));
  return read_text(trajectory);
}

/// A file without poses is a valid answer: completeness 0.
bool tracked_nothing(const std::string& trajectory) {
  std::istringstream lines(trajectory);
  for (std::string line; std::getline(lines, line);)
    if (line.find_first_not_of(" \t\r") < line.find('#')) return false;
  return true;
}

/// Replaces the stamps of the poses with those of the frames that they belong to.
Trajectory with_frame_stamps(Trajectory trajectory, std::span<const Stamp> frames,
                             ChildProcess& child) {
  std::size_t strange = 0;
  std::optional<Stamp> first_strange;
  for (TimedPose& pose : trajectory) {
    const std::optional<Stamp> frame = frame_of(pose.stamp_ns, frames);
    if (!frame && ++strange == 1) first_strange = pose.stamp_ns;
    if (frame) pose.stamp_ns = *frame;
  }
  if (first_strange)
    child.fail(fmt::format("wrote {} of {} poses at stamps that match no frame, the first at {}",
                           strange, trajectory.size(), format_stamp(*first_strange)));
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    if (trajectory[i].stamp_ns == trajectory[i - 1].stamp_ns)
      child.fail(
          fmt::format("wrote two poses for the frame at {}", format_stamp(trajectory[i].stamp_ns)));
  return trajectory;
}

}  // namespace

std::vector<Stamp> write_dataset(
    const fs::path& folder, const Camera& camera, std::size_t count,
    const std::function<std::optional<RgbdFrame>(std::size_t)>& frame) {
  std::vector<Stamp> stamps;
  TumWriter writer(folder, camera);
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<RgbdFrame> seen = frame(i);
    if (!seen) continue;
    writer.add(*seen);
    stamps.push_back(seen->stamp_ns);
  }
  writer.finish();
  return stamps;
}

Trajectory run_on_dataset(const OutsideProgram& program, const fs::path& folder,
                          std::span<const Stamp> stamps, std::uint64_t seed, const fs::path& log,
                          const std::function<void(std::size_t)>& read) {
  validate(program);
  const fs::path place = fs::absolute(folder), dataset = place / "dataset";
  const fs::path trajectory = place / kTrajectory;
  const std::string command =
      expand_command(program.command, {{"dataset", dataset.string()},
                                       {"associations", (dataset / "associations.txt").string()},
                                       {"settings", (dataset / "camera.yaml").string()},
                                       {"labels", (dataset / "label.txt").string()},
                                       {"trajectory", trajectory.string()},
                                       {"seed", std::to_string(seed)}});
  const fs::path home = fs::canonical(place);
  ChildProcess child(program, command, ChildProcess::Talk::kNo, fs::absolute(log), place);
  FramesRead images(dataset / "rgb");
  child.wait_for_success(program.run_limit_s, [&] { read(images.count()); });
  read(images.count());
  try {
    const std::string text = written_text(home, child);
    if (tracked_nothing(text)) return {};
    return with_frame_stamps(parse_trajectory(text, trajectory.string()), stamps, child);
  } catch (const InputError& error) {
    child.fail(fmt::format("wrote a bad trajectory: {}", error.what()));
  }
}

}  // namespace mh
