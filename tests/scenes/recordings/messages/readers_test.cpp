// SPDX-License-Identifier: Apache-2.0
// Our files in readers by others: @mcap/core with @foxglove/rosmsg2-serialization (npm), and
// python3-rosbag. If a reader is missing, its test is skipped.
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/recordings/messages/marker_types.hpp"
#include "scenes/recordings/messages/message_writer.hpp"
#include "scenes/recordings/ros/recorder.hpp"
#include "sim/simulation/robot_messages.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 5;
const fs::path kReaders = fs::path(MH_SOURCE_DIR) / "tests/scenes/recordings/messages/readers";

Stamp stamp_ns(int i) {
  return 1'700'000'000'000'000'000 + i * 33'333'333;
}

/// A frame of 8 x 6 pixels with one object.
ExactFrame frame(int i) {
  ExactFrame frame;
  frame.seen.stamp_ns = stamp_ns(i);
  frame.seen.color = Grid2d<Rgb8>(8, 6, Rgb8{1, 2, 3});
  frame.seen.depth_m = Grid2d<float>(8, 6, 1.25F);
  frame.classes = Grid2d<ClassId>(8, 6, ClassId{5});
  frame.instances = Grid2d<InstanceId>(8, 6);
  frame.instances(2, 3) = frame.instances(4, 3) = 700;
  frame.world_from_camera = SE3(Eigen::Matrix3d::Identity(), {0.1 * i, 2, 3});
  return frame;
}

/// Adds a box with its name, and a list of two cubes.
void write_markers(MessageWriter& file) {
  ros::Marker box;
  box.header = {0, {stamp_ns(0)}, "map"};
  box.ns = "boxes";
  box.text = "chair 2";
  box.color = {0.25F, 0.5F, 1, 0.5F};
  ros::Marker cubes = box;
  cubes.type = ros::Marker::kCubeList;
  cubes.points = {{1, 2, 3}, {4, 5, 6}};
  cubes.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}};
  const auto write = [&]<class M>(const char* topic, const M& message) {
    const std::uint16_t number = file.add_topic(topic_spec<M>(topic, file.wire(), true));
    file.write(number, stamp_ns(0), ros::serialized(message, file.wire()));
  };
  write("/objects", ros::MarkerArray{{box}});
  write("/voxels", cubes);
}

/// Writes everything that a drive and a map can contain.
void write_drive(std::unique_ptr<MessageWriter> file) {
  auto equipment = std::make_shared<Equipment>();
  for (const char* name : {"front", "left", "right"})
    equipment->lasers.push_back({.name = name, .base_from_laser = {}, .rays = 3});
  for (const char* name : {"front", "back"})
    equipment->sonars.push_back({.name = name, .base_from_sonar = {}});
  equipment->bumpers = {"bow"};
  equipment->base_from_imu.emplace();
  Robot robot;
  robot.equipment = equipment;
  DrivenPath path;
  RobotReadings readings;
  for (int i = 0; i < kFrames; ++i) {
    path.base.push_back({stamp_ns(i), SE3(Eigen::Matrix3d::Identity(), {0.1 * i, 2, 0})});
    path.camera.push_back({stamp_ns(i), frame(i).world_from_camera});
    readings.odometry.push_back(path.base.back());
    readings.moments.push_back({.stamp_ns = stamp_ns(i),
                                .lasers_m = {{0, 1, 2}, {1, 2, 3}, {2, 3, 4}},
                                .sonars_m = {0, 1},
                                .bumpers = {true}});
  }
  FloorGrid grid;
  grid.clearance_m = Grid2d<float>(3, 2, 1.0F);
  grid.occupant = Grid2d<InstanceId>(3, 2);
  write_markers(*file);
  const ros::Wire wire = file->wire();
  Camera camera;
  camera.width_px = 8;
  camera.height_px = 6;
  RosRecorder recorder(std::move(file), camera,
                       robot_messages(wire, {robot, path, path.camera, readings, grid, SE3()}));
  for (int i = kFrames - 1; i >= 0; --i) recorder.add(static_cast<std::size_t>(i), frame(i));
  recorder.finish();
}

struct Ran {
  int code = 0;
  std::string out;
};

Ran run(const std::string& command) {
  Ran ran;
  FILE* const pipe = popen(command.c_str(), "r");
  for (int c = 0; pipe != nullptr && (c = fgetc(pipe)) != EOF;)
    ran.out.push_back(static_cast<char>(c));
  const int status = pclose(pipe);
  ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

/// Checks what both readers have to find.
void expect_all_topics(const nlohmann::json& found, const char* infix) {
  const auto expect_topic = [&](const std::string& name, const std::string& type,
                                const std::string& frame_id, int count = kFrames) {
    ASSERT_TRUE(found.at("topics").contains(name)) << name;
    const nlohmann::json& topic = found.at("topics").at(name);
    EXPECT_EQ(topic.at("type"), fmt::format(fmt::runtime(type), infix)) << name;
    EXPECT_EQ(topic.at("count"), count) << name;
    if (frame_id.empty()) return;
    EXPECT_EQ(topic.at("frames"), nlohmann::json({frame_id})) << name;
    for (int i = 0; i < count; ++i)
      EXPECT_EQ(topic.at("stamps").at(i), std::to_string(stamp_ns(i))) << name;
  };
  const std::string optical = "camera_optical_frame";
  expect_topic("/camera/color/image_raw", "sensor_msgs/{}Image", optical);
  expect_topic("/camera/color/camera_info", "sensor_msgs/{}CameraInfo", optical);
  expect_topic("/camera/depth_registered/image", "sensor_msgs/{}Image", optical);
  expect_topic("/camera/depth_registered/camera_info", "sensor_msgs/{}CameraInfo", optical);
  expect_topic("/camera/projector/camera_info", "sensor_msgs/{}CameraInfo", optical, 1);
  expect_topic("/camera/labels/image", "sensor_msgs/{}Image", optical);
  expect_topic("/camera/labels/names", "std_msgs/{}String", "", 1);
  expect_topic("/camera/instances/image", "sensor_msgs/{}Image", optical);
  expect_topic("/camera/detections", "vision_msgs/{}Detection2DArray", optical);
  expect_topic("/ground_truth/camera_pose", "geometry_msgs/{}PoseStamped", "map");
  expect_topic("/ground_truth/pose", "geometry_msgs/{}PoseStamped", "map");
  expect_topic("/tf", "tf2_msgs/{}TFMessage", "map");
  expect_topic("/tf_static", "tf2_msgs/{}TFMessage", "base_footprint", 1);
  expect_topic("/odom", "nav_msgs/{}Odometry", "odom");
  for (const char* side : {"front", "left", "right"})
    expect_topic(fmt::format("/scan/{}", side), "sensor_msgs/{}LaserScan",
                 fmt::format("laser_{}", side));
  for (const char* side : {"front", "back"})
    expect_topic(fmt::format("/sonar/{}", side), "sensor_msgs/{}Range",
                 fmt::format("sonar_{}", side));
  expect_topic("/bumper/bow", "std_msgs/{}Bool", "");
  expect_topic("/imu/data", "sensor_msgs/{}Imu", "imu_link");
  expect_topic("/map", "nav_msgs/{}OccupancyGrid", "map", 1);
  expect_topic("/objects", "visualization_msgs/{}MarkerArray", "", 1);
  expect_topic("/voxels", "visualization_msgs/{}Marker", "map", 1);
  EXPECT_EQ(found.at("topics").size(), 24U);
  EXPECT_EQ(found.at("messages"), 18 * kFrames + 6);
  EXPECT_EQ(found.at("topics").at("/camera/depth_registered/image").at("bytes"),
            kFrames * 8 * 6 * 4);
}

class Readers : public testing::TestWithParam<ChunkCompression> {
 protected:
  TemporaryFolder work_{fs::temp_directory_path()};
};

TEST_P(Readers, OfNpmDecodeEveryMessageOfOurMcap) {
  if (run("command -v npm && command -v node").code != 0) GTEST_SKIP() << "npm is missing";
  const fs::path home = MH_READERS;
  fs::create_directories(home);
  for (const char* file : {"package.json", "package-lock.json", "read_mcap.mjs"})
    fs::copy_file(kReaders / file, home / file, fs::copy_options::overwrite_existing);
  // Only one process at a time installs the readers; an installation that is up to date is kept.
  const Ran installed = run(
      fmt::format("cd '{}' && flock lock sh -c 'cmp -s package-lock.json installed || (npm ci "
                  "--ignore-scripts --no-audit --no-fund && cp package-lock.json installed)' 2>&1",
                  home.string()));
  if (installed.code != 0) GTEST_SKIP() << "npm cannot install the readers: " << installed.out;
  const fs::path file = work_.path() / "drive.mcap";
  write_drive(write_mcap(file, GetParam()));
  const Ran read =
      run(fmt::format("cd '{}' && node read_mcap.mjs '{}' 2>&1", home.string(), file.string()));
  ASSERT_EQ(read.code, 0) << read.out;
  const nlohmann::json found = nlohmann::json::parse(read.out);
  expect_all_topics(found, "msg/");
  const auto last = [&](const char* topic) {
    return nlohmann::json::parse(
        found.at("topics").at(topic).at("last").get_ref<const std::string&>());
  };
  const nlohmann::json detection = last("/camera/detections").at("detections").at(0);
  EXPECT_EQ(detection.at("results").at(0).at("hypothesis").at("class_id"), "chair");
  EXPECT_EQ(detection.at("bbox").at("center").at("position").at("x"), 3);
  EXPECT_EQ(detection.at("bbox").at("size_x"), 3);
  EXPECT_EQ(detection.at("id"), "700");
  EXPECT_EQ(last("/map").at("info").at("width"), 3);
  const nlohmann::json box = last("/objects").at("markers").at(0);
  EXPECT_EQ(box.at("text"), "chair 2");
  EXPECT_EQ(box.at("color").at("g"), 0.5);
  EXPECT_EQ(last("/voxels").at("points").at(1).at("z"), 6);
  EXPECT_EQ(last("/voxels").at("colors").at(1).at("g"), 1);
  EXPECT_EQ(last("/ground_truth/camera_pose").at("pose").at("position").at("y"), 2);
}

TEST_P(Readers, OfPythonDecodeEveryMessageOfOurBag) {
  if (GetParam() == ChunkCompression::kZstd) GTEST_SKIP() << "bags have no zstd";
  const fs::path file = work_.path() / "drive.bag";
  write_drive(write_bag(file, GetParam()));
  const Ran read = run(fmt::format("/usr/bin/python3 '{}' '{}' 2>&1",
                                   (kReaders / "read_bag.py").string(), file.string()));
  if (read.code == 77) GTEST_SKIP() << "python3-rosbag is missing";
  ASSERT_EQ(read.code, 0) << read.out;
  expect_all_topics(nlohmann::json::parse(read.out), "");
  const Ran info = run(fmt::format("rosbag info '{}' 2>&1", file.string()));
  if (info.code == 127) return;
  EXPECT_EQ(info.code, 0);
  for (const char* part : {"2.0", "/scan/left", "sensor_msgs/LaserScan", "/camera/detections",
                           "vision_msgs/Detection2DArray", "/tf_static"})
    EXPECT_NE(info.out.find(part), std::string::npos) << part << " in " << info.out;
}

INSTANTIATE_TEST_SUITE_P(All, Readers,
                         testing::Values(ChunkCompression::kNone, ChunkCompression::kLz4,
                                         ChunkCompression::kZstd));

}  // namespace
}  // namespace mh
