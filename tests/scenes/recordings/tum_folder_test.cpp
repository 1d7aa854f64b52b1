// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "bench/suite/recorded_camera.hpp"
#include "scenes/image_file.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "slam/core/random.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class TumFolder : public testing::Test {
 protected:
  TumFolder() : folder_(fs::temp_directory_path() / ("mh_tum_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    camera_.width_px = 8;
    camera_.height_px = 6;
    camera_.cx_px = 3.5;
    camera_.cy_px = 2.5;
  }
  ~TumFolder() override { fs::remove_all(folder_); }

  RgbdFrame frame(Stamp stamp_ns) const {
    RgbdFrame f;
    f.stamp_ns = stamp_ns;
    f.color = Grid2d<Rgb8>(8, 6, Rgb8{1, 2, 3});
    f.color(7, 5) = {200, 100, 50};
    f.depth_m = Grid2d<float>(8, 6, 1.25F);
    f.depth_m(0, 0) = 0;
    return f;
  }
  ExactFrame exact(Stamp stamp_ns, const SE3& pose) const {
    ExactFrame f{frame(stamp_ns), Grid2d<ClassId>(8, 6, ClassId{5}),
                 Grid2d<InstanceId>(8, 6, InstanceId{700}), pose};
    f.classes(2, 1) = 0;
    return f;
  }

  fs::path folder_;
  Camera camera_;
};

TEST_F(TumFolder, ReadsBackWhatItWrote) {
  TumWriter writer(folder_, camera_);
  const SE3 pose(Eigen::Matrix3d::Identity(), {1, 2, 3});
  writer.add(0, exact(0, pose));
  writer.add(1, exact(33'333'333, pose));
  EXPECT_FALSE(fs::exists(folder_ / "rgb.txt")) << "an unfinished folder looks finished";
  writer.finish();

  const RecordedCamera camera = load_recorded_camera(folder_ / "camera.yaml");
  EXPECT_EQ(camera.camera, camera_);
  EXPECT_EQ(camera.depth_per_meter, 5000);
  const std::vector<RecordedFrame> frames = load_tum_folder(folder_);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].stamp_ns, 33'333'333);
  const RgbdFrame read = read_frame(frames[1], camera);
  EXPECT_EQ(read.color, frame(0).color);
  EXPECT_EQ(read.depth_m, frame(0).depth_m);  // 1.25 m is a whole number of units
  EXPECT_EQ(read.semantics.at(0, 0).most_probable(), 5);
  EXPECT_EQ(read.semantics.at(2, 1).most_probable(), kVoid);
  EXPECT_EQ(read_trajectory(folder_ / "groundtruth.txt").size(), 2u);
}

TEST_F(TumFolder, EveryDepthIsTheQuotientOfTwoDoublesRounded) {
  camera_.width_px = camera_.height_px = 256;
  fs::create_directories(folder_);
  cv::Mat units(256, 256, CV_16UC1);
  for (int i = 0; i < 65536; ++i)
    units.at<std::uint16_t>(i / 256, i % 256) = static_cast<std::uint16_t>(i);
  write_image(folder_ / "depth.png", units);
  write_image(folder_ / "color.png", cv::Mat(256, 256, CV_8UC3, cv::Scalar(1, 2, 3)));
  for (const double per_meter : {5000.0, 1000.0, 5208.3, 6553.6, 999.99}) {
    const RgbdFrame read =
        read_frame({0, folder_ / "color.png", folder_ / "depth.png", {}}, {camera_, per_meter});
    for (int i = 0; i < 65536; ++i)
      ASSERT_EQ(read.depth_m(i % 256, i / 256), static_cast<float>(i / per_meter))
          << i << " at " << per_meter;
  }
}

// Lossy compression creates class ids that were never written.
TEST_F(TumFolder, LabelsThatAreNotExactAreRefused) {
  TumWriter writer(folder_, camera_);
  writer.add(0, exact(0, SE3()));
  writer.finish();
  const RecordedFrame listed = load_tum_folder(folder_).front();
  std::ofstream(listed.classes, std::ios::binary) << encode_jpeg(Grid2d<Rgb8>(8, 6), 90);
  try {
    read_frame(listed, {camera_, 5000});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("is a JPEG image, whose ids are not exact"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(TumFolder, RedAndBlueAreExchangedWhereTheCameraSaysSo) {
  TumWriter writer(folder_, camera_);
  writer.add(0, exact(0, SE3()));
  writer.finish();
  RecordedCamera camera{camera_, 5000};
  camera.exchange_red_blue = true;
  Grid2d<Rgb8> exchanged = frame(0).color;
  for (Rgb8& color : exchanged) std::swap(color.r, color.b);
  EXPECT_EQ(read_frame(load_tum_folder(folder_).front(), camera).color, exchanged);
}

TEST_F(TumFolder, NamesWhatIsWrong) {
  fs::create_directories(folder_);
  EXPECT_THROW(load_tum_folder(folder_), InputError);
  std::ofstream(folder_ / "rgb.txt") << "# comment\n0.1 a.png\n0.2\n";
  std::ofstream(folder_ / "depth.txt") << "0.1 a.png\n";
  try {
    load_tum_folder(folder_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rgb.txt:3"), std::string::npos) << error.what();
  }
  std::ofstream(folder_ / "rgb.txt") << "0.1 a.png\n0.9 b.png\n";
  std::vector<std::string> notes;
  const auto frames = load_tum_folder(folder_, &notes);
  ASSERT_EQ(frames.size(), 1u);  // there is no image close to 0.9 s
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("1 of 2 color images have no depth image"), std::string::npos);
  const auto refused = [&](const std::string& part) {
    try {
      read_frame(frames[0], {camera_, 5000});
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused("a.png: cannot be read: no such file");
  std::ofstream(folder_ / "a.png") << "no image";
  refused("a.png: is not an image, or is damaged");
  const std::string whole = encode_png(Grid2d<std::uint8_t>(8, 6));
  std::ofstream(folder_ / "a.png", std::ios::binary) << whole.substr(0, whole.size() - 12);
  refused("a.png: is truncated");
  std::string huge = whole;  // its header declares 100000 x 100000 pixels
  huge.replace(16, 8, std::string("\0\1\x86\xa0\0\1\x86\xa0", 8));
  std::ofstream(folder_ / "a.png", std::ios::binary) << huge;
  refused("a.png: is 100000 x 100000, the camera has 8 x 6");
  std::ofstream(folder_ / "rgb.txt") << "# nothing\n";
  try {
    load_tum_folder(folder_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rgb.txt: lists no image"), std::string::npos);
  }
}

TEST_F(TumFolder, WhatHasNoUseIsTold) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "rgb.txt") << "0.1 a.png\n";
  std::ofstream(folder_ / "depth.txt") << "0.1 b.png\n";
  std::ofstream(folder_ / "label.txt") << "9.1 c.png\n";
  std::ofstream(folder_ / "classes.yaml") << "900: chair\n";
  std::ofstream(folder_ / "groundtruth.txt") << "77 0 0 0 0 0 0 1\n";
  Grid2d<std::uint8_t> ids(8, 6, std::uint8_t{5});
  std::ofstream(folder_ / "c.png", std::ios::binary) << encode_png(ids);
  const auto notes = [&](const fs::path& classes) {
    RecordingConfig config{.calibration = "x", .classes = classes};
    config.read_camera = [&](const fs::path&) { return RecordedCamera{camera_, 5000}; };
    std::string all;
    for (const std::string& note : open_sequence("tum:" + folder_.string(), config).notes)
      all += note + "\n";
    return all;
  };
  EXPECT_NE(notes("").find("label.txt: 1 of 1 frames have no label image"), std::string::npos);
  EXPECT_NE(notes("").find("no frame has a true pose at its time"), std::string::npos) << notes("");
  const fs::path classes = folder_ / "classes.yaml";
  EXPECT_NE(notes(classes).find("is not used: the recording has no labels"), std::string::npos);
  std::ofstream(folder_ / "label.txt") << "0.1 c.png\n";
  EXPECT_NE(notes(classes).find("c.png: none of its ids has a class"), std::string::npos)
      << notes(classes);
  fs::remove(folder_ / "c.png");  // costs the frame its labels, not the recording
  EXPECT_EQ(notes(classes).find("none of its ids"), std::string::npos);
  std::ofstream(folder_ / "c.png", std::ios::binary) << encode_jpeg(Grid2d<Rgb8>(4, 4), 90);
  EXPECT_EQ(notes(classes).find("none of its ids"), std::string::npos);
  std::ofstream(folder_ / "c.png", std::ios::binary) << encode_png(ids);
  std::ofstream(folder_ / "groundtruth.txt")
      << "0.1 0 0 0 0 0 0 1\n0.2 nan nan nan nan nan nan nan\n0.3 0 0 0 0 0 0 0\n"
         "0.4 0 0 0 0 0 0 1\n0.4 1 0 0 0 0 0 1\n";
  EXPECT_NE(notes("").find("groundtruth.txt: 3 of 5 poses are left out: 1 is not finite, 1 has no "
                           "rotation, 1 repeats a stamp; the first in line 2: tx"),
            std::string::npos)
      << notes("");
  std::ofstream(folder_ / "groundtruth.txt") << "0.1 0 0 0 0 0 0 0\n";
  EXPECT_NE(notes("").find("groundtruth.txt: holds no pose: there is no truth"), std::string::npos)
      << notes("");
  fs::remove(folder_ / "groundtruth.txt");
  fs::create_directories(folder_ / "groundtruth.txt");
  EXPECT_EQ(notes("").find("its time"), std::string::npos);
  EXPECT_NE(notes("").find("groundtruth.txt: is not a file"), std::string::npos) << notes("");
  std::ofstream(folder_ / "classes.yaml") << "5: chair\n";
  EXPECT_EQ(notes(classes).find("none of its ids"), std::string::npos);
}

TEST_F(TumFolder, ListsInNoOrderAreSortedByTheirStamps) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "rgb.txt") << "0.1 a.png\n0.3 b.png\n0.2 c.png\n0.2 d.png\n";
  std::ofstream(folder_ / "depth.txt") << "0.3 3.png\n0.2 2.png\n0.1 1.png\n";
  std::vector<std::string> notes;
  const auto frames = load_tum_folder(folder_, &notes);
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(frames[1].color, folder_ / "c.png");
  EXPECT_EQ(frames[1].depth, folder_ / "2.png");
  EXPECT_EQ(frames[2].color, folder_ / "d.png") << "of one stamp: as listed";
  EXPECT_EQ(frames[3].depth, folder_ / "3.png");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("rgb.txt: its images are not ordered by timestamp"), std::string::npos);
  std::ofstream(folder_ / "rgb.txt") << "0.1 a.png\n0.2 c.png\n0.2 d.png\n0.3 b.png\n";
  notes.clear();
  load_tum_folder(folder_, &notes);
  EXPECT_TRUE(notes.empty());
}

TEST_F(TumFolder, TakesTheNearestDepthAndTheFirstOfEquals) {
  fs::create_directories(folder_);
  // Timestamps in tens of milliseconds, out of order and repeated; some have equally near partners
  // on both sides.
  const RandomStream draw(7);
  std::string colors, depths;
  std::vector<Stamp> color_ns, depth_ns;
  for (std::uint64_t i = 0; i < 60; ++i) {
    color_ns.push_back(static_cast<Stamp>(draw.below(2 * i, 200)) * 10'000'000);
    depth_ns.push_back(static_cast<Stamp>(draw.below(2 * i + 1, 200)) * 10'000'000);
    colors += format_stamp(color_ns.back()) + " c.png\n";
    depths += format_stamp(depth_ns.back()) + " " + std::to_string(i) + ".png\n";
  }
  std::ofstream(folder_ / "rgb.txt") << colors;
  std::ofstream(folder_ / "depth.txt") << depths;
  std::vector<std::string> wanted, found;
  std::ranges::sort(color_ns);
  for (const Stamp stamp_ns : color_ns) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < depth_ns.size(); ++i)
      if (std::abs(depth_ns[i] - stamp_ns) <= 20'000'000 &&
          (!best || std::abs(depth_ns[i] - stamp_ns) < std::abs(depth_ns[*best] - stamp_ns)))
        best = i;
    if (best) wanted.push_back(std::to_string(*best) + ".png");
  }
  for (const RecordedFrame& frame : load_tum_folder(folder_))
    found.push_back(frame.depth.filename().string());
  ASSERT_GT(wanted.size(), 20U);
  EXPECT_EQ(found, wanted);
}

TEST(DepthUnits, RoundToTheNearestAndKeepToSixteenBits) {
  for (int i = 0; i < 200'000; ++i) {
    const float depth_m = static_cast<float>(i) * 7e-5F;
    const double units = std::round(kDepthPerMeter * static_cast<double>(depth_m));
    ASSERT_EQ(depth_units(depth_m), static_cast<std::uint16_t>(std::min(units, 65535.0)))
        << depth_m;
  }
  EXPECT_EQ(depth_units(-1.0F), 0);
  EXPECT_EQ(depth_units(std::numeric_limits<float>::infinity()), 65535);
  EXPECT_EQ(depth_units(std::numeric_limits<float>::quiet_NaN()), 0) << "nothing came back";
}

TEST_F(TumFolder, ReadsAssociationsWhereTheListsAreMissing) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "associations.txt") << "0.1 a.png 0.11 b.png\n0.2 c.png 0.21 d.png\n";
  const auto frames = load_tum_folder(folder_);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1].color, folder_ / "c.png");
  EXPECT_EQ(frames[1].depth, folder_ / "d.png");
  // Pairs are taken as listed, no matter how far apart they are.
  std::ofstream(folder_ / "associations.txt") << "0.1 a.png 0.2 b.png\n";
  EXPECT_EQ(load_tum_folder(folder_)[0].depth, folder_ / "b.png");
  std::ofstream(folder_ / "associations.txt") << "0.1 a.png\n";
  EXPECT_THROW(load_tum_folder(folder_), InputError);
}

// associate.py depth.txt rgb.txt writes depth first.
TEST_F(TumFolder, TheImagesTellWhichOfAPairIsDepth) {
  TumWriter writer(folder_, camera_);
  for (const Stamp stamp_ns : {100'000'000, 200'000'000}) writer.add(frame(stamp_ns));
  writer.finish();
  fs::remove(folder_ / "rgb.txt");
  const std::string color = " rgb/0.100000000.png", depth = " depth/0.100000000.png";
  for (const std::string& line :
       {"0.1" + color + " 0.11" + depth, "0.11" + depth + " 0.1" + color}) {
    // The first pair cannot be read at all, or only half of it can.
    for (const std::string& before : {std::string(), std::string("0.05 x.png 0.05 y.png\n")}) {
      std::ofstream(folder_ / "associations.txt") << before << line << "\n";
      const RecordedFrame read = load_tum_folder(folder_).back();
      EXPECT_EQ(read.stamp_ns, 100'000'000) << "that of color";
      EXPECT_EQ(read.depth, folder_ / "depth/0.100000000.png");
      EXPECT_EQ(read_frame(read, {camera_, 5000}).color, frame(0).color);
    }
  }
}

TEST_F(TumFolder, AssociationsOfThreeListsAreRefusedByTheirWords) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "associations.txt")
      << "# pose depth color\n0.1 -0.68 2.69 1.73 0 0.86 -0.5 0 0.1 depth/1.png 0.1 rgb/1.png\n";
  try {
    load_tum_folder(folder_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("associations.txt:2: '-0.68' is not a file: a line is 'stamp file stamp "
                        "file', but this one has 12 words"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(TumFolder, OfEth3dBringsItsCalibration) {
  TumWriter writer(folder_, camera_);
  for (const Stamp stamp_ns : {100'000'000, 140'000'000}) writer.add(frame(stamp_ns));
  writer.finish();
  for (const char* name : {"camera.yaml", "camera_info.yaml", "associations.txt"})
    fs::remove(folder_ / name);
  const auto open = [&] { return open_sequence(folder_.string(), {}); };
  std::ofstream(folder_ / "calibration.txt") << "7.5 7.25 3.5 2.5\n";
  const OpenedRecording opened = open();
  const Camera& camera = opened.sequence->camera();
  EXPECT_EQ(camera.width_px, 8);
  EXPECT_EQ(camera.height_px, 6);
  EXPECT_EQ(camera.fx_px, 7.5);
  EXPECT_EQ(camera.fy_px, 7.25);
  EXPECT_EQ(camera.cx_px, 3.5);
  EXPECT_EQ(camera.cy_px, 2.5);
  EXPECT_EQ(camera.rate_hz, 25);
  EXPECT_TRUE(camera.distortion.none());
  EXPECT_EQ(opened.sequence->frame(1, RandomStream()).depth_m, frame(0).depth_m);
  // The list of pairs is enough.
  fs::remove(folder_ / "rgb.txt");
  std::ofstream(folder_ / "associated.txt")
      << "0.1 rgb/0.100000000.png 0.1 depth/0.100000000.png\n";
  EXPECT_EQ(open().sequence->size(), 1U);
  for (const char* bad : {"7.5 7.25 3.5\n", "7.5 7.25 3.5 2.5 0.1\n", "7.5 7.25 3.5 x\n"}) {
    std::ofstream(folder_ / "calibration.txt") << bad;
    EXPECT_THROW(open(), InputError) << bad;
  }
}

// Variants in use: other names for the list of pairs, ROS timestamps, gray cameras, images with an
// alpha channel from simulators.
TEST_F(TumFolder, IsReadAsPeopleWriteIt) {
  TumWriter writer(folder_, camera_);
  writer.add(frame(100'000'000));
  writer.finish();
  const std::string pair = " rgb/0.100000000.png ";
  const auto open = [&] { return open_sequence("tum:" + folder_.string(), {}); };
  for (const char* name : {"camera.yaml", "camera_info.yaml", "rgb.txt", "associations.txt"})
    fs::remove(folder_ / name);
  std::ofstream(folder_ / "calibration.txt") << "7.5 7.25 3.5 2.5\n";
  for (const char* name : {"association.txt", "associate.txt"}) {
    std::ofstream(folder_ / name) << "1600000000123456789" << pair
                                  << "1600000000123456789 depth/0.100000000.png\n";
    EXPECT_EQ(open().sequence->stamp_ns(0), 1'600'000'000'123'456'789) << name;
    fs::remove(folder_ / name);
  }
  std::ofstream(folder_ / "rgb.txt") << "0.1" << pair << "\n";
  const cv::Mat gray(6, 8, CV_8UC1, cv::Scalar(9)),
      with_opacity(6, 8, CV_8UC4, cv::Scalar(3, 2, 1, 77));
  write_image(folder_ / "rgb/0.100000000.png", gray);
  EXPECT_EQ(open().sequence->frame(0, RandomStream()).color(4, 3), (Rgb8{9, 9, 9}));
  cv::imwrite(folder_ / "rgb/0.100000000.png", with_opacity);
  EXPECT_EQ(open().sequence->frame(0, RandomStream()).color(4, 3), (Rgb8{1, 2, 3}));
}

TEST_F(TumFolder, AScaleOfDepthThatGivesWayIsTold) {
  TumWriter writer(folder_ / "rgbd_bonn_x", camera_);
  writer.add(frame(100'000'000));
  writer.finish();
  fs::remove(folder_ / "rgbd_bonn_x" / "camera.yaml");
  fs::remove(folder_ / "rgbd_bonn_x" / "camera_info.yaml");
  RecordingConfig config{.calibration = "mine.yaml", .classes = {}};
  config.read_camera = [&](const fs::path&) { return RecordedCamera{camera_, 4000}; };
  config.depth_per_meter = [](const fs::path&) { return std::optional(4000.0); };
  const auto has_note = [&](const std::string& layout) {
    const auto opened = open_sequence(layout + (folder_ / "rgbd_bonn_x").string(), config);
    return std::ranges::any_of(opened.notes, [](const std::string& note) {
      return note ==
             "mine.yaml: its depth per meter, 4000, is replaced by 5000, the recording's own";
    });
  };
  EXPECT_TRUE(has_note("bonn:"));
  EXPECT_FALSE(has_note("tum:")) << "there it counts";
}

TEST_F(TumFolder, ANameInLatin1CostsItsFrame) {
  TumWriter writer(folder_, camera_);
  for (const Stamp stamp_ns : {100'000'000, 200'000'000}) writer.add(frame(stamp_ns));
  writer.finish();
  std::ofstream(folder_ / "rgb.txt") << "0.1 rgb/b\xfcro.png\n0.2 rgb/0.200000000.png\n";
  const auto frames = load_tum_folder(folder_);
  ASSERT_EQ(frames.size(), 2U);
  try {
    read_frame(frames[0], {camera_, 5000});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("b?ro.png: cannot be read"), std::string::npos);
  }
  read_frame(frames[1], {camera_, 5000});
}

TEST_F(TumFolder, ReadsOrbSlamsOwnCalibration) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "TUM1.yaml")
      << "%YAML:1.0\n\nCamera.fx: 517.3\nCamera.fy: 516.5\nCamera.cx: 318.6\nCamera.cy: 255.3\n"
      << "Camera.k1: 0.2624\nCamera.bf: 40.0\nDepthMapFactor: 5000.0\nORBextractor.nFeatures: "
         "1000\n";
  const RecordedCamera camera = load_recorded_camera(folder_ / "TUM1.yaml");
  EXPECT_DOUBLE_EQ(camera.camera.fx_px, 517.3);
  EXPECT_DOUBLE_EQ(camera.camera.distortion.k1, 0.2624);
  EXPECT_NEAR(camera.camera.baseline_m, 40.0 / 517.3, 1e-12);
  std::ofstream(folder_ / "bad.yaml") << "Camera.fx: 517.3\n";
  EXPECT_THROW(load_recorded_camera(folder_ / "bad.yaml"), InputError);
}

}  // namespace
}  // namespace mh
