// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/motion_option.hpp"
#include "bench/cli/ros_output.hpp"
#include "bench/cli/scene_option.hpp"
#include "robots/model/robot.hpp"
#include "scenes/floor.hpp"
#include "scenes/load.hpp"
#include "scenes/recordings/ros/recorder.hpp"
#include "sim/motion/robot_readings.hpp"
#include "sim/simulation/robot_messages.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

struct DriveArguments {
  std::string scene, robot = "pepper", pedestrian, out, format = "tum";
  RosOption ros;
  MotionOption motion;
  SceneFrameOption frame;
  std::uint64_t seed = 0;
  bool sensors = false;
  bool json = false;
};

void run(DriveArguments options) {
  resolve(options.scene, Shipped::kScene);
  resolve(options.robot, Shipped::kRobot);
  const std::string& motion = options.motion.given();
  if (options.sensors && options.out.empty())
    throw InputError("--sensors needs --out: a folder to write them into");
  const bool writes_ros = is_ros_format(options.format);
  options.ros.check(options.format);
  if (writes_ros && options.out.empty())
    throw InputError(
        fmt::format("--format {} needs --out: a folder to write the file into", options.format));
  check_motion(motion);
  const bool driven = is_driven(motion);
  for (const auto& [given, option] :
       {std::pair(options.sensors, "--sensors"), std::pair(writes_ros, "--format"),
        std::pair(!options.pedestrian.empty(), "--pedestrian")})
    if (given && !driven)
      throw InputError(fmt::format(
          "{}: motion '{}' moves a handheld camera, no robot drives along it", option, motion));
  const std::filesystem::path out = options.out;
  std::optional<OutputFolder> folder;
  if (!options.out.empty()) {
    std::vector<std::string> names{"camera.tum", "base.tum"};
    if (options.sensors) names.insert(names.end(), kReadingFiles.begin(), kReadingFiles.end());
    if (writes_ros) names.push_back(ros_file(options.format, out).filename().string());
    folder.emplace(out, "drive", std::move(names));
  }
  std::vector<std::string> warnings;
  const Robot robot = load_robot(options.robot, &warnings);
  const std::optional<Pedestrian> pedestrian =
      options.pedestrian.empty() ? std::nullopt
                                 : std::optional(load_pedestrian(options.pedestrian));
  const Scene scene = load_scene(options.scene, &warnings, options.frame.frame());
  print_warnings(warnings);
  std::vector<MovingObstacle> others;
  if (pedestrian) others.push_back(as_obstacle(scene, *pedestrian));
  if (const std::string note = note_on(motion, robot); !note.empty())
    fmt::print(stderr, "modelhouse: warning: {}\n", note);
  const DrivenPath path = travel(scene, robot, motion, others);
  if (!path.moved.empty()) fmt::print(stderr, "modelhouse: warning: {}\n", path.moved);
  if (options.sensors && !robot.equipment)
    throw InputError(
        fmt::format("robot '{}' has no sensors: its file has no 'equipment'", robot.name));
  if (options.sensors || writes_ros) {
    const DriveRecord record = record_drive(scene, robot, path, path.camera, options.seed, others);
    if (options.sensors) {
      write_readings(out, robot, *record.readings);
      if (!robot.equipment->wheels)
        fmt::print(stderr,
                   "modelhouse: note: robot '{}' has no wheels (its file: equipment.wheels): no "
                   "odometry.tum\n",
                   robot.name);
    }
    if (writes_ros) {
      const auto file = options.ros.open(options.format, out);
      write_log(*file, robot_messages(file->wire(), record));
    }
  }
  if (!options.out.empty()) {
    write_tum(out / "camera.tum", path.camera);
    write_tum(out / "base.tum", path.base);
  }
  const double seconds =
      path.camera.empty()
          ? 0
          : static_cast<double>(path.camera.back().stamp_ns - path.camera.front().stamp_ns) * 1e-9;
  const double turned_deg = path.turned_in_place_rad * 180 / std::numbers::pi;
  if (options.json) {
    const DrivePeaks& peaks = path.peaks;
    nlohmann::ordered_json json = {{"tour", motion},
                                   {"frames", path.camera.size()},
                                   {"duration_s", seconds},
                                   {"length_m", path.length_m},
                                   {"turned_in_place_deg", turned_deg},
                                   {"contact_time_s", path.contact_time_s},
                                   {"max_penetration_m", path.max_penetration_m},
                                   {"peaks", nullptr}};
    if (driven)
      json["peaks"] = {{"m_per_s", peaks.m_per_s},        {"m_per_s2", peaks.m_per_s2},
                       {"m_per_s3", peaks.m_per_s3},      {"rad_per_s", peaks.rad_per_s},
                       {"rad_per_s2", peaks.rad_per_s2},  {"rad_per_s3", peaks.rad_per_s3},
                       {"rim_m_per_s", peaks.rim_m_per_s}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  if (!driven) {
    fmt::print("{}: {} in {:.1f} s, {:.2f} m moved\n", motion, counted(path.camera.size(), "frame"),
               seconds, path.length_m);
    return;
  }
  fmt::print(
      "{}: {} in {:.1f} s, {:.2f} m driven, {:.0f} deg turned in place, {:.2f} s in "
      "contact (at most {:.4f} m deep)\n",
      motion, counted(path.camera.size(), "frame"), seconds, path.length_m, turned_deg,
      path.contact_time_s, path.max_penetration_m);
}

}  // namespace

void add_drive(CLI::App& app) {
  auto options = std::make_shared<DriveArguments>();
  CLI::App* command =
      app.add_subcommand("drive", "Drives the robot through a scene, or moves a handheld camera.");
  command
      ->add_option("scene", options->scene,
                   "Scene (YAML), mesh file, or the name of a shipped scene")
      ->required();
  options->motion.add_to(*command);
  options->frame.add_to(*command);
  command->add_option("--robot", options->robot, "Robot (YAML), or the name of a shipped one");
  command->add_option("--pedestrian", options->pedestrian,
                      "Adds a pedestrian (YAML), noticed by the collision reflex and the sensors");
  command->add_option("--out", options->out, "Folder for camera.tum and base.tum");
  command
      ->add_option("--format", options->format,
                   "mcap or rosbag: also writes NAME.mcap (ROS 2) or NAME.bag (ROS 1) into --out, "
                   "with tf, odometry, the robot's measurements and the floor's grid")
      ->check(one_of_words({"tum", "mcap", "rosbag"}));
  options->ros.add_to(*command);
  command->add_flag("--sensors", options->sensors,
                    "Also writes wheel odometry, lasers, sonars, bumpers and IMU into --out; not "
                    "for handheld motions, which no robot makes");
  command->add_option("--seed", options->seed, "Seed of the odometry's errors")
      ->check(seed_number());
  command->add_flag("--json", options->json, "Prints JSON");
  command->footer(
      "Example:\n  modelhouse drive model_house model_house/query --robot pepper --out out/drive");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
