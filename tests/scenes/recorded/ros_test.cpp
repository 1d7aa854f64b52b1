// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/inputs/recorded_camera.hpp"
#include "scenes/image_file.hpp"
#include "scenes/messages/message_log.hpp"
#include "scenes/messages/robot_types.hpp"
#include "scenes/recorded/frame_sequence.hpp"
#include "scenes/recorded/ros/names.hpp"
#include "scenes/recorded/ros/recorder.hpp"
#include "scenes/recorded/ros/sequence.hpp"
#include "scenes/recorded/ros/topic_names.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"
#include "slam/core/random.hpp"
#include "slam/core/read_record.hpp"
#include "tests/scenes/temporary_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

Camera small_camera() {
  Camera camera;
  camera.width_px = 8;
  camera.height_px = 6;
  camera.fx_px = 7.123456789;
  camera.cx_px = 3.5;
  camera.cy_px = 2.5;
  camera.distortion = {0.1, -0.2, 0.001, 0.002, 0.3};
  return camera;
}

Stamp stamp_ns(std::size_t i) {
  return std::llround(static_cast<double>(i) * 1e9 / 30);
}

ExactFrame frame(std::size_t i) {
  const RandomStream random(i);
  ExactFrame f;
  f.seen.stamp_ns = stamp_ns(i);
  f.seen.color = Grid2d<Rgb8>(8, 6);
  f.seen.depth_m = Grid2d<float>(8, 6);
  f.classes = Grid2d<ClassId>(8, 6);
  f.instances = Grid2d<InstanceId>(8, 6);
  for (int k = 0; k < 48; ++k) {
    const auto byte = static_cast<std::uint8_t>(37 * k + 11 * static_cast<int>(i));
    f.seen.color.data()[k] = {byte, static_cast<std::uint8_t>(byte + 1),
                              static_cast<std::uint8_t>(2 * byte)};
    f.seen.depth_m.data()[k] = k == 3 ? 0 : 0.31F * static_cast<float>(k + 1);  // some beyond 13 m
    f.classes.data()[k] = static_cast<ClassId>(k % 7);
    f.instances.data()[k] = static_cast<InstanceId>(300 * (k % 3));
  }
  f.world_from_camera =
      SE3(Eigen::Quaterniond(0.9, 0.1 * static_cast<double>(i), 0.3, -0.2), {1.1, 2.2, 3.3});
  return f;
}

constexpr std::size_t kFrames = 4;

RecordingConfig with_topics(const char* topics) {
  RecordingConfig config;
  config.topics = topics;
  return config;
}
RecordingConfig without_labels() {
  RecordingConfig config;
  config.labels = false;
  return config;
}
RecordingConfig with_camera_reader() {
  RecordingConfig config;
  config.read_camera = camera_reader();
  return config;
}

class RosRecording : public TemporaryFolder, public testing::WithParamInterface<const char*> {
 protected:
  bool is_bag() const { return std::string(GetParam()) == "bag"; }
  fs::path file() const { return folder_ / (std::string("r.") + GetParam()); }
  std::unique_ptr<MessageWriter> writer() const {
    return is_bag() ? write_bag(file()) : write_mcap(file());
  }
  ros::Wire wire() const { return is_bag() ? ros::Wire::kRos1 : ros::Wire::kCdr; }
  OpenedRecording open(const RecordingConfig& config = {}) const {
    return open_sequence(std::string(GetParam()) + ":" + file().string(), config);
  }
  void record() const {
    RosRecorder recorder(writer(), small_camera(), {});
    for (const std::size_t i : {1U, 0U, 3U, 2U}) recorder.add(i, frame(i));
    recorder.finish();
  }
};

/// What a robot of somebody else's may send: its topics are written by hand.
class Foreign {
 public:
  explicit Foreign(ros::Wire wire) : log_(wire) {}

  ros::Header header(std::size_t i) const { return {0, {stamp_ns(i)}, "/cam_optical"}; }
  template <class M>
  void add(const std::string& topic, std::size_t i, const M& message) {
    auto& topics = topics_;
    auto found = std::ranges::find(topics, topic, &std::pair<std::string, std::size_t>::first);
    if (found == topics.end())
      found = topics.insert(topics.end(), {topic, log_.add_topic<M>(topic)});
    log_.add(found->second, stamp_ns(i), message);
  }
  void color(const std::string& topic, const char* encoding = "bgr8") {
    const std::string bytes =
        std::string(encoding) == "bgr8" ? std::string("\3\2\1\6\5\4", 6) : std::string("\1\2", 2);
    for (std::size_t i = 0; i < kFrames; ++i)
      add(topic, i,
          ros::Image{header(i), 1, 2, encoding, 0, static_cast<std::uint32_t>(bytes.size()),
                     bytes});
  }
  void depth(const std::string& topic, bool big = false) {
    const std::string bytes = big ? std::string("\x03\xe8\0\0", 4) : std::string("\xe8\x03\0\0", 4);
    for (std::size_t i = 0; i < kFrames; ++i)
      add(topic, i,
          ros::Image{header(i), 1, 2, "16UC1", big ? std::uint8_t{1} : std::uint8_t{0}, 4, bytes});
  }
  void info(const std::string& topic) {
    ros::CameraInfo info;
    info.header = header(0);
    info.width = 2;
    info.height = 1;
    info.k = {2, 0, 0.5, 0, 2, 0, 0, 0, 1};
    info.distortion_model = "plumb_bob";
    add(topic, 0, info);
  }
  /// All that a camera needs: /image, /depth and /camera_info.
  void camera() {
    color("/image");
    depth("/depth");
    info("/camera_info");
  }
  void tf(std::size_t i, const char* parent, const char* child, const SE3& pose,
          const char* topic = "/tf") {
    add(topic, i, ros::TfMessage{{ros::transform_message(stamp_ns(i), parent, child, pose)}});
  }
  void write(std::unique_ptr<MessageWriter> file) {
    log_.sort();
    write_log(*file, log_);
  }

 private:
  MessageLog log_;
  std::vector<std::pair<std::string, std::size_t>> topics_;
};

SE3 shift(double x, double y, double z) {
  return {Eigen::Matrix3d::Identity(), {x, y, z}};
}

TEST_P(RosRecording, ReadsBackTheBitsThatTumGivesBack) {
  record();
  TumWriter tum(folder_ / "tum", small_camera());
  for (std::size_t i = 0; i < kFrames; ++i) tum.add(i, frame(i));
  tum.finish();
  const auto by_tum = open_sequence("tum:" + (folder_ / "tum").string(), with_camera_reader());
  const OpenedRecording opened = open();
  const Sequence &ours = *opened.sequence, &theirs = *by_tum.sequence;
  EXPECT_TRUE(opened.notes.empty());
  EXPECT_TRUE(opened.has_labels);
  EXPECT_EQ(ours.camera(), theirs.camera());
  ASSERT_EQ(ours.size(), kFrames);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const RgbdFrame a = ours.frame(i, RandomStream(0)), b = theirs.frame(i, RandomStream(0));
    EXPECT_EQ(a.stamp_ns, b.stamp_ns);
    EXPECT_EQ(ours.stamp_ns(i), a.stamp_ns);
    EXPECT_EQ(a.color, b.color);
    EXPECT_EQ(a.depth_m, b.depth_m);
    EXPECT_EQ(a.semantics, b.semantics);
    const TimedPose &p = ours.truth()->at(i), &q = theirs.truth()->at(i);
    EXPECT_EQ(p.stamp_ns, q.stamp_ns);
    EXPECT_EQ(p.world_from_camera.rotation(), q.world_from_camera.rotation());
    EXPECT_EQ(p.world_from_camera.translation(), q.world_from_camera.translation());
  }
}

TEST_P(RosRecording, TheOrderOfThreadsChangesNoByte) {
  record();
  const std::string once = read_file(file());
  RosRecorder recorder(writer(), small_camera(), {});
  for (std::size_t i = 0; i < kFrames; ++i) recorder.add(i, frame(i));
  recorder.finish();
  EXPECT_EQ(read_file(file()), once);
}

TEST_P(RosRecording, IsRecognizedByItsNameOrInItsFolder) {
  record();
  EXPECT_EQ(open_sequence(file().string(), {}).sequence->size(), kFrames);
  EXPECT_EQ(open_sequence(folder_.string(), {}).sequence->size(), kFrames);
}

TEST_P(RosRecording, KeysCoverTheFile) {
  record();
  const auto digest_now = [&] {
    const ReadScope scope;
    open();
    return digest(scope.record());
  };
  const std::uint64_t before = digest_now();
  EXPECT_EQ(digest_now(), before);
  std::ofstream(file(), std::ios::app | std::ios::binary).put('x');
  EXPECT_NE(digest_now(), before);
}

TEST_P(RosRecording, WithoutLabelsWhereNoneAreWanted) {
  record();
  const OpenedRecording opened = open(without_labels());
  EXPECT_TRUE(opened.has_labels);
  EXPECT_TRUE(opened.sequence->frame(0, RandomStream(0)).semantics.index.empty());
}

// A run that looks at no labels would otherwise have another key than its plan.
TEST_P(RosRecording, AClassMapIsReadEvenWhereLabelsAreLeftOut) {
  record();
  std::ofstream(folder_ / "classes.yaml") << "1: chair\n2: table\n";
  const auto digest_of = [&](bool labels) {
    RecordingConfig config;
    config.labels = labels;
    config.classes = folder_ / "classes.yaml";
    const ReadScope scope;
    open(config);
    return digest(scope.record());
  };
  EXPECT_EQ(digest_of(true), digest_of(false));
}

TEST_P(RosRecording, AClassMapOfAnotherTableOrWithoutUseIsTold) {
  record();
  RecordingConfig config;
  config.classes = folder_ / "classes.yaml";
  std::ofstream(config.classes) << "200: chair\n";
  const std::vector<std::string> notes = open(config).notes;
  EXPECT_TRUE(std::ranges::any_of(notes, [](const std::string& note) {
    return note.find("none of its ids has a class in") != std::string::npos;
  }));
  std::ofstream(config.classes) << "3: chair\n";
  EXPECT_TRUE(open(config).notes.empty()) << open(config).notes.front();
  Foreign robot(wire());
  robot.camera();
  robot.write(writer());
  EXPECT_NE(open(config).notes.back().find("has no use: the recording has no labels"),
            std::string::npos);
}

TEST_P(RosRecording, SeveralInAFolderNeedAName) {
  record();
  fs::copy_file(file(), folder_ / (std::string("second.") + GetParam()));
  const std::string error = error_of([&] { open_sequence(folder_.string(), {}); });
  EXPECT_NE(error.find("holds 2 files *."), std::string::npos) << error;
}

TEST_P(RosRecording, ImagesOutOfOrderAreSortedByTheirStamps) {
  Foreign robot(wire());
  robot.info("/camera_info");
  robot.depth("/depth");
  // In the file, by time of receipt, the second image stands before the first.
  for (const std::size_t i : {1U, 0U, 2U})
    robot.add("/image",
              i == 1   ? 0
              : i == 0 ? 1
                       : 2,
              ros::Image{robot.header(i), 1, 2, "bgr8", 0, 6, "abcdef"});
  robot.write(writer());
  const OpenedRecording opened = open();
  ASSERT_EQ(opened.sequence->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(opened.sequence->stamp_ns(i), stamp_ns(i));
  ASSERT_EQ(opened.notes.size(), 1U);
  EXPECT_NE(opened.notes[0].find("not in the order of their stamps"), std::string::npos);
}

TEST_P(RosRecording, DepthOf8BitsIsNotRead) {
  Foreign robot(wire());
  robot.color("/image");
  robot.info("/camera_info");
  const std::string png = encode_png(Grid2d<std::uint8_t>(2, 1, std::uint8_t{9}));
  for (std::size_t i = 0; i < kFrames; ++i)
    robot.add("/depth/compressedDepth", i,
              ros::CompressedImage{robot.header(i), "16UC1; compressedDepth png",
                                   std::string(12, '\0') + png});
  robot.write(writer());
  const OpenedRecording opened = open();
  EXPECT_NE(error_of([&] {
              opened.sequence->frame(0, RandomStream(0));
            }).find("has 8 bits, depth needs 16"),
            std::string::npos);
}

TEST_P(RosRecording, AnotherCalibrationMidwayIsTold) {
  Foreign robot(wire());
  robot.camera();
  robot.info("/camera_info");
  ros::CameraInfo other;
  other.header = robot.header(2);
  other.height = 1, other.width = 2;
  other.k = {3, 0, 0.5, 0, 3, 0, 0, 0, 1};
  robot.add("/camera_info", 2, other);
  robot.write(writer());
  const OpenedRecording opened = open();
  EXPECT_EQ(opened.sequence->camera().fx_px, 2);
  ASSERT_EQ(opened.notes.size(), 1U);
  EXPECT_NE(opened.notes[0].find("the calibration of /camera_info is another from 66666667 ns on"),
            std::string::npos)
      << opened.notes[0];
}

TEST_P(RosRecording, ImagesWithoutPixelsAreCounted) {
  Foreign robot(wire());
  robot.add("/image", 0, ros::Image{robot.header(0), 0, 0, "bgr8", 0, 0, ""});
  robot.camera();
  robot.write(writer());
  const OpenedRecording opened = open();
  EXPECT_EQ(opened.sequence->size(), kFrames);
  ASSERT_EQ(opened.notes.size(), 1U);
  EXPECT_NE(opened.notes[0].find("1 message cannot be read, the first: topic /image: a "
                                 "sensor_msgs/Image has no pixels"),
            std::string::npos)
      << opened.notes[0];
}

TEST_P(RosRecording, TopicsAreFoundByType) {
  for (const bool big : {false, true}) {
    Foreign robot(wire());
    robot.color("/head/image");
    robot.depth("/head/depth", big);
    robot.info("/head/camera_info");
    robot.add("/chatter", 0, ros::String{"hello"});
    robot.write(writer());
    const OpenedRecording opened = open();
    ASSERT_EQ(opened.sequence->size(), kFrames);
    EXPECT_EQ(opened.sequence->truth(), nullptr);
    EXPECT_EQ(opened.sequence->camera().fx_px, 2);
    EXPECT_EQ(opened.sequence->camera().rate_hz, 30);
    const RgbdFrame f = opened.sequence->frame(2, RandomStream(0));
    EXPECT_EQ(f.color(0, 0), (Rgb8{1, 2, 3}));
    EXPECT_EQ(f.color(1, 0), (Rgb8{4, 5, 6}));
    EXPECT_EQ(f.depth_m(0, 0), 1.0F) << "big-endian: " << big;
    EXPECT_EQ(f.depth_m(1, 0), 0.0F);
  }
}

TEST_P(RosRecording, TwoCamerasNeedNames) {
  Foreign robot(wire());
  robot.color("/left/image");
  robot.color("/right/image");
  robot.depth("/left/depth");
  robot.info("/left/camera_info");
  robot.write(writer());
  const std::string error = error_of([&] { open(); });
  EXPECT_NE(error.find("several topics hold color images: /left/image (bgr8), /right/image (bgr8); "
                       "name one: --topics color=/left/image"),
            std::string::npos)
      << error;
  EXPECT_EQ(open(with_topics("color=/right/image,info=/left/camera_info")).sequence->size(),
            kFrames);
  EXPECT_NE(error_of([&] { open(with_topics("color=/rigth/image")); }).find("'/right/image'"),
            std::string::npos);
}

TEST_P(RosRecording, WhatIsMissingIsNamedWithWhatIsThere) {
  Foreign robot(wire());
  robot.color("/image");
  robot.write(writer());
  const std::string error = error_of([&] { open(); });
  EXPECT_NE(error.find("no topic holds depth images that are read (32FC1, 16UC1, mono16, "
                       "compressedDepth); its images: /image (bgr8)"),
            std::string::npos)
      << error;
  Foreign mosaic(wire());
  mosaic.color("/image", "bayer_rggb8");
  mosaic.depth("/depth");
  mosaic.write(writer());
  EXPECT_NE(error_of([&] { open(); }).find("/image (bayer_rggb8)"), std::string::npos);
  Foreign uncalibrated(wire());
  uncalibrated.color("/image");
  uncalibrated.depth("/depth");
  uncalibrated.write(writer());
  EXPECT_NE(error_of([&] { open(); }).find("holds no sensor_msgs/CameraInfo for /image"),
            std::string::npos);
}

TEST_P(RosRecording, InstancesAreNoDepthWhateverTheirCamera) {
  Foreign robot(wire());
  robot.color("/cam2/color/image_raw");
  robot.depth("/cam2/instances/image");
  robot.info("/cam2/color/camera_info");
  robot.write(writer());
  EXPECT_NE(error_of([&] { open(); }).find("no topic holds depth images"), std::string::npos);
}

TEST_P(RosRecording, DepthIsOfTheColorsCamera) {
  Foreign robot(wire());
  for (const std::string camera : {"/left", "/right"}) {
    robot.color(camera + "/image");
    robot.depth(camera + "/depth");
    robot.info(camera + "/camera_info");
  }
  robot.write(writer());
  EXPECT_EQ(open(with_topics("color=/right/image")).sequence->size(), kFrames);
}

TEST_P(RosRecording, FramesWithoutLabelsAreCounted) {
  Foreign robot(wire());
  robot.camera();
  robot.add("/ids", 0, ros::Image{robot.header(0), 1, 2, "mono8", 0, 2, std::string("\1\2", 2)});
  robot.write(writer());
  RecordingConfig config = with_topics("labels=/ids");
  config.labels = true;
  const std::vector<std::string> notes = open(config).notes;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find(std::to_string(kFrames - 1) + " of " + std::to_string(kFrames) +
                          " frames have no label image"),
            std::string::npos)
      << notes[0];
}

TEST_P(RosRecording, GrayImagesServeWhereNoColorIs) {
  Foreign robot(wire());
  robot.color("/gray", "mono8");
  robot.depth("/depth");
  robot.info("/camera_info");
  robot.write(writer());
  EXPECT_EQ(open().sequence->frame(0, RandomStream(0)).color(1, 0), (Rgb8{2, 2, 2}));
}

TEST_P(RosRecording, ACompressedImageGivesWayToItsTwin) {
  Foreign robot(wire());
  robot.camera();
  const std::string png = encode_png(Grid2d<std::uint8_t>(2, 1, std::uint8_t{9}));
  for (std::size_t i = 0; i < kFrames; ++i)
    robot.add("/image/compressed", i, ros::CompressedImage{robot.header(i), "png", png});
  robot.write(writer());
  EXPECT_EQ(open().sequence->frame(0, RandomStream(0)).color(0, 0), (Rgb8{1, 2, 3}));
  EXPECT_EQ(
      open(with_topics("color=/image/compressed")).sequence->frame(0, RandomStream(0)).color(0, 0),
      (Rgb8{9, 9, 9}));
}

TEST_P(RosRecording, TruthComesFromTfThroughWhatIsFixed) {
  Foreign robot(wire());
  robot.camera();
  robot.tf(0, "/body", "/cam_optical", shift(0, 0, 1), "/tf_static");
  for (std::size_t i = 0; i < kFrames; ++i)
    robot.tf(i, "world", "body", shift(static_cast<double>(i), 0, 0));
  robot.write(writer());
  const OpenedRecording opened = open();
  ASSERT_NE(opened.sequence->truth(), nullptr);
  ASSERT_EQ(opened.sequence->truth()->size(), kFrames);
  EXPECT_EQ(opened.sequence->truth()->at(2).world_from_camera.translation(),
            Eigen::Vector3d(2, 0, 1));
  ASSERT_EQ(opened.notes.size(), 1u);
  EXPECT_NE(opened.notes[0].find("truth is taken from tf, for 'cam_optical'"), std::string::npos);
}

TEST_P(RosRecording, OdometryIsNoTruth) {
  Foreign robot(wire());
  robot.camera();
  for (std::size_t i = 0; i < kFrames; ++i) {
    robot.tf(i, "odom", "cam_optical", shift(1, 0, 0));
    robot.add("/odom", i, ros::Odometry{{0, {stamp_ns(i)}, "odom"}, "cam_optical", {}, {}});
  }
  robot.write(writer());
  EXPECT_EQ(open().sequence->truth(), nullptr);
  EXPECT_NE(open(with_topics("truth=/odom")).sequence->truth(), nullptr) << "unless it is named";
}

TEST_P(RosRecording, DepthOfAnotherSizeIsRefused) {
  Foreign robot(wire());
  robot.color("/image");
  robot.info("/camera_info");
  for (std::size_t i = 0; i < kFrames; ++i)
    robot.add("/depth", i, ros::Image{robot.header(i), 1, 1, "16UC1", 0, 2, "\1\1"});
  robot.write(writer());
  EXPECT_NE(error_of([&] { open(); }).find("a topic with depth registered to color is needed"),
            std::string::npos);
}

TEST_P(RosRecording, AFrameThatCannotBeReadIsTheOnlyOne) {
  Foreign robot(wire());
  robot.camera();
  robot.add("/image", kFrames, ros::Image{robot.header(kFrames), 1, 2, "bgr8", 0, 6, "abc"});
  robot.add("/depth", kFrames, ros::Image{robot.header(kFrames), 1, 2, "16UC1", 0, 4, "abcd"});
  robot.write(writer());
  const OpenedRecording opened = open();
  ASSERT_EQ(opened.sequence->size(), kFrames + 1);
  opened.sequence->frame(0, RandomStream(0));
  const std::string error = error_of([&] { opened.sequence->frame(kFrames, RandomStream(0)); });
  EXPECT_NE(error.find("topic /image at 133333333 ns: holds 3 bytes, too few for 2 x 1 pixels"),
            std::string::npos)
      << error;
}

INSTANTIATE_TEST_SUITE_P(Both, RosRecording, testing::Values("bag", "mcap"));

TEST(TopicNames, AreKeysAndTopics) {
  EXPECT_EQ(parse_topic_names("color=/a,depth=/b").depth, "/b");
  for (const char* bad : {"color", "color=", "hue=/a", "color=/a,color=/b"})
    EXPECT_THROW(parse_topic_names(bad), InputError) << bad;
}

TEST(TopicNames, OnlyMessagesHaveThem) {
  EXPECT_NE(
      error_of([] { open_sequence("tum:/nowhere", with_topics("color=/a")); }).find("has none"),
      std::string::npos);
}

}  // namespace
}  // namespace mh
