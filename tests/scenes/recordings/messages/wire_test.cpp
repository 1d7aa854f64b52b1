// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/messages/wire.hpp"

#include <gtest/gtest.h>

#include "scenes/recordings/messages/definition.hpp"
#include "scenes/recordings/messages/robot_types.hpp"
#include "scenes/recordings/messages/vision_types.hpp"

namespace mh::ros {
namespace {

/// A message with a value in every field.
TransformStamped transform() {
  return {{7, {12'345'678'901}, "map"}, "camera_link", {{1, 2, 3}, {0, 0, 1, 0}}};
}
Detection2DArray detections() {
  Detection2D detection;
  detection.header = {7, {1}, "camera"};
  detection.results.push_back({5, {"chair", 0.5}, {}});
  detection.bbox = {{10, 20, 0}, {{10, 20}, 0}, 4, 6};
  detection.id = "700";
  return {{7, {1}, "camera"}, {detection, detection}};
}

TEST(Wire, CdrIsAsTheStandardPrescribes) {
  // Seconds, nanoseconds, length of "map" with its terminating zero, the text; ROS 2 has no `seq`.
  const std::string expected("\0\1\0\0\x0c\0\0\0\x35\xa4\x9a\x14\4\0\0\0map\0", 20);
  EXPECT_EQ(serialized(transform().header, Wire::kCdr), expected);
}

TEST(Wire, Ros1IsPacked) {
  const std::string expected("\7\0\0\0\x0c\0\0\0\x35\xa4\x9a\x14\3\0\0\0map", 19);
  EXPECT_EQ(serialized(transform().header, Wire::kRos1), expected);
}

TEST(Wire, NumbersOfCdrStandAtMultiplesOfTheirSize) {
  // In a Range, a byte is followed by floats, with three bytes of padding in between.
  Range range;
  range.field_of_view = 1;
  const std::string bytes = serialized(range, Wire::kCdr);
  EXPECT_EQ(bytes.substr(4 + 8 + 4 + 1, 3), std::string(3, '\0'));
  EXPECT_EQ(bytes.substr(4 + 16, 4), std::string("\0\0\x80\x3f", 4));
}

/// Expects that a message reads back as it was written, and that no truncated bytes do.
template <class M>
void expect_round_trip(const M& message) {
  for (const Wire wire : {Wire::kRos1, Wire::kCdr}) {
    const std::string bytes = serialized(message, wire);
    EXPECT_EQ(serialized(parsed<M>(bytes, wire), wire), bytes) << M::kType;
    for (std::size_t size = 0; size < bytes.size(); ++size)
      EXPECT_THROW(parsed<M>(bytes.substr(0, size), wire), InputError) << M::kType << " " << size;
  }
}

TEST(Wire, MessagesReadBackAndCutOnesAreRefused) {
  expect_round_trip(transform());
  expect_round_trip(TfMessage{{transform(), transform()}});
  expect_round_trip(detections());
  expect_round_trip(Image{transform().header, 1, 2, "rgb8", 0, 6, "abcdef"});
  expect_round_trip(PoseStamped{transform().header, {{1, 2, 3}, {0, 0, 0, 1}}});
  expect_round_trip(OccupancyGrid{transform().header, {{5}, 0.04F, 2, 1, {}}, {0, -1}});
  LaserScan scan;
  scan.ranges = {1, 2, 3};
  expect_round_trip(scan);
  CameraInfo info;
  info.d = {1, 2, 3, 4, 5};
  info.roi.do_rectify = true;
  expect_round_trip(info);
  Odometry odometry;
  odometry.twist.twist.linear.x = 0.5;
  expect_round_trip(odometry);
  expect_round_trip(Imu());
  expect_round_trip(Bool{true});
  expect_round_trip(String{"text"});
}

TEST(Wire, BigEndianCdrIsRead) {
  const std::string bytes("\0\0\0\0\0\0\0\x0c\x14\x9a\xa4\x35\0\0\0\4map\0", 20);
  const auto header = parsed<Header>(bytes, Wire::kCdr);
  EXPECT_EQ(header.stamp.ns, 12'345'678'901);
  EXPECT_EQ(header.frame_id, "map");
}

TEST(Wire, OtherRepresentationsAreRefused) {
  EXPECT_THROW(parsed<Bool>(std::string("\0\7\0\0\1", 5), Wire::kCdr), InputError);
}

TEST(Wire, ALengthThatLiesAllocatesNothing) {
  EXPECT_THROW(parsed<TfMessage>("\xff\xff\xff\xff", Wire::kRos1), InputError);
  EXPECT_THROW(parsed<String>("\xff\xff\xff\xff", Wire::kRos1), InputError);
}

TEST(Definition, NamesAreThoseOfEachRos) {
  EXPECT_EQ(definition<CameraInfo>(Wire::kRos1).find("float64[9] K\n") != std::string::npos, true);
  EXPECT_EQ(definition<CameraInfo>(Wire::kCdr).find("float64[9] k\n") != std::string::npos, true);
  EXPECT_EQ(definition<Bool>(Wire::kRos1), "bool data\n");
  const std::string rule(80, '=');
  EXPECT_EQ(definition<Header>(Wire::kRos1), "uint32 seq\ntime stamp\nstring frame_id\n");
  EXPECT_EQ(definition<Header>(Wire::kCdr),
            "builtin_interfaces/Time stamp\nstring frame_id\n" + rule +
                "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
  EXPECT_EQ(type_name("sensor_msgs/Image", Wire::kCdr), "sensor_msgs/msg/Image");
}

}  // namespace
}  // namespace mh::ros
