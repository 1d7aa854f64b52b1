// SPDX-License-Identifier: Apache-2.0
#include "robots/model/urdf.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <set>

#include <gtest/gtest.h>

#include "robots/model/robot.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

const std::string kFolder = MH_SOURCE_DIR "/robots/pepper/";

std::string refusal_of(const std::string& text) {
  const std::string file = testing::TempDir() +
                           testing::UnitTest::GetInstance()->current_test_info()->name() +
                           "_urdf_test.urdf";
  write_atomically(file, text);
  try {
    load_urdf(file);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

/// The message with which Pepper's URDF is refused after one edit.
std::string urdf_refusal(const std::string& from, const std::string& to) {
  std::string text = read_file(kFolder + "pepper.urdf");
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return refusal_of(text.replace(at, from.size(), to));
}

/// The number of the line of Pepper's URDF that contains a text.
std::string line_of(const std::string& what) {
  const std::string text = read_file(kFolder + "pepper.urdf");
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return std::to_string(1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
}

TEST(LoadUrdf, PepperIsAsPublished) {
  const KinematicTree tree = load_urdf(kFolder + "pepper.urdf");
  EXPECT_EQ(tree.name, "pepper");
  EXPECT_EQ(tree.root, "base_footprint");
  EXPECT_NEAR(tree.mass_kg(), 28.681, 1e-6);
  const auto at = [&](const char* link) { return tree.root_from(link).translation(); };
  const auto near = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).norm() < 1e-4;  // published with four decimals
  };
  EXPECT_TRUE(near(at("torso"), {0, 0, 0.820}));
  EXPECT_TRUE(near(at("Neck"), {-0.038, 0, 0.9899}));
  EXPECT_TRUE(near(at("CameraTop_frame"), {0.0480, 0, 1.1527}));
  EXPECT_TRUE(near(at("CameraBottom_frame"), {0.0546, 0, 1.0517}));
  EXPECT_TRUE(near(at("CameraDepth_frame"), {0.0134, 0.0390, 1.1093}));
  EXPECT_TRUE(near(at("WheelB_link"), {-0.170, 0, 0.070}));
  EXPECT_DOUBLE_EQ(tree.joint("WheelFL").velocity, 6.28319);
  EXPECT_DOUBLE_EQ(tree.joint("HeadPitch").upper, 0.637045);
  EXPECT_TRUE(std::isinf(tree.joint("WheelFL").upper));
}

TEST(LoadUrdf, TheHeadMovesItsCameras) {
  const KinematicTree tree = load_urdf(kFolder + "pepper.urdf");
  // Aldebaran's Stand posture: the published pose of the top camera is (0.0266, -0.003, 1.1667),
  // 10.6 deg upward.
  const SE3 pose = tree.root_from("CameraTop_frame", {{"HeadPitch", -0.21169},
                                                      {"HeadYaw", -0.00767},
                                                      {"HipPitch", -0.02608},
                                                      {"HipRoll", -0.00460}});
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(0.0266, -0.003, 1.1667), 5e-4));
  const double up_rad = std::asin(pose.rotation()(2, 0));
  EXPECT_NEAR(up_rad * 180 / M_PI, 10.6, 0.1);
  // Yaw turns about the neck.
  const SE3 left = tree.root_from("CameraDepth_frame", {{"HeadYaw", M_PI_2}});
  EXPECT_TRUE(
      left.translation().isApprox(Eigen::Vector3d(-0.038 - 0.039, 0.05138, 0.9899 + 0.1194), 1e-6));
  EXPECT_THROW(tree.root_from("CameraDepth_frame", {{"HeadRoll", 0.1}}), InputError);
  EXPECT_THROW(tree.root_from("Tail"), InputError);
}

void expect_in(const std::string& part, const std::string& message) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(LoadUrdf, RefusesWhatIsNoRobot) {
  expect_in("urdf_test.urdf:" + line_of("<joint name=\"HeadYaw\"") +
                ": joint 'HeadYaw': its child link 'Nekc' is missing",
            urdf_refusal("<child link=\"Neck\"/>", "<child link=\"Nekc\"/>"));
  expect_in("its parent link 'Nekc' is missing",
            urdf_refusal("<parent link=\"Neck\"/>", "<parent link=\"Nekc\"/>"));
  expect_in(
      ":" + line_of("<link name=\"Tibia\"") + ": link 'Tibia': its mass -11.6 kg is not positive",
      urdf_refusal("<mass value=\"11.6015\"/>", "<mass value=\"-11.6\"/>"));
  expect_in(":" + line_of("<joint name=\"HeadPitch\"") + ": joint 'HeadPitch': its lower limit",
            urdf_refusal("lower=\"-0.706858\"", "lower=\"0.9\""));
  // Errors found by urdfdom are reported with a line, too.
  const std::string tibia = ":" + line_of("<link name=\"Tibia\"") + ": link 'Tibia': ";
  expect_in(tibia + "Inertial: mass [nan]",
            urdf_refusal("<mass value=\"11.6015\"/>", "<mass value=\"nan\"/>"));
  const std::string head = ":" + line_of("<joint name=\"HeadPitch\"") + ": joint 'HeadPitch': ";
  expect_in(head, urdf_refusal("lower=\"-0.706858\"", "lower=\"x\""));
  expect_in(head + "its limit has an upper end but no lower",
            urdf_refusal("lower=\"-0.706858\"", ""));
  const auto sphere = [](const char* radius) {
    return refusal_of(std::string("<robot name=\"r\">\n<link name=\"a\"><visual><geometry><sphere "
                                  "radius=\"") +
                      radius + "\"/></geometry></visual></link></robot>");
  };
  EXPECT_EQ(sphere("0.1"), "no error");
  expect_in("urdf_test.urdf:2: link 'a': the radius of its sphere is -0.1 m", sphere("-0.1"));
  expect_in("urdf_test.urdf:1: is not XML", refusal_of("this is not XML"));
  expect_in("urdf_test.urdf:2: is not XML", refusal_of("<robot name=\"r\">\n<link></robot>"));
  expect_in("urdf_test.urdf:1: is not XML", refusal_of(""));
  expect_in("urdf_test.urdf: ", refusal_of("<house/>"));
  expect_in("urdf_test.urdf: ", refusal_of("<robot name=\"r\"/>"));
  EXPECT_THROW(load_urdf("/no/such.urdf"), InputError);
}

TEST(LoadUrdf, AnInertiaThatNoBodyHasIsAWarningSinceNothingUsesIt) {
  EXPECT_EQ(urdf_refusal("ixx=\"0.129229\"", "ixx=\"9\""), "no error");
  const std::string file = testing::TempDir() + "inertia_urdf_test.urdf";
  const auto warnings_on = [&](const std::string& moments) {
    write_atomically(
        file, "<robot name=\"r\">\n<link name=\"arm\"><inertial><mass value=\"2\"/><inertia " +
                  moments + " ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link></robot>");
    std::vector<std::string> warnings;
    EXPECT_EQ(load_urdf(file, &warnings).mass_kg(), 2);
    return warnings;
  };
  // Moments of inertia as in TIAGo's published file: 0.00191 + 0.00846 < 0.01059, so no body can
  // have such moments.
  const auto warned = warnings_on("ixx=\"0.00191\" iyy=\"0.00846\" izz=\"0.01059\"");
  ASSERT_EQ(warned.size(), 1U);
  expect_in(
      "inertia_urdf_test.urdf:2: link 'arm': no body has the principal moments of inertia "
      "0.00191, 0.00846, 0.01059 kg m2",
      warned[0]);
  EXPECT_EQ(warnings_on("ixx=\"-1\" iyy=\"1\" izz=\"1\"").size(), 1U);
  EXPECT_TRUE(warnings_on("ixx=\"1\" iyy=\"1\" izz=\"2\"").empty());
}

TEST(LoadUrdf, TakesXacrosArgumentsAndPropertiesAndRefusesTheRest) {
  const std::string file = testing::TempDir() + "xacro_urdf_test.urdf";
  const auto robot = [](const std::string& top, const std::string& more) {
    return "<robot name=\"r\" xmlns:xacro=\"http://ros.org/wiki/xacro\">\n" + top +
           "<link name=\"${ns}base\"/><link name=\"${ns}b\"/>\n"
           "<joint name=\"j\" type=\"fixed\"><parent link=\"${ns}base\"/><child "
           "link=\"${ns}b\"/><!-- ${unknown} --></joint>\n" +
           more + "</robot>";
  };
  // Names are built as in the TurtleBot3's files.
  const std::string names =
      "<xacro:arg name=\"namespace\" default=\"a_\"/><xacro:property name=\"ns\" value=\"$(arg "
      "namespace)\"/>\n";
  write_atomically(file, robot(names, ""));
  const KinematicTree tree = load_urdf(file);
  EXPECT_EQ(tree.root, "a_base");
  EXPECT_EQ(tree.joint("j").child, "a_b");
  expect_in("urdf_test.urdf:2: '${ns}base' is xacro: expand the file first",
            refusal_of(robot("", "")));
  expect_in("urdf_test.urdf:5: '<xacro:wheel>' is xacro",
            refusal_of(robot(names, "<xacro:wheel side=\"left\"/>")));
  expect_in("'${2 * 3}' is xacro",
            refusal_of(robot(names,
                             "<link name=\"c\"><visual><geometry><sphere radius=\"${2 * "
                             "3}\"/></geometry></visual></link>")));
}

TEST(LoadUrdf, RefusesJointsInACircle) {
  const auto joint = [](const char* name, const char* parent, const char* child) {
    return std::string("<joint name=\"") + name + "\" type=\"fixed\"><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/></joint>\n";
  };
  const std::string links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>\n";
  const auto robot = [&](const std::string& joints) {
    return refusal_of("<robot name=\"r\">\n" + links + joints + "</robot>");
  };
  EXPECT_EQ(robot(joint("1", "a", "b") + joint("2", "b", "c")), "no error");
  // All joints form one circle: there is no root.
  expect_in("urdf_test.urdf:3: joint '1': link 'b' is part of a cycle",
            robot(joint("1", "a", "b") + joint("2", "b", "c") + joint("3", "c", "a")));
  // A circle next to a root.
  expect_in("urdf_test.urdf:3: joint '2': link 'c' is part of a cycle",
            robot(joint("2", "b", "c") + joint("3", "c", "b")));
  // A link attached to itself.
  expect_in("urdf_test.urdf:4: joint '2': link 'c' is part of a cycle",
            robot(joint("1", "a", "b") + joint("2", "c", "c")));
  expect_in("urdf_test.urdf:5: joint '3': link 'c' is the child of two joints, '2' and '3'",
            robot(joint("1", "a", "b") + joint("2", "a", "c") + joint("3", "b", "c")));
}

/// A robot of fixed joints (parent, child), named 0, 1, ... in their order.
std::string robot_of(const std::vector<std::pair<std::string, std::string>>& joints) {
  std::set<std::string> links;
  std::string text;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto& [parent, child] = joints[i];
    links.insert({parent, child});
    text += "<joint name=\"j" + std::to_string(100'000 + i) + "\" type=\"fixed\"><parent link=\"" +
            parent + "\"/><child link=\"" + child + "\"/></joint>\n";
  }
  for (const std::string& link : links) text += "<link name=\"" + link + "\"/>\n";
  return "<robot name=\"r\">\n" + text + "</robot>";
}

TEST(LoadUrdf, JointsComeInTheOrderInWhichTheirParentsBecomeKnown) {
  const std::string file = testing::TempDir() + "order_urdf_test.urdf";
  // The first pass adds a-b, a-d, b-f and d-h; the second adds f-g and h-i, which come before their
  // parents.
  write_atomically(
      file, robot_of({{"f", "g"}, {"h", "i"}, {"a", "b"}, {"a", "d"}, {"b", "f"}, {"d", "h"}}));
  std::string children;
  for (const Joint& joint : load_urdf(file).joints) children += joint.child;
  EXPECT_EQ(children, "bdfhgi");
}

TEST(LoadUrdf, AChainOfManyLinksIsReadAtOnce) {
  const std::string file = testing::TempDir() + "chain_urdf_test.urdf";
  std::vector<std::pair<std::string, std::string>> joints;  // the last one first: the worst order
  const auto link = [](int i) { return std::string("l").append(std::to_string(i)); };
  for (int i = 5000; i > 0; --i) joints.emplace_back(link(i - 1), link(i));
  write_atomically(file, robot_of(joints));
  const std::clock_t begin = std::clock();
  const KinematicTree tree = load_urdf(file);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC,
            5.0);  // quadratic time would be minutes
  ASSERT_EQ(tree.joints.size(), 5000U);
  EXPECT_EQ(tree.joints.front().child, "l1");
  EXPECT_EQ(tree.joints.back().child, "l5000");
}

TEST(Robot, PepperFileAndUrdfAgree) {
  const Robot robot = load_robot(kFolder + "pepper.yaml");
  ASSERT_NE(robot.equipment, nullptr);
  const Equipment& e = *robot.equipment;
  EXPECT_NEAR(e.tree.mass_kg(), robot.mass_kg, 1e-6);
  const SE3 camera = e.base_from(e.depth_camera_link);
  EXPECT_LT((camera.translation() - robot.base_from_camera.translation()).norm(), 1e-4);
  EXPECT_LT(angle_between_rad(camera, robot.base_from_camera), 1e-9);
  ASSERT_EQ(e.cameras.size(), 2U);
  EXPECT_EQ(e.lasers.size(), 3U);
  EXPECT_EQ(e.lasers[0].rays, 15);
  EXPECT_EQ(e.sonars.size(), 2U);
  EXPECT_EQ(e.bumpers.size(), 3U);
  EXPECT_NEAR(e.wheels->max_rim_m_per_s, 0.4398, 1e-4);
  EXPECT_DOUBLE_EQ(robot.limits.max_jerk_m_per_s3.value(), 1.0);
}

}  // namespace
}  // namespace mh
