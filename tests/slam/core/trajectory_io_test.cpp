// SPDX-License-Identifier: Apache-2.0
#include "slam/core/trajectory_io.hpp"

#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

std::string refusal_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string tum_error(const std::string& text) {
  return refusal_of([&] { parse_tum(text, "f.txt"); });
}

Trajectory some_trajectory() {
  Trajectory trajectory;
  for (int i = 0; i < 20; ++i)
    trajectory.push_back(
        {1'305'031'229'528'748'123 + i * 33'333'333LL,
         SE3(so3_exp({0.1 * i, -0.3 * i, 0.7}), Eigen::Vector3d(0.1 * i, 1.0 / 3.0, -1e-9 * i))});
  return trajectory;
}

TEST(ParseStamp, IsExactToTheNanosecond) {
  EXPECT_EQ(parse_stamp("0"), 0);
  EXPECT_EQ(parse_stamp("0.000"), 0);
  EXPECT_EQ(parse_stamp("1305031229.528748"), 1'305'031'229'528'748'000);
  // A double would end in ...535.
  EXPECT_EQ(parse_stamp("1403636580.013555527"), 1'403'636'580'013'555'527);
  EXPECT_EQ(parse_stamp("1.403636580013555527e+09"), 1'403'636'580'013'555'527);
  EXPECT_EQ(parse_stamp("+12e-1"), 1'200'000'000);
  EXPECT_EQ(parse_stamp(".5"), 500'000'000);
  EXPECT_EQ(parse_stamp("7."), 7'000'000'000);
  EXPECT_EQ(parse_stamp("0.0000000014"), 1);
  EXPECT_EQ(parse_stamp("0.0000000015"), 2);
  EXPECT_EQ(parse_stamp("0.00000000049"), 0);
  EXPECT_EQ(parse_stamp("1e-30"), 0);
}

TEST(ParseStamp, RejectsWhatIsNoTime) {
  for (const char* text : {"", ".", "-1", "1.2.3", "1e", "1e+", "1ee3", "12s", "nan", "inf", "0x10",
                           "1e99999999999", "9300000000", "1403636580013555527", "1 "})
    EXPECT_THROW(parse_stamp(text), InputError) << text;
}

TEST(FormatStamp, RoundTrips) {
  for (const Stamp stamp : {Stamp{0}, Stamp{1}, Stamp{999'999'999}, Stamp{1'000'000'000},
                            Stamp{1'403'636'580'013'555'527}})
    EXPECT_EQ(parse_stamp(format_stamp(stamp)), stamp);
  EXPECT_EQ(format_stamp(1'000'000'005), "1.000000005");
}

TEST(Tum, ReadsCommentsBlankLinesAndCarriageReturns) {
  const Trajectory t = parse_tum(
      "# header\n\n1.5 1 2 3 0 0 0.7 0.7\r\n\t2.5\t+4 5e0 -6 0 0 0 1 # tail\n   \n3 0 0 0 1 0 0 0",
      "f.txt");
  ASSERT_EQ(t.size(), 3U);
  EXPECT_EQ(t[0].stamp_ns, 1'500'000'000);
  EXPECT_EQ(t[1].world_from_camera.translation(), Eigen::Vector3d(4, 5, -6));
  // Quarter turn about z, w last: x goes to y. The quaternion's norm of 0.99 is mended.
  EXPECT_LT(
      (t[0].world_from_camera.rotation() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY())
          .norm(),
      1e-12);
}

TEST(Tum, RoundTripsThroughAFile) {
  const Trajectory written = some_trajectory();
  const auto file = std::filesystem::temp_directory_path() / "mh_metrics_round_trip.txt";
  write_tum(file, written);
  const Trajectory read = read_tum(file);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp_ns, written[i].stamp_ns);
    EXPECT_EQ(read[i].world_from_camera.translation(), written[i].world_from_camera.translation());
    EXPECT_LT(
        (read[i].world_from_camera.rotation() - written[i].world_from_camera.rotation()).norm(),
        1e-14);
  }
  std::filesystem::remove(file);
}

TEST(Tum, EveryErrorNamesFileLineAndValue) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_EQ(tum_error("# c\n1 2 3\n"),
            "f.txt:2: pose: 3 values, expected 8 (stamp tx ty tz qx qy qz qw)");
  EXPECT_EQ(tum_error(good + "2 0 0 0 0 0 0 1 9\n"),
            "f.txt:2: pose: 9 values, expected 8 (stamp tx ty tz qx qy qz qw)");
  EXPECT_EQ(tum_error(good + "2 0 nan 0 0 0 0 1\n"), "f.txt:2: ty: 'nan' is not finite");
  EXPECT_EQ(tum_error("1 0 0 inf 0 0 0 1\n"), "f.txt:1: tz: 'inf' is not finite");
  EXPECT_EQ(tum_error("1 0 0 0 x 0 0 1\n"), "f.txt:1: qx: 'x' is not a number");
  EXPECT_EQ(tum_error("1 0 0 0 0 0 0 1m\n"), "f.txt:1: qw: '1m' is not a number");
  EXPECT_EQ(tum_error("1 0 0 + 0 0 0 1\n"), "f.txt:1: tz: '+' is not a number");
  EXPECT_EQ(tum_error("1 0 0 0 0 0 0 0\n"), "f.txt:1: quaternion: norm 0, expected 1");
  EXPECT_EQ(tum_error("1 0 0 0 0 0 0 2\n"), "f.txt:1: quaternion: norm 2, expected 1");
  EXPECT_EQ(tum_error(good + good), "f.txt:2: stamp: 1 does not come after 1.000000000");
  EXPECT_EQ(tum_error("-1 0 0 0 0 0 0 1\n"),
            "f.txt:1: stamp: '-1' is no time in seconds from 0 to 9.2e9");
  EXPECT_EQ(tum_error("# nothing\n"), "f.txt: contains no poses");
  EXPECT_EQ(tum_error(""), "f.txt: contains no poses");
  EXPECT_EQ(refusal_of([] { read_tum("/nowhere/f.txt"); }),
            "/nowhere/f.txt: cannot be read: no such file");
}

// The head and the first line of numbers of EuRoC's V1_01_easy, and what others make of the format.
TEST(Euroc, ReadsNanosecondsAndQuaternionsThatBeginWithW) {
  const Trajectory read = parse_trajectory(
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1]\r\n"
      "1403715274302142976,0.878612,2.142470,0.947262,0.060514,-0.828459,-0.058956,-0.553641,0."
      "1\r\n"
      "1403715274307142976, 1, 2, 3, 1, 0, 0, 0,\n",
      "f.csv");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].stamp_ns, 1'403'715'274'302'142'976);
  EXPECT_EQ(read[0].world_from_camera.translation(), Eigen::Vector3d(0.878612, 2.142470, 0.947262));
  const Eigen::Quaterniond rotation(0.060514, -0.828459, -0.058956, -0.553641);
  EXPECT_LT(
      (read[0].world_from_camera.rotation() - rotation.normalized().toRotationMatrix()).norm(),
      1e-12);
  EXPECT_EQ(read[1].world_from_camera.rotation(), Eigen::Matrix3d::Identity());
  const std::string line = "5,1,2,3,1,0,0,0\n";
  EXPECT_EQ(parse_trajectory("timestamp,x,y,z,qw,qx,qy,qz\n" + line, "f.csv").size(), 1U);
  EXPECT_EQ(parse_trajectory("# one, two\n\n5 1 2 3 1 0 0 0\n", "f.txt")[0].stamp_ns, 5'000'000'000)
      << "a comment's commas do not count";
}

TEST(Euroc, EveryErrorNamesFileLineAndValue) {
  const auto error = [](const std::string& text) {
    return refusal_of([&] { parse_trajectory(text, "f.csv"); });
  };
  const std::string good = "5,1,2,3,1,0,0,0\n";
  EXPECT_EQ(error(good + "6,1,2\n"),
            "f.csv:2: pose: 3 values, expected at least 8 (timestamp p_x p_y p_z q_w q_x q_y q_z)");
  EXPECT_EQ(error(good + "6,1,,3,1,0,0,0\n"), "f.csv:2: p y: '' is not a number");
  EXPECT_EQ(error(good + "6,1,2 3,1,0,0,0,0\n"), "f.csv:2: p y: '2 3' is not a number");
  EXPECT_EQ(error(good + "6,1,nan,3,1,0,0,0\n"), "f.csv:2: p y: 'nan' is not finite");
  EXPECT_EQ(error(good + "6,1,2,3,0,0,0,0\n"), "f.csv:2: quaternion: norm 0, expected 1");
  EXPECT_EQ(error(good + good), "f.csv:2: stamp: 5 does not come after 0.000000005");
  EXPECT_EQ(error("1403715274.3,1,2,3,1,0,0,0\n"),
            "f.csv:1: timestamp: '1403715274.3' is not a whole number of nanoseconds");
  EXPECT_EQ(error(good + "end,1,2,3,1,0,0,0\n"),
            "f.csv:2: timestamp: 'end' is not a whole number of nanoseconds");
  EXPECT_EQ(error("-5,1,2,3,1,0,0,0\n"),
            "f.csv:1: timestamp: '-5' is not a whole number of nanoseconds");
  EXPECT_EQ(error("timestamp,x\n"), "f.csv: contains no poses");
  EXPECT_EQ(error(",\n"), "f.csv: contains no poses");
  EXPECT_EQ(error(",1,2,3,1,0,0,0\n"),
            "f.csv:1: timestamp: '' is not a whole number of nanoseconds");
}

/// The quaternion (w, x, y, z) of the first pose.
Eigen::Vector4d first_rotation(const Trajectory& trajectory) {
  const Eigen::Quaterniond q = trajectory.at(0).world_from_camera.quaternion();
  return {q.w(), q.x(), q.y(), q.z()};
}

TEST(Poses, AreInTheOrderThatTheirLineOfNamesStates) {
  const Eigen::Vector4d expected(0.8, 0, 0, 0.6);
  for (const char* text :
       {"#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y "
        "[],q_RS_z []\n1,1,2,3,0.8,0,0,0.6\n",
        "timestamp,tx,ty,tz,qx,qy,qz,qw\n1,1,2,3,0,0,0.6,0.8\n",
        "# made by a tool\n\n# t x y z Qx Qy Qz Qw, in ns\n1,1,2,3,0.8,0,0,0.6\n",
        "# timestamp tx ty tz qw qx qy qz\n1 1 2 3 0.8 0 0 0.6\n",
        "# timestamp tx ty tz qx qy qz qw\n1 1 2 3 0 0 0.6 0.8\n",
        "# an estimate of some run; timestamp tx ty tz qx qy qz qw\n1 1 2 3 0 0 0.6 0.8\n",
        "# stamp and the pose of the camera in the world\n1 1 2 3 0 0 0.6 0.8\n"})
    EXPECT_LT((first_rotation(parse_trajectory(text, "f.csv")) - expected).norm(), 1e-12) << text;
  EXPECT_EQ(refusal_of(
                [] { parse_trajectory("time,qx,qy,qz,qw,x,y,z\n1,0,0,0.6,0.8,1,2,3\n", "f.csv"); }),
            "f.csv:1: its columns are named qx qy qz qw x y z: `x y z qx qy qz qw` and `x y z qw "
            "qx qy qz` are read");
  for (const char* names : {"time,x,y,z,qi,qj,qk,qr", "id,time,tx,ty,tz,qx,qy,qz,qw"})
    EXPECT_NE(refusal_of([&] {
                parse_trajectory(fmt::format("{}\n1,1,2,3,0.8,0,0,0.6,1\n", names), "f.csv");
              }).find("f.csv:1: its columns are named "),
              std::string::npos)
        << names;
}

TEST(Poses, OfDirtyFilesAreReadByTheirLineOfNamesAndFaultsAreTold) {
  std::vector<std::string> faults;
  const Trajectory valid =
      parse_valid_tum("# time tx ty tz qw qx qy qz\nnan\n1 1 2 3 0.8 0 0 0.6\n1 1 2 3 1 0 0 0\n",
                      "f.txt", [&](const InputError& error) { faults.emplace_back(error.what()); });
  ASSERT_EQ(valid.size(), 1U);
  EXPECT_LT((first_rotation(valid) - Eigen::Vector4d(0.8, 0, 0, 0.6)).norm(), 1e-12);
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0], "f.txt:2: pose: 1 value, expected 8 (stamp tx ty tz qx qy qz qw)");
  EXPECT_EQ(faults[1], "f.txt:4: stamp: 1 does not come after 1.000000000");
}

TEST(Kitti, RoundTripsAndCountsFrames) {
  const Trajectory written = some_trajectory();
  const auto file = std::filesystem::temp_directory_path() / "mh_metrics_round_trip.kitti";
  write_kitti(file, written);
  const Trajectory read = read_kitti(file, 50'000'000);
  std::filesystem::remove(file);
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp_ns, static_cast<Stamp>(i) * 50'000'000);
    EXPECT_EQ(read[i].world_from_camera.translation(), written[i].world_from_camera.translation());
    EXPECT_LT(
        (read[i].world_from_camera.rotation() - written[i].world_from_camera.rotation()).norm(),
        1e-14);
  }
}

TEST(Kitti, EveryErrorNamesFileLineAndValue) {
  const auto kitti_error = [](const std::string& text) {
    return refusal_of([&] { parse_kitti(text, "k.txt"); });
  };
  EXPECT_EQ(kitti_error("1 0 0 0 0 1 0 0 0 0 1 0\n1 2\n"),
            "k.txt:2: pose: 2 values, expected 12 (3x4 matrix by rows)");
  EXPECT_EQ(kitti_error("1 0 0 0 0 1 0 0 0 0 -1 0\n"),
            "k.txt:1: matrix: its left 3x3 part is not a rotation");
  EXPECT_EQ(kitti_error("2 0 0 0 0 1 0 0 0 0 1 0\n"),
            "k.txt:1: matrix: its left 3x3 part is not a rotation");
  EXPECT_EQ(kitti_error("1 0 0 0 0 1 0 0 0 0 1 nan\n"), "k.txt:1: matrix: 'nan' is not finite");
  EXPECT_EQ(kitti_error(""), "k.txt: contains no poses");
}

}  // namespace
}  // namespace mh
