// SPDX-License-Identifier: Apache-2.0
#include "robots/model/robot.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "robots/model/robot_keys.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

const std::string kPepper = MH_SOURCE_DIR "/robots/pepper/pepper.yaml";

/// The error of load_robot() for this text in place of Pepper's file; "no error" if it is accepted.
std::string verdict_on(const std::string& text) {
  const TemporaryFolder folder(testing::TempDir());  // tests run in parallel
  const std::filesystem::path file = folder.path() / "robot.yaml";
  write_atomically(folder.path() / "pepper.urdf",
                   read_file(MH_SOURCE_DIR "/robots/pepper/pepper.urdf"));
  write_atomically(file, text);
  try {
    load_robot(file);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

/// The message with which Pepper's file is refused after one edit.
std::string refusal(const std::string& from, const std::string& to) {
  std::string text = read_file(kPepper);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return verdict_on(text);
}

TEST(LoadRobot, PepperHasItsPublishedFigures) {
  const Robot robot = load_robot(kPepper);
  EXPECT_EQ(robot.name, "pepper");
  EXPECT_DOUBLE_EQ(robot.mass_kg, 28.681);
  EXPECT_DOUBLE_EQ(robot.footprint_radius_m, 0.26);
  EXPECT_DOUBLE_EQ(robot.height_m, 1.21);
  EXPECT_DOUBLE_EQ(robot.limits.max_velocity_m_per_s, 0.55);
  EXPECT_DOUBLE_EQ(robot.limits.max_acceleration_m_per_s2, 0.55);
  EXPECT_DOUBLE_EQ(robot.limits.max_turn_rad_per_s, 1.0);
}

TEST(LoadRobot, FieldOfViewSpansTheImage) {
  const Camera camera = load_robot(kPepper).camera;
  // Image borders are half a pixel outside the centers of the outermost pixels.
  const double left = std::atan((-0.5 - camera.cx_px) / camera.fx_px);
  const double right = std::atan((camera.width_px - 0.5 - camera.cx_px) / camera.fx_px);
  EXPECT_NEAR((right - left) * 180 / std::numbers::pi, 58.0, 1e-9);
  const double top = std::atan((-0.5 - camera.cy_px) / camera.fy_px);
  const double bottom = std::atan((camera.height_px - 0.5 - camera.cy_px) / camera.fy_px);
  EXPECT_NEAR((bottom - top) * 180 / std::numbers::pi, 45.0, 1e-9);
}

TEST(LoadRobot, OpticalAxesFollowRep103) {
  const SE3 base_from_camera = load_robot(kPepper).base_from_camera;
  EXPECT_TRUE(base_from_camera.translation().isApprox(Eigen::Vector3d(0.0134, 0.0390, 1.1093)));
  // The base's forward direction is the camera's z; the base's left is the camera's -x.
  const Eigen::Matrix3d camera_from_base = base_from_camera.rotation().transpose();
  EXPECT_TRUE((camera_from_base * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE((camera_from_base * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitX()));
  EXPECT_TRUE((camera_from_base * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitY()));
}

TEST(LoadRobot, RefusesBadFilesWithFileLinePlaceAndValue) {
  EXPECT_NE(refusal("mass_kg: 28.681", "mass_kg: -3").find("base.mass_kg: -3 is outside"),
            std::string::npos);
  EXPECT_NE(refusal("name: pepper", "name: pepper\ncolor: white").find("color"), std::string::npos);
  EXPECT_NE(refusal("width_px: 640", "width_px: wide").find("camera.width_px: 'wide'"),
            std::string::npos);
  EXPECT_NE(refusal("  rate_hz: 30.0", "  # rate").find("key 'rate_hz' is missing"),
            std::string::npos);
  EXPECT_THROW(load_robot("/no/such/robot.yaml"), InputError);
}

TEST(LoadRobot, EveryPartOfTheEquipmentMayBeAbsent) {
  const TemporaryFolder folder(testing::TempDir());
  write_atomically(folder.path() / "r.urdf",
                   "<robot name=\"r\"><link name=\"base_footprint\"/></robot>");
  const std::string pepper = read_file(kPepper);
  write_atomically(folder.path() / "r.yaml",
                   pepper.substr(0, pepper.find("equipment:")) + "equipment: {urdf: r.urdf}\n");
  const Robot robot = load_robot(folder.path() / "r.yaml");
  ASSERT_NE(robot.equipment, nullptr);
  EXPECT_EQ(robot.wheels(), nullptr);
  EXPECT_EQ(robot.differential(), nullptr);
  EXPECT_FALSE(robot.equipment->head);
  EXPECT_FALSE(robot.equipment->base_from_imu);
  EXPECT_FALSE(robot.equipment->reflex);
  EXPECT_TRUE(robot.equipment->lasers.empty());
  EXPECT_EQ(robot.equipment->odometry.scale, 0);
}

TEST(LoadRobot, TurtleBotIsADifferentialDriveAsPublished) {
  std::vector<std::string> warnings;
  const Robot robot = load_robot(MH_SOURCE_DIR "/robots/turtlebot3/turtlebot3.yaml", &warnings);
  EXPECT_TRUE(warnings.empty()) << warnings.front();
  const WheelBase* wheels = robot.differential();
  ASSERT_NE(wheels, nullptr);
  EXPECT_NEAR(wheels->wheels[0].place_m.y() - wheels->wheels[1].place_m.y(), 0.288, 1e-12);
  EXPECT_EQ(wheels->radius_m, 0.033);
  // The maximum speeds in the data sheet are those that the wheels can reach: 0.26 m/s, and 1.82
  // rad/s times half the track.
  EXPECT_NEAR(wheels->max_rim_m_per_s, robot.limits.max_velocity_m_per_s, 1e-3);
  EXPECT_NEAR(wheels->max_rim_m_per_s, robot.limits.max_turn_rad_per_s * 0.144, 3e-3);
  const SE3 camera = robot.equipment->base_from(robot.equipment->depth_camera_link);
  EXPECT_LT((camera.translation() - robot.base_from_camera.translation()).norm(), 1e-9);
  EXPECT_LT(angle_between_rad(camera, robot.base_from_camera), 1e-6);
}

/// The error or warning of load_robot() for a base on wheels of 3 cm radius at (0, 0.1) and (0,
/// -0.1).
std::string verdict_on_wheels(const std::string& joint_edit, const std::string& by,
                              const std::string& wheels = "[l, r]", const std::string& more = "") {
  const TemporaryFolder folder(testing::TempDir());
  std::string urdf =
      "<robot name=\"r\"><link name=\"body\"/><link name=\"ground\"/><link name=\"L\"/><link "
      "name=\"R\"/>\n"
      "<joint name=\"g\" type=\"fixed\"><parent link=\"body\"/><child link=\"ground\"/><origin "
      "xyz=\"0 0 -0.1\"/></joint>\n"
      "<joint name=\"l\" type=\"continuous\"><parent link=\"body\"/><child link=\"L\"/><origin "
      "xyz=\"0 0.1 -0.07\"/><axis xyz=\"0 1 0\"/></joint>\n"
      "<joint name=\"r\" type=\"continuous\"><parent link=\"body\"/><child link=\"R\"/><origin "
      "xyz=\"0 -0.1 -0.07\"/><axis xyz=\"0 -1 0\"/></joint></robot>";
  for (std::size_t at; !joint_edit.empty() && (at = urdf.find(joint_edit)) != std::string::npos;)
    urdf.replace(at, joint_edit.size(), by);
  write_atomically(folder.path() / "r.urdf", urdf);
  const std::string pepper = read_file(kPepper);
  write_atomically(folder.path() / "r.yaml",
                   pepper.substr(0, pepper.find("equipment:")) + "equipment:\n  urdf: r.urdf\n  " +
                       more + "wheels: {radius_m: 0.03, joints: " + wheels + "}\n");
  std::vector<std::string> warnings;
  try {
    load_robot(folder.path() / "r.yaml", &warnings);
  } catch (const InputError& e) {
    return e.what();
  }
  return warnings.empty() ? "no error" : "warning: " + warnings.front();
}

TEST(LoadRobot, WheelsThatDoNotRollOnTheFloorAreNamed) {
  const auto expect_in = [](const std::string& part, const std::string& text) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const std::string ground = "base_link: ground\n  ";
  EXPECT_EQ(verdict_on_wheels("", "", "[l, r]", ground), "no error");
  expect_in("warning: ", verdict_on_wheels("", ""));
  expect_in("would stand 0.100 m below the floor", verdict_on_wheels("", ""));
  expect_in("'l' is listed twice", verdict_on_wheels("", "", "[l, l]", ground));
  expect_in("has no joint 'x'", verdict_on_wheels("", "", "[l, x]", ground));
  expect_in("has no link 'x'", verdict_on_wheels("", "", "[l, r]", "base_link: x\n  "));
  expect_in("joint 'g' is not a wheel joint: it does not turn",
            verdict_on_wheels("", "", "[l, g]", ground));
  expect_in("joint 'l' is not a wheel joint: it turns about an upright axis",
            verdict_on_wheels("0 1 0", "0 0 1", "[l, r]", ground));
  const std::string on_body = "<joint name=\"l\" type=\"continuous\"><parent link=\"body\"/>",
                    on_knuckle =
                        "<link name=\"knuckle\"/><joint name=\"s\" type=\"continuous\"><parent "
                        "link=\"body\"/><child link=\"knuckle\"/><axis xyz=\"0 0 1\"/></joint>"
                        "<joint name=\"l\" type=\"continuous\"><parent link=\"knuckle\"/>";
  expect_in("joint 'l' is steered by joint 's'",
            verdict_on_wheels(on_body, on_knuckle, "[l, r]", ground));
  expect_in("warning: ",
            verdict_on_wheels(on_body, on_knuckle, "[l, r]", "base_link: knuckle\n  "));
  expect_in("velocity of joint 'l' to 0",
            verdict_on_wheels("<axis xyz=\"0 1 0\"/>",
                              "<axis  xyz=\"0 1 0\"/><limit effort=\"1\" velocity=\"0\"/>",
                              "[l, r]", ground));
}

/// The node in Pepper's file for a path such as "equipment.lasers.NAME".
YAML::Node node_at(YAML::Node node, const std::string& mapping) {
  std::istringstream parts(mapping);
  for (std::string part; std::getline(parts, part, '.');)
    node.reset(part == "NAME" ? node.begin()->second : node[part]);
  return node;
}

std::string verdict(const YAML::Node& edited) {
  std::ostringstream text;
  text << edited;
  return verdict_on(text.str());
}

TEST(RobotKeys, AreThoseThatTheLoaderKnows) {
  std::map<std::string, std::set<std::string>> reported;
  for (const RobotKey& key : robot_keys())
    ASSERT_TRUE(reported[std::string(key.mapping)].insert(std::string(key.key)).second) << key.key;
  for (const auto& [mapping, keys] : reported) {
    YAML::Node robot = YAML::LoadFile(kPepper);
    node_at(robot, mapping)["zzz"] = 1;
    EXPECT_NE(verdict(robot).find(fmt::format("(known here: {})", fmt::join(keys, ", "))),
              std::string::npos)
        << mapping << ": " << verdict(robot);
  }
}

TEST(RobotKeys, RangesAndWhatIsNeededAreTheLoaders) {
  for (const RobotKey& key : robot_keys()) {
    const std::string name(key.key);
    YAML::Node without = YAML::LoadFile(kPepper);
    node_at(without, std::string(key.mapping)).remove(name);
    EXPECT_EQ(verdict(without) == "no error", !key.required) << key.mapping << '.' << name;
    if (!key.value.starts_with('[')) continue;
    YAML::Node huge = YAML::LoadFile(kPepper);
    node_at(huge, std::string(key.mapping))[name] = 1000000000;
    EXPECT_NE(verdict(huge).find(fmt::format("is outside {}", key.value)), std::string::npos)
        << key.mapping << '.' << name << ": " << verdict(huge);
  }
}

}  // namespace
}  // namespace mh
