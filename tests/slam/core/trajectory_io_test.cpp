// SPDX-License-Identifier: Apache-2.0
#include "slam/core/trajectory_io.hpp"

#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

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
  return refusal_of([&] { parse_trajectory(text, "f.txt"); });
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
  // As a double, it would end in ...535.
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
  const Trajectory t = parse_trajectory(
      "# header\n\n1.5 1 2 3 0 0 0.7 0.7\r\n\t2.5\t+4 5e0 -6 0 0 0 1 # tail\n   \n3 0 0 0 1 0 0 0",
      "f.txt");
  ASSERT_EQ(t.size(), 3U);
  EXPECT_EQ(t[0].stamp_ns, 1'500'000'000);
  EXPECT_EQ(t[1].world_from_camera.translation(), Eigen::Vector3d(4, 5, -6));
  // A quarter turn about z, w last: x turns into y. The quaternion's norm of 0.99 is normalized.
  EXPECT_LT(
      (t[0].world_from_camera.rotation() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY())
          .norm(),
      1e-12);
}

TEST(Tum, RoundTripsThroughAFile) {
  const Trajectory written = some_trajectory();
  const auto file = std::filesystem::temp_directory_path() / "mh_metrics_round_trip.txt";
  write_tum(file, written);
  const Trajectory read = read_trajectory(file);
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
            "f.txt:1: stamp: '-1' is not a time in seconds from 0 to 9.2e9");
  EXPECT_EQ(tum_error("# nothing\n"), "f.txt: contains no poses");
  EXPECT_EQ(tum_error(""), "f.txt: contains no poses");
  EXPECT_EQ(refusal_of([] { read_trajectory("/nowhere/f.txt"); }),
            "/nowhere/f.txt: cannot be read: no such file");
}

// The header and the first data line of EuRoC's V1_01_easy, and variants of the format.
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
  EXPECT_EQ(error(good + "6,1,,3,1,0,0,0\n"), "f.csv:2: ty: '' is not a number");
  EXPECT_EQ(error(good + "6,1,2 3,1,0,0,0,0\n"), "f.csv:2: ty: '2 3' is not a number");
  EXPECT_EQ(error(good + "6,1,nan,3,1,0,0,0\n"), "f.csv:2: ty: 'nan' is not finite");
  EXPECT_EQ(error(good + "6,1,2,3,0,0,0,0\n"), "f.csv:2: quaternion: norm 0, expected 1");
  EXPECT_EQ(error(good + good), "f.csv:2: stamp: 5 does not come after 0.000000005");
  EXPECT_EQ(error(good + "end,1,2,3,1,0,0,0\n"),
            "f.csv:2: stamp: 'end' is not a time in nanoseconds from 0 to 9.2e18");
  EXPECT_EQ(error("-5,1,2,3,1,0,0,0\n"),
            "f.csv:1: stamp: '-5' is not a time in nanoseconds from 0 to 9.2e18");
  EXPECT_EQ(error("timestamp,x\n"), "f.csv: contains no poses");
  EXPECT_EQ(error(",\n"), "f.csv: contains no poses");
  EXPECT_EQ(error(",1,2,3,1,0,0,0\n"),
            "f.csv:1: stamp: '' is not a time in nanoseconds from 0 to 9.2e18");
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
  for (const char* names : {"time,x,y,z,qi,qj,qk,qr", "time,x,y,z,roll,pitch,yaw,speed"})
    EXPECT_EQ(refusal_of([&] {
                parse_trajectory(fmt::format("{}\n1,1,2,3,0.8,0,0,0.6\n", names), "f.csv");
              }).find("f.csv:1: its columns are named "),
              0U)
        << names;
}

TEST(Poses, AreFoundByNameAmongOtherColumns) {
  const Eigen::Vector4d expected(0.8, 0, 0, 0.6);
  for (const char* text :
       {"#timestamp x y z qx qy qz qw id\n5 1 2 3 0 0 0.6 0.8 7\n",  // rtabmap-export's format 11
        "timestamp tx ty tz qx qy qz qw\n5 1 2 3 0 0 0.6 0.8\n",     // without '#'
        // OpenVINS: with words before the names; with a covariance from some line on
        "# format: timestamp tx ty tz qx qy qz qw Pt Pr\n5 1 2 3 0 0 0.6 0.8 9 9\n",
        "# timestamp(s) tx ty tz qx qy qz qw Pr Pt\n5 1 2 3 0 0 0.6 0.8\n6 1 2 3 0 0 0 1 9 9\n",
        "num,t,x,y,z,qx,qy,qz,qw\n1,5.0,1,2,3,0,0,0.6,0.8\n",
        "id,time [s],tx,ty,tz,qx,qy,qz,qw\n9,5,1,2,3,0,0,0.6,0.8\n",
        "time_s,qx,qy,qz,qw,x,y,z\n5,0,0,0.6,0.8,1,2,3\n",
        "\"time\";\"px\";\"py\";\"pz\";\"qw\";\"qx\";\"qy\";\"qz\"\n5.0;1;2;3;0.8;0;0;0.6\n",
        // rostopic echo -p
        "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.position.x,"
        "field.pose.position.y,field.pose.position.z,field.pose.orientation.x,"
        "field.pose.orientation.y,field.pose.orientation.z,field.pose.orientation.w\n"
        "1305031100123456789,1,5000000000,map,1,2,3,0,0,0.6,0.8\n",
        // bagpy
        "Time,header.stamp.secs,header.stamp.nsecs,pose.position.x,pose.position.y,pose.position.z,"
        "pose.orientation.x,pose.orientation.y,pose.orientation.z,pose.orientation.w\n"
        "7.5,4,1000000000,1,2,3,0,0,0.6,0.8\n",
        // pandas, whose index has no name
        ",timestamp,tx,ty,tz,qx,qy,qz,qw\n0,5.0,1,2,3,0,0,0.6,0.8\n"}) {
    const Trajectory read = parse_trajectory(text, "f");
    EXPECT_EQ(read.at(0).stamp_ns, 5'000'000'000) << text;
    EXPECT_EQ(read[0].world_from_camera.translation(), Eigen::Vector3d(1, 2, 3)) << text;
    EXPECT_LT((first_rotation(read) - expected).norm(), 1e-12) << text;
  }
  EXPECT_EQ(
      refusal_of([] { parse_trajectory("a,b,x,y,z,qx,qy,qz,qw\n1,2,1,2,3,0,0,0,1\n", "f.csv"); }),
      "f.csv:1: its columns have names, but none of them is a time");
  EXPECT_EQ(refusal_of([] {
              parse_trajectory("t,x [mm],y [mm],z [mm],qx,qy,qz,qw\n1,1,2,3,0,0,0,1\n", "f.csv");
            }),
            "f.csv:1: its positions are in 'mm', not in m");
}

// PlotJuggler's names begin with _ and /, and are sorted: if they were ignored, the quaternion
// would be read as the position.
TEST(Poses, AreFoundByNamesThatBeginWithASign) {
  const TimedPose pose = parse_trajectory(
      "__time,/odom/orientation/w,/odom/orientation/x,/odom/orientation/y,/odom/orientation/z,"
      "/odom/position/x,/odom/position/y,/odom/position/z\n1.5,0.8,0.6,0,0,1,2,3\n",
      "f.csv")[0];
  EXPECT_EQ(pose.stamp_ns, 1'500'000'000);
  EXPECT_EQ(pose.world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(pose.world_from_camera.quaternion().x(), 0.6, 1e-15);
}

TEST(Poses, HaveStampsInTheUnitThatIsNamedOrThatTheirSizeTells) {
  const auto stamp_of = [](const std::string& text, std::vector<std::string>& notes) {
    return parse_trajectory(text, "f", &notes).back().stamp_ns;
  };
  constexpr Stamp kStamp = 1'403'715'274'302'142'976;
  std::vector<std::string> none;
  for (const char* text : {"1403715274.302142976 0 0 0 0 0 0 1\n",
                           "#timestamp [ns] x y z qx qy qz qw\n1403715274302142976 0 0 0 0 0 0 1\n",
                           "1403715274302142976,0,0,0,1,0,0,0\n",
                           "timestamp,tx,ty,tz,qx,qy,qz,qw\n1403715274.302142976,0,0,0,0,0,0,1\n",
                           "stamp_us,x,y,z,qw,qx,qy,qz\n1403715274302142.976,0,0,0,1,0,0,0\n"}) {
    EXPECT_EQ(stamp_of(text, none), kStamp) << text;
    EXPECT_TRUE(none.empty()) << text << none[0];
  }
  std::vector<std::string> notes;
  EXPECT_EQ(stamp_of("1403715274302142976.000000 0 0 0 0 0 0 1\n", notes), kStamp) << "ORB-SLAM3";
  EXPECT_EQ(stamp_of("1.403715274302142976e+18 0 0 0 0 0 0 1\n", notes), kStamp) << "numpy";
  EXPECT_EQ(stamp_of("1403715274302142.976 0 0 0 0 0 0 1\n", notes), kStamp);
  EXPECT_EQ(stamp_of("1403715274302 0 0 0 0 0 0 1\n", notes), 1'403'715'274'302'000'000);
  EXPECT_EQ(stamp_of("0 0 0 0 0 0 0 1\n33333333 0 0 0 0 0 0 1\n", notes), 33'333'333);
  EXPECT_EQ(stamp_of("5,0,0,0,1,0,0,0\n6,0,0,0,1,0,0,0\n", notes), 6'000'000'000);
  EXPECT_EQ(
      notes,
      (std::vector<std::string>{
          "f: its stamps are taken as nanoseconds", "f: its stamps are taken as nanoseconds",
          "f: its stamps are taken as microseconds", "f: its stamps are taken as milliseconds",
          "f: its stamps are taken as nanoseconds", "f: its stamps are taken as seconds"}));
  EXPECT_EQ(stamp_of("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", none), 2'000'000'000);
  EXPECT_TRUE(none.empty());
}

TEST(Poses, ThatAreLostOrRepeatedAreLeftOutAndCountedInOneNote) {
  std::vector<std::string> notes;
  const Trajectory read = parse_trajectory(
      "1 1 0 0 0 0 0 1\n2 nan nan nan nan nan nan nan\n3 0 0 0 0 0 0 0\n4 4 0 0 0 0 0 1\n"
      "4 5 0 0 0 0 0 1\n6 -nan 0 0 0 0 0 1\n7 7 0 0 0 0 0 1\n8 8 0 0",
      "f.txt", &notes);
  ASSERT_EQ(read.size(), 3U);
  EXPECT_EQ(read[1].world_from_camera.translation().x(), 4) << "the first of a stamp stays";
  EXPECT_EQ(
      notes,
      std::vector<std::string>{
          "f.txt: 5 of 8 poses are left out: 2 are not finite, 1 has no rotation, 1 repeats a "
          "stamp, 1 is not a pose; the first in line 2: tx: 'nan' is not finite"});
  notes.clear();
  parse_trajectory("1,0,0,0,1,0,0,0\n2,,,,,,,,\n3,0,0,0,1,0,0,0\n", "f.csv", &notes);
  EXPECT_EQ(
      notes.back(),
      "f.csv: 1 of 3 poses is left out: 1 is not finite; the first in line 2: tx: '' is not a "
      "number");
}

TEST(Poses, ThatAreOutOfOrderAreSorted) {
  std::vector<std::string> notes;
  const std::string text = "3 3 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n3 4 0 0 0 0 0 1\n";
  const Trajectory read = parse_trajectory(text, "f", &notes);
  ASSERT_EQ(read.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(read[i].world_from_camera.translation().x(), static_cast<double>(i + 1));
  EXPECT_EQ(notes,
            (std::vector<std::string>{
                "f: 1 of 4 poses is left out: 1 repeats a stamp; the first in line 4: stamp: "
                "3 does not come after 3.000000000",
                "f: 2 poses come after a later one and are sorted by time"}));
  EXPECT_EQ(refusal_of([&] { parse_trajectory(text, "f"); }),
            "f:2: stamp: 1 does not come after 3.000000000")
      << "without notes, nothing is mended";
}

TEST(Poses, OfAnotherKindOfFileAreRefusedRatherThanLeftOut) {
  std::vector<std::string> notes;
  const std::string kitti = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  EXPECT_EQ(
      refusal_of([&] { parse_trajectory(kitti + kitti, "k", &notes); }),
      "k:1: pose: 12 values, expected 8 (stamp tx ty tz qx qy qz qw); matrices without stamps "
      "are KITTI's: `evaluate --format kitti`");
  EXPECT_EQ(refusal_of([&] {
              parse_trajectory("1 0 0 0 0 0 0 1\n2 0 0 0 1 1 0 0\n3 0 0 0 1 1 0 0\n", "f", &notes);
            }),
            "f:2: quaternion: norm 1.41421, expected 1");
  const std::string lost = "1 0 0 0 0 0 0 0\n2 nan nan nan 0 0 0 1\n";
  EXPECT_EQ(refusal_of([&] { parse_trajectory(lost, "f", &notes); }),
            "f: contains no poses; line 1: quaternion: norm 0, expected 1");
  EXPECT_TRUE(parse_valid_poses(lost, "f", notes).empty());
}

TEST(Poses, OfNoTextOrWithDecimalCommasAreRefused) {
  EXPECT_EQ(tum_error(std::string("#ROSBAG V2.0\n\x02\0\0", 16)),
            "f.txt: is not text, and a file of poses must be");
  // A decimal comma, with semicolons as separators.
  EXPECT_EQ(tum_error("1;0,5;0;0;1;0;0;0\n"), "f.txt:1: tx: '0,5' is not a number");
}

TEST(Poses, OfTheWholeEarthKeepTheirDigits) {
  const Trajectory read = parse_trajectory("1 458076.1001 5429380.2144 163.9 0 0 0 1\n", "utm");
  EXPECT_EQ(read[0].world_from_camera.translation(),
            Eigen::Vector3d(458076.1001, 5429380.2144, 163.9));
  EXPECT_EQ(tum_error("1 0 2e8 0 0 0 0 1\n"), "f.txt:1: position: lies 2e+08 m from the origin");
}

TEST(Kitti, RoundTripsAndCountsFrames) {
  const Trajectory written = some_trajectory();
  const Trajectory read = parse_kitti(format_kitti(written), "k.txt", 50'000'000);
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
            "k.txt:2: pose: 2 values, expected 12 (3x4 matrix, row by row)");
  EXPECT_EQ(kitti_error("1 0 0 0 0 1 0 0 0 0 -1 0\n"),
            "k.txt:1: matrix: its left 3x3 part is not a rotation");
  EXPECT_EQ(kitti_error("2 0 0 0 0 1 0 0 0 0 1 0\n"),
            "k.txt:1: matrix: its left 3x3 part is not a rotation");
  EXPECT_EQ(kitti_error("1 0 0 0 0 1 0 0 0 0 1 nan\n"), "k.txt:1: matrix: 'nan' is not finite");
  EXPECT_EQ(kitti_error(""), "k.txt: contains no poses");
}

}  // namespace
}  // namespace mh
