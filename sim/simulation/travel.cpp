// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/travel.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/floor.hpp"
#include "scenes/generate/generate.hpp"
#include "sim/motion/automatic.hpp"
#include "sim/motion/commands.hpp"
#include "sim/motion/handheld_scan.hpp"
#include "sim/motion/replay.hpp"
#include "slam/core/interpolate.hpp"
#include "slam/core/path_length.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

struct Motion {
  enum class Kind { kTour, kAuto, kHandheld, kReplay, kCommands } kind = Kind::kTour;
  std::filesystem::path file = {};
  std::uint64_t seed = 0;
  std::optional<std::size_t> frames = {};
  bool survey = false;
};

std::uint64_t number(const std::string& motion, std::string_view text, const char* what) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(fmt::format("motion '{}': {} '{}' is not an integer", motion, what, text));
  return value;
}

Motion parse(const std::string& motion) {
  std::string_view text = motion;
  if (text.starts_with(kGeneratedPrefix)) text.remove_prefix(kGeneratedPrefix.size());
  if (text.starts_with("replay:"))
    return {.kind = Motion::Kind::kReplay, .file = std::string(text.substr(7))};
  if (text.starts_with("commands:"))
    return {.kind = Motion::Kind::kCommands, .file = std::string(text.substr(9))};
  std::vector<std::string_view> parts;
  for (std::string_view rest = text;;) {
    const auto colon = rest.find(':');
    parts.push_back(rest.substr(0, colon));
    if (colon == std::string_view::npos) break;
    rest.remove_prefix(colon + 1);
  }
  const bool handheld = parts[0] == "handheld", survey = parts[0] == "survey";
  if (!handheld && !survey && parts[0] != "auto") {
    if (text.size() != motion.size())
      throw InputError(fmt::format("motion '{}': '{}' is neither 'auto', 'survey' nor 'handheld'",
                                   motion, parts[0]));
    return {.file = motion};
  }
  if (parts.size() > (handheld ? 3U : 2U))
    throw InputError(fmt::format("motion '{}': unexpected part '{}'", motion, parts.back()));
  Motion result{.kind = handheld ? Motion::Kind::kHandheld : Motion::Kind::kAuto, .survey = survey};
  if (parts.size() > 1) result.seed = number(motion, parts[1], "seed");
  if (parts.size() > 2) {
    result.frames = number(motion, parts[2], "number of frames");
    validate(HandheldConfig{.frames = result.frames});
  }
  return result;
}

/// Notes on the parts of a recorded path that cannot be replayed. @throws InputError if no part can
/// be replayed
std::vector<std::string> notes_on_replay(const std::filesystem::path& file) {
  std::vector<std::string> notes;
  read_trajectory(file, &notes);
  return notes;
}

/// @pre the scene's floor is z = 0
DrivenPath travel_on_level(const Scene& scene, const Robot& robot, const Motion& motion,
                           const std::vector<MovingObstacle>& others) {
  switch (motion.kind) {
    case Motion::Kind::kAuto:
      return drive(scene, robot,
                   automatic_tour(scene, robot, {.seed = motion.seed, .survey = motion.survey}),
                   others);
    case Motion::Kind::kHandheld:
      return handheld_scan(scene, robot.camera, {.seed = motion.seed, .frames = motion.frames});
    case Motion::Kind::kReplay: {
      std::vector<std::string> told_by_note_on;
      return replay(scene, robot.camera, read_trajectory(motion.file, &told_by_note_on),
                    motion.file.string());
    }
    case Motion::Kind::kCommands:
      return drive(scene, robot, load_commands(motion.file), others).path;
    case Motion::Kind::kTour:
      break;
  }
  return drive(scene, robot, load_tour(motion.file), others);
}

}  // namespace

void check_motion(const std::string& motion) {
  const Motion parsed = parse(motion);
  if (parsed.kind == Motion::Kind::kTour) load_tour(parsed.file);
  if (parsed.kind == Motion::Kind::kReplay) notes_on_replay(parsed.file);
  if (parsed.kind == Motion::Kind::kCommands) load_commands(parsed.file);
}

bool is_driven(const std::string& motion) {
  const Motion::Kind kind = parse(motion).kind;
  return kind != Motion::Kind::kHandheld && kind != Motion::Kind::kReplay;
}

std::optional<std::size_t> frames_stated(const std::string& motion) {
  return parse(motion).frames;
}

std::string note_on(const std::string& motion, const Robot& robot) {
  const Motion parsed = parse(motion);
  if (parsed.kind == Motion::Kind::kReplay)
    return fmt::format("{}", fmt::join(notes_on_replay(parsed.file), "; "));
  if (parsed.kind != Motion::Kind::kTour) return "";
  const Tour tour = load_tour(parsed.file);
  constexpr double kDegreesPerRad = 180 / std::numbers::pi;
  const auto slower = [&](const char* key, double asked, double limit) {
    return asked <= limit ? ""
                          : fmt::format("{}: {} {:g} is more than robot '{}' can do: {:g}",
                                        parsed.file.string(), key, asked, robot.name, limit);
  };
  if (tour.max_velocity_m_per_s)
    if (const std::string note =
            slower("speed_m_per_s", *tour.max_velocity_m_per_s, robot.limits.max_velocity_m_per_s);
        !note.empty())
      return note;
  if (tour.max_turn_rad_per_s)
    if (const std::string note = slower("turn_deg_per_s", kDegreesPerRad * *tour.max_turn_rad_per_s,
                                        kDegreesPerRad * robot.limits.max_turn_rad_per_s);
        !note.empty())
      return note;
  if (robot.differential() != nullptr)
    for (const Waypoint& waypoint : tour.waypoints)
      if (waypoint.look_at_m)
        return fmt::format(
            "{}:{}: robot '{}' has a differential drive: it faces its direction of travel, not the "
            "place in 'face'",
            parsed.file.string(), waypoint.line, robot.name);
  return "";
}

MovingObstacle as_obstacle(const Scene& scene, const Pedestrian& pedestrian, double from_s) {
  return {.radius_m = kPedestrianRadius_m,
          .height_m = kPedestrianHeight_m,
          .instance = pedestrian_instance(scene),
          .path = [=](double time_s) -> Eigen::Vector2d {
            return world_from_pedestrian(pedestrian, std::llround(1e9 * (from_s + time_s)))
                .translation()
                .head<2>();
          }};
}

DrivenPath travel(const Scene& scene, const Robot& robot, const std::string& motion,
                  const std::vector<MovingObstacle>& others) {
  const LevelScene level(scene);
  DrivenPath path = travel_on_level(*level, robot, parse(motion), others);
  if (scene.floor.is_level_zero()) return path;
  if (!path.moved.empty()) path.moved += ", their ground plane moved onto the scene's floor";
  for (Trajectory* poses : {&path.camera, &path.base})
    for (TimedPose& pose : *poses)
      pose.world_from_camera = level.world_from_level() * pose.world_from_camera;
  return path;
}

bool cut(DrivenPath& path, std::size_t max_frames) {
  if (path.camera.size() <= max_frames) return false;
  path.camera.resize(max_frames);
  path.base.resize(max_frames);
  path.length_m = path_length_m(path.base);
  path.turned_in_place_rad = path.contact_time_s = path.max_penetration_m =
      std::numeric_limits<double>::quiet_NaN();
  return true;
}

DrivenPath hurried(DrivenPath path, const std::string& motion, const SensorConfig& level,
                   double rate_hz) {
  const double speed = level.hurry.factor();
  if (speed == 1 || is_driven(motion)) return path;
  for (Trajectory* poses : {&path.camera, &path.base}) {
    const Trajectory slow = std::exchange(*poses, {});
    for (std::size_t i = 0; !slow.empty(); ++i) {
      const double after_ns = static_cast<double>(i) * 1e9 / rate_hz;
      const Stamp first_ns = slow.front().stamp_ns;
      const auto pose = interpolated_pose(slow, first_ns + std::llround(after_ns * speed));
      if (!pose) break;
      poses->push_back({first_ns + std::llround(after_ns), *pose});
    }
  }
  path.contact_time_s /= speed;
  if (!path.moved.empty())
    path.moved += fmt::format(", {:g} times as fast because of the level's hurry", speed);
  return path;
}

DrivenPath joined(DrivenPath first, const DrivenPath& second, double rate_hz) {
  const auto add = [rate_hz](Trajectory& path, const Trajectory& more) {
    for (const TimedPose& pose : more)
      path.push_back(
          {std::llround(static_cast<double>(path.size()) * 1e9 / rate_hz), pose.world_from_camera});
  };
  add(first.camera, second.camera);
  add(first.base, second.base);
  first.length_m += second.length_m;
  first.turned_in_place_rad += second.turned_in_place_rad;
  first.max_penetration_m = std::max(first.max_penetration_m, second.max_penetration_m);
  first.contact_time_s += second.contact_time_s;
  return first;
}

}  // namespace mh
