// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "bench/suite/recorded_camera.hpp"
#include "scenes/image_file.hpp"
#include "scenes/recordings/frame_sequence.hpp"
#include "scenes/recordings/messages/message_log.hpp"
#include "scenes/recordings/messages/robot_types.hpp"
#include "scenes/recordings/ros/image.hpp"
#include "scenes/recordings/ros/names.hpp"
#include "scenes/recordings/ros/recorder.hpp"
#include "scenes/recordings/ros/sequence.hpp"
#include "scenes/recordings/ros/topic_names.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/read_record.hpp"
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
    f.seen.depth_m.data()[k] =
        k == 3 ? 0 : 0.31F * static_cast<float>(k + 1);  // some are beyond 13 m
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

/// What a robot other than ours may publish; each test chooses the topics.
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
  /// Everything that a camera needs: /image, /depth and /camera_info.
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

// If it were not read, the key of a run that uses no labels would differ from the key in its plan.
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
  EXPECT_NE(open(config).notes.back().find("is not used: the recording has no labels"),
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
  // The file is in order of receipt: the second image comes before the first.
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
  EXPECT_NE(opened.notes[0].find("not ordered by timestamp"), std::string::npos);
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

// As `rosbag record` writes RealSense's compressed topics: depth as an ordinary PNG.
TEST_P(RosRecording, DepthMayBeAnOrdinaryCompressedImage) {
  Foreign robot(wire());
  robot.info("/color/camera_info");
  const std::string color = encode_jpeg(Grid2d<Rgb8>(2, 1, Rgb8{80, 80, 80}), 95),
                    depth = encode_png(Grid2d<std::uint16_t>(2, 1, std::uint16_t{1500}));
  for (std::size_t i = 0; i < kFrames; ++i) {
    robot.add("/color/image_raw/compressed", i,
              ros::CompressedImage{robot.header(i), "rgb8; jpeg compressed bgr8", color});
    robot.add("/aligned_depth_to_color/image_raw/compressed", i,
              ros::CompressedImage{robot.header(i), "16UC1; png compressed ", depth});
  }
  robot.write(writer());
  EXPECT_EQ(open().sequence->frame(0, RandomStream(0)).depth_m(1, 0), 1.5F);
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
  EXPECT_NE(opened.notes[0].find("the calibration of /camera_info changes at 66666667 ns"),
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
  mosaic.color("/image", "bayer_rggb16");
  mosaic.depth("/depth");
  mosaic.write(writer());
  EXPECT_NE(error_of([&] { open(); }).find("/image (bayer_rggb16)"), std::string::npos);
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

TEST_P(RosRecording, EightCoefficientsGoBothWays) {
  Camera camera = small_camera();
  camera.distortion = {0.5, -0.1, 0.001, 0.002, 0.03, 0.4, -0.05, 0.01};
  RosRecorder recorder(writer(), camera, {});
  recorder.add(0, frame(0));
  recorder.finish();
  EXPECT_EQ(open().sequence->camera(), camera);
  TumWriter tum(folder_ / "tum", camera);
  tum.add(0, frame(0));
  tum.finish();
  EXPECT_EQ(load_recorded_camera(folder_ / "tum" / "camera.yaml").camera.distortion,
            camera.distortion);
  EXPECT_EQ(load_recorded_camera(folder_ / "tum" / "camera_info.yaml").camera.distortion,
            camera.distortion);
}

// Binned by 2 after 2 columns and 1 row were cut off: pixel u is at 2 u + 2.5 on the sensor.
TEST_P(RosRecording, ACalibrationOfTheWholeSensorServesItsPart) {
  Foreign robot(wire());
  robot.color("/image");
  robot.depth("/depth");
  ros::CameraInfo info;
  info.header = robot.header(0);
  info.width = 9, info.height = 7;
  info.k = {4, 0, 3.5, 0, 6, 1.5, 0, 0, 1};
  info.binning_x = info.binning_y = 2;
  info.roi = {2, 1, 2, 4, false};  // x, y, height, width
  robot.add("/camera_info", 0, info);
  robot.write(writer());
  const Camera camera = open().sequence->camera();
  EXPECT_EQ(camera.width_px, 2);
  EXPECT_EQ(camera.height_px, 1);
  EXPECT_EQ(camera.fx_px, 2);
  EXPECT_EQ(camera.fy_px, 3);
  EXPECT_EQ(camera.cx_px, 0.5);
  EXPECT_EQ(camera.cy_px, 0);
}

TEST_P(RosRecording, LensesThatAreNoneOfTheTwoAreRefusedByName) {
  for (const auto& [model, coefficients, said] :
       {std::tuple("equidistant", 4, "distortion model 'equidistant' is not supported"),
        {"Inverse Brown Conrady", 5, "distortion model 'Inverse Brown Conrady'"},
        {"plumb_bob", 8, "more than the 5 coefficients of plumb_bob"},
        {"rational_polynomial", 12, "more than the 8 coefficients of rational_polynomial"},
        {"Brown Conrady", 5, ""},
        {"equidistant", 0, ""}}) {
    Foreign robot(wire());
    robot.color("/image");
    robot.depth("/depth");
    ros::CameraInfo info;
    info.header = robot.header(0);
    info.width = 2, info.height = 1;
    info.k = {2, 0, 0.5, 0, 2, 0, 0, 0, 1};
    info.distortion_model = model;
    info.d.assign(static_cast<std::size_t>(coefficients), 0.01);
    robot.add("/camera_info", 0, info);
    robot.write(writer());
    const std::string error = error_of([&] { open(); });
    EXPECT_TRUE(*said == 0 ? error.empty() : error.find(said) != std::string::npos)
        << model << ": " << error;
  }
}

RecordingConfig with_depth_per_meter(double stated) {
  RecordingConfig config;
  config.calibration = "mine.yaml";
  config.has_camera = [](const fs::path&) { return false; };
  config.depth_per_meter = [=](const fs::path&) { return std::optional(stated); };
  return config;
}

TEST_P(RosRecording, TheUnitOfDepthIsTheOneStated) {
  const auto depth_m = [](const OpenedRecording& opened) {
    return opened.sequence->frame(0, RandomStream(0)).depth_m(0, 0);
  };
  for (const char* unit : {"Depth_Units", "Depth Units"}) {
    Foreign robot(wire());
    robot.color("/device_0/sensor_1/Color_0/image/data");
    robot.depth("/device_0/sensor_0/Depth_0/image/data");
    robot.info("/device_0/sensor_1/Color_0/info/camera_info");
    robot.add(std::string("/device_0/sensor_0/option/") + unit + "/value", 0,
              ros::Float32{0.00025F});
    robot.write(writer());
    EXPECT_EQ(depth_m(open()), 0.25F) << unit;
    EXPECT_TRUE(open().notes.empty());
    const OpenedRecording mine = open(with_depth_per_meter(2000));
    EXPECT_EQ(depth_m(mine), 0.5F);
    ASSERT_EQ(mine.notes.size(), 1U);
    EXPECT_EQ(mine.notes[0],
              "mine.yaml: its depth per meter, 2000, is used for "
              "/device_0/sensor_0/Depth_0/image/data, not 4000");
    EXPECT_TRUE(open(with_depth_per_meter(4000)).notes.empty());
  }
  Foreign plain(wire());
  plain.camera();
  plain.add("/device_0/sensor_7/option/Depth_Units/value", 0, ros::Float32{0.5F});
  plain.write(writer());
  EXPECT_EQ(depth_m(open()), 1.0F) << "of another camera";
  record();
  const OpenedRecording ours = open(with_depth_per_meter(5000));
  EXPECT_EQ(depth_m(ours), depth_m(open())) << "in meters already";
  ASSERT_EQ(ours.notes.size(), 1U);
  EXPECT_NE(ours.notes[0].find("its depth per meter, 5000, is not used"), std::string::npos);
}

TEST_P(RosRecording, StampsThatStandStillGiveWayToTheTimesOfReceipt) {
  for (const bool of_depth : {false, true}) {
    Foreign robot(wire());
    robot.info("/camera_info");
    for (std::size_t i = 0; i < kFrames; ++i) {
      ros::Header none = robot.header(i);
      none.stamp = {};
      robot.add("/image", i + 1,
                ros::Image{of_depth ? robot.header(i + 1) : none, 1, 2, "bgr8", 0, 6, "abcdef"});
      robot.add("/depth", i + 1,
                ros::Image{of_depth ? none : robot.header(i + 1), 1, 2, "16UC1", 0, 4, "abcd"});
      robot.add("/ground_truth", i + 1, ros::PoseStamped{none, {}});
    }
    robot.write(writer());
    const OpenedRecording opened = open();
    ASSERT_EQ(opened.sequence->size(), kFrames);
    ASSERT_EQ(opened.sequence->truth()->size(), kFrames);
    for (std::size_t i = 0; i < kFrames; ++i) {
      EXPECT_EQ(opened.sequence->stamp_ns(i), stamp_ns(i + 1));
      EXPECT_EQ(opened.sequence->truth()->at(i).stamp_ns, stamp_ns(i + 1));
    }
    ASSERT_GE(opened.notes.size(), 2U);
    EXPECT_NE(
        opened.notes[0].find(std::string("the headers of ") + (of_depth ? "/depth" : "/image") +
                             " all have the same stamp: the times of receipt are used"),
        std::string::npos)
        << opened.notes[0];
    EXPECT_NE(opened.notes[1].find("/ground_truth all have"), std::string::npos);
  }
}

// A recording in two parts; only the first has the calibration.
class RosParts : public RosRecording {
 protected:
  void write_part(const std::string& name, std::size_t first, std::size_t end) const {
    Foreign robot(wire());
    if (first == 0) robot.info("/camera_info");
    for (std::size_t i = first; i < end; ++i) {
      const std::string color(6, static_cast<char>('a' + i));
      robot.add("/image", i, ros::Image{robot.header(i), 1, 2, "bgr8", 0, 6, color});
      robot.add("/depth", i, ros::Image{robot.header(i), 1, 2, "16UC1", 0, 4, "abcd"});
    }
    fs::create_directories(folder_ / "run");
    robot.write(is_bag() ? write_bag(at(name)) : write_mcap(at(name)));
  }
  fs::path at(const std::string& name) const { return folder_ / "run" / (name + "." + GetParam()); }
  OpenedRecording open_parts() const { return open_sequence((folder_ / "run").string(), {}); }
};

TEST_P(RosParts, AreOneRecordingInTheOrderOfTheirNumbers) {
  for (const std::size_t part : {0U, 1U, 2U, 10U})
    write_part("2026-01-02-03-04-" + std::to_string(10 + part) + "_" + std::to_string(part),
               2 * part, 2 * part + 2);
  const OpenedRecording opened = open_parts();
  ASSERT_EQ(opened.sequence->size(), 8U);
  EXPECT_EQ(opened.images.size(), 4U);
  for (std::size_t i = 0; i < 8; ++i) {
    const std::size_t number = i < 6 ? i : i + 14;
    EXPECT_EQ(opened.sequence->stamp_ns(i), stamp_ns(number));
    EXPECT_EQ(opened.sequence->frame(i, RandomStream(0)).color(0, 0).r, 'a' + number);
  }
  ASSERT_EQ(opened.notes.size(), 2U);
  EXPECT_NE(opened.notes[0].find("7 of 11 parts are missing"), std::string::npos)
      << opened.notes[0];
  EXPECT_NE(opened.notes[1].find("4 files are read as one recording"), std::string::npos);
}

TEST_P(RosParts, MetadataTellsTheirOrder) {
  write_part("b", 0, 2);
  write_part("a", 2, 3);
  EXPECT_NE(error_of([&] { open_parts(); }).find("holds 2 files"), std::string::npos);
  const std::string ending = std::string(".") + GetParam();
  std::ofstream(folder_ / "run" / "metadata.yaml")
      << "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - b" << ending
      << "\n    - a" << ending << "\n";
  EXPECT_EQ(open_parts().sequence->size(), 3U);
}

TEST_P(RosParts, OneThatIsNoneIsLeftOut) {
  write_part("run_0", 0, 2);
  std::ofstream(at("run_1")) << "";
  write_part("run_2", 2, 3);
  const OpenedRecording opened = open_parts();
  EXPECT_EQ(opened.sequence->size(), 3U);
  ASSERT_EQ(opened.notes.size(), 2U);
  EXPECT_NE(opened.notes[1].find("this part is left out"), std::string::npos) << opened.notes[1];
}

TEST_P(RosParts, RecordingsThatPeopleNumberedAreNone) {
  write_part("kitchen_1", 0, 2);
  write_part("kitchen_2", 0, 2);
  EXPECT_NE(error_of([&] { open_parts(); }).find("name one of them"), std::string::npos);
  write_part("kitchen_0", 0, 2);
  write_part("hall_0", 0, 2);
  EXPECT_NE(error_of([&] { open_parts(); }).find("name one of them"), std::string::npos);
}

/// An image of one color, stored in a given encoding.
class Colors : public RosRecording {
 protected:
  Grid2d<Rgb8> read(const char* encoding, int width, int height, std::uint32_t step,
                    const std::string& bytes, bool big = false) const {
    const ros::Image image{
        {},       static_cast<std::uint32_t>(height),      static_cast<std::uint32_t>(width),
        encoding, big ? std::uint8_t{1} : std::uint8_t{0}, step,
        bytes};
    return color_in(ros::serialized(image, wire()), wire(), false);
  }
};

TEST_P(Colors, OfMosaicsAreThoseOfTheScene) {
  constexpr std::uint32_t kStep = 12;  // rows are longer than the image is wide
  const Rgb8 scene{200, 120, 40};
  for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    std::string bytes(6 * kStep, '\x7');
    for (std::size_t y = 0; y < 6; ++y)
      for (std::size_t x = 0; x < 8; ++x) {
        const char filter = pattern[2 * (y % 2) + x % 2];
        bytes[y * kStep + x] = static_cast<char>(filter == 'r'   ? scene.r
                                                 : filter == 'g' ? scene.g
                                                                 : scene.b);
      }
    const std::string encoding = "bayer_" + pattern + "8";
    const Grid2d<Rgb8> color = read(encoding.c_str(), 8, 6, kStep, bytes);
    EXPECT_EQ(color, (Grid2d<Rgb8>(8, 6, scene))) << pattern;
  }
  EXPECT_NE(error_of([&] {
              read("bayer_rggb8", 2, 2, 2, "abcd");
            }).find("which bayer_rggb8 does not allow"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read("bayer_rggb8", 4, 4, 4, "abcd"); }).find("holds 4 bytes"),
            std::string::npos);
}

// BT.601: Y 82, U 90, V 240 is pure red; Y 41, U 240, V 110 is pure blue.
TEST_P(Colors, OfYuvAreThoseOfTheirStandard) {
  const auto near = [](const Rgb8& color, int r, int g, int b) {
    return std::abs(color.r - r) <= 3 && std::abs(color.g - g) <= 3 && std::abs(color.b - b) <= 3;
  };
  const char y_red = 82, u_red = 90, v_red = static_cast<char>(240);
  const std::string uyvy{u_red, y_red, v_red, y_red}, yuyv{y_red, u_red, y_red, v_red};
  for (const char* name : {"yuv422", "uyvy"})
    EXPECT_TRUE(near(read(name, 2, 1, 4, uyvy)(1, 0), 255, 0, 0)) << name;
  for (const char* name : {"yuv422_yuy2", "yuyv"})
    EXPECT_TRUE(near(read(name, 2, 1, 4, yuyv)(1, 0), 255, 0, 0)) << name;
  const std::string y4(4, y_red);
  EXPECT_TRUE(near(read("nv12", 2, 2, 2, y4 + u_red + v_red)(1, 1), 255, 0, 0));
  EXPECT_TRUE(near(read("nv21", 2, 2, 2, y4 + v_red + u_red)(1, 1), 255, 0, 0));
  EXPECT_NE(error_of([&] {
              read("yuv422", 3, 1, 6, "abcdef");
            }).find("3 x 1 pixels, which yuv422 does not allow"),
            std::string::npos);
  EXPECT_NE(error_of([&] { read("nv12", 2, 2, 2, "abcd"); }).find("holds 4 bytes"),
            std::string::npos);
}

TEST_P(Colors, Of16BitsKeepTheirHigherByte) {
  const std::string little("\1\x10\2\x20\3\x30", 6), big("\x10\1\x20\2\x30\3", 6);
  EXPECT_EQ(read("rgb16", 1, 1, 6, little)(0, 0), (Rgb8{16, 32, 48}));
  EXPECT_EQ(read("bgr16", 1, 1, 6, little)(0, 0), (Rgb8{48, 32, 16}));
  EXPECT_EQ(read("rgb16", 1, 1, 6, big, true)(0, 0), (Rgb8{16, 32, 48}));
}

TEST_P(Colors, OfAMosaicInAPngAreThoseOfTheScene) {
  Grid2d<std::uint8_t> mosaic(8, 6);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x)
      mosaic(x, y) = std::array<std::uint8_t, 4>{200, 120, 120,
                                                 40}[static_cast<std::size_t>(2 * (y % 2) + x % 2)];
  const std::string png = encode_png(mosaic);
  const auto read_as = [&](const char* format) {
    return color_in(ros::serialized(ros::CompressedImage{{}, format, png}, wire()), wire(), true);
  };
  EXPECT_EQ(read_as("bayer_rggb8; png compressed bayer_rggb8")(3, 3), (Rgb8{200, 120, 40}));
  EXPECT_EQ(read_as("mono8; png compressed mono8")(3, 3), (Rgb8{40, 40, 40}));
}

/// Color images of 8 x 6 pixels; a depth camera with 4 x 3 pixels, 0.5 m to the right, sees a plane
/// at 2 m.
class Unregistered : public RosRecording {
 protected:
  static ros::CameraInfo info(const ros::Header& header, std::uint32_t width, double f, double cx,
                              double cy) {
    ros::CameraInfo info;
    info.header = header;
    info.width = width;
    info.height = width * 3 / 4;
    info.k = {f, 0, cx, 0, f, cy, 0, 0, 1};
    return info;
  }
  /// @param color, depth  topics
  void add_cameras(Foreign& robot, const std::string& color, const std::string& color_info,
                   const std::string& depth, const std::string& depth_info) const {
    const std::string pixels(8 * 6 * 3, 'c');
    std::string units;
    for (int i = 0; i < 12; ++i) units += std::string("\xd0\7", 2);  // 2000 mm
    ros::Header of_depth = robot.header(0);
    of_depth.frame_id = "depth_optical";
    robot.add(color, 0, ros::Image{robot.header(0), 6, 8, "rgb8", 0, 24, pixels});
    robot.add(depth, 0, ros::Image{of_depth, 3, 4, "16UC1", 0, 8, units});
    robot.add(color_info, 0, info(robot.header(0), 8, 8, 3.5, 2.5));
    robot.add(depth_info, 0, info(of_depth, 4, 4, 1.5, 1));
  }
  /// A point at x = z (u - 1.5) / 4 + 0.5 m appears at 8 x / z + 3.5 = 2 u + 2.5 and 2 v + 2.5 - 2:
  /// each depth pixel covers two columns and two rows, starting at column 2 u + 2.
  void expect_registered(const OpenedRecording& opened) const {
    const Grid2d<float> depth_m = opened.sequence->frame(0, RandomStream(0)).depth_m;
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) EXPECT_EQ(depth_m(x, y), x < 2 ? 0 : 2.0F) << x << ' ' << y;
    EXPECT_TRUE(std::ranges::any_of(opened.notes, [](const std::string& note) {
      return note.find("is registered to color of") != std::string::npos &&
             note.find("4 x 3 pixels at 0.5 m from it") != std::string::npos;
    }));
  }
};

TEST_P(Unregistered, DepthIsRegisteredByTf) {
  Foreign robot(wire());
  add_cameras(robot, "/rgb/image_raw", "/rgb/camera_info", "/depth/image_raw",
              "/depth/camera_info");
  robot.tf(0, "link", "cam_optical", shift(1, 2, 3), "/tf_static");
  robot.tf(0, "base", "link", shift(7, 0, 0), "/tf_static");
  robot.tf(0, "link", "depth_optical", shift(1.5, 2, 3), "/tf_static");
  robot.write(writer());
  expect_registered(open());
}

TEST_P(Unregistered, DepthIsRegisteredByWhatRealSensesRecorderStates) {
  Foreign robot(wire());
  add_cameras(
      robot, "/device_0/sensor_1/Color_0/image/data", "/device_0/sensor_1/Color_0/info/camera_info",
      "/device_0/sensor_0/Depth_0/image/data", "/device_0/sensor_0/Depth_0/info/camera_info");
  // Each transform leads from a common reference, 1 m to the right of the depth camera, to the
  // stream.
  robot.add("/device_0/sensor_0/Depth_0/tf/0", 0, ros::Transform{{1, 0, 0}, {}});
  robot.add("/device_0/sensor_1/Color_0/tf/0", 0, ros::Transform{{1.5, 0, 0}, {}});
  robot.write(writer());
  expect_registered(open());
}

TEST_P(Unregistered, DepthIsRegisteredByTheDriversExtrinsics) {
  Foreign robot(wire());
  add_cameras(robot, "/camera/color/image_raw", "/camera/color/camera_info",
              "/camera/depth/image_rect_raw", "/camera/depth/camera_info");
  robot.add("/camera/extrinsics/depth_to_color", 0,
            ros::Extrinsics{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.5, 0, 0}});
  robot.write(writer());
  expect_registered(open());
}

TEST_P(Unregistered, WithoutATransformItIsRefused) {
  Foreign robot(wire());
  add_cameras(robot, "/rgb/image_raw", "/rgb/camera_info", "/depth/image_raw",
              "/depth/camera_info");
  robot.tf(0, "odom", "cam_optical", shift(1, 2, 3));
  robot.tf(1, "odom", "cam_optical", shift(2, 2, 3));  // it moves
  robot.tf(0, "odom", "depth_optical", shift(1.5, 2, 3));
  robot.write(writer());
  EXPECT_NE(error_of([&] { open(); })
                .find("depth of /depth/image_raw is 4 x 3, color of /rgb/image_raw is 8 x 6, and "
                      "neither tf nor extrinsics tells how to register it"),
            std::string::npos)
      << error_of([&] { open(); });
}

TEST_P(Unregistered, DepthOfHalfTheSizeInTheFrameOfColorIsEnlarged) {
  Foreign robot(wire());
  ros::Header of_color = robot.header(0);
  robot.add("/rgb/image/compressed", 0,
            ros::CompressedImage{of_color, "jpeg", encode_jpeg(Grid2d<Rgb8>(8, 6), 90)});
  std::string units;
  for (int i = 0; i < 12; ++i) units += std::string("\xd0\7", 2);
  robot.add("/depth/image", 0, ros::Image{of_color, 3, 4, "16UC1", 0, 8, units});
  robot.add("/rgb/camera_info", 0, info(of_color, 8, 8, 3.5, 2.5));
  robot.add("/depth/camera_info", 0, info(of_color, 4, 4, 1.5, 1));
  robot.write(writer());
  EXPECT_EQ(open().sequence->frame(0, RandomStream(0)).depth_m, Grid2d<float>(8, 6, 2.0F));
}

// https://github.com/IntelRealSense/realsense-ros/issues/363
TEST_P(Unregistered, DepthInTheFrameOfColorIsAlignedWhateverItsCalibration) {
  Foreign robot(wire());
  robot.camera();
  ros::CameraInfo info;
  info.header = robot.header(0);
  info.width = 2, info.height = 1;
  info.k = {9, 0, 0.5, 0, 9, 0, 0, 0, 1};
  robot.add("/aligned/camera_info", 0, info);
  robot.depth("/aligned/image");
  robot.add("/extrinsics/depth_to_color", 0,
            ros::Extrinsics{{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.5, 0, 0}});
  robot.write(writer());
  const OpenedRecording opened = open(with_topics("depth=/aligned/image"));
  EXPECT_EQ(opened.sequence->frame(0, RandomStream(0)).depth_m(0, 0), 1.0F);
  ASSERT_EQ(opened.notes.size(), 1U);
  EXPECT_NE(opened.notes[0].find("a different calibration from color of /image: it is used as if"),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Both, RosParts, testing::Values("bag", "mcap"));
INSTANTIATE_TEST_SUITE_P(Both, Colors, testing::Values("bag", "mcap"));
INSTANTIATE_TEST_SUITE_P(Both, Unregistered, testing::Values("bag", "mcap"));
INSTANTIATE_TEST_SUITE_P(Both, RosRecording, testing::Values("bag", "mcap"));

TEST(TopicNames, AreKeysAndTopics) {
  EXPECT_EQ(parse_topic_names("color=/a,depth=/b").depth, "/b");
  for (const char* bad : {"color", "color=", "hue=/a", "color=/a,color=/b"})
    EXPECT_THROW(parse_topic_names(bad), InputError) << bad;
}

TEST(TopicNames, OnlyMessagesHaveThem) {
  EXPECT_NE(error_of([] {
              open_sequence("tum:/nowhere", with_topics("color=/a"));
            }).find("has no topics"),
            std::string::npos);
}

}  // namespace
}  // namespace mh
