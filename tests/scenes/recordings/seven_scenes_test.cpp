// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/seven_scenes.hpp"

#include <algorithm>
#include <array>

#include "scenes/image_file.hpp"
#include "scenes/recordings/images/png.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "slam/io/read_record.hpp"
#include "tests/scenes/recordings/made_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A made-up scene in the data set's layout: what its two cameras would see of a wall and a square.
class SevenScenes : public MadeFolder {
 protected:
  static SE3 world_from_depth(int frame) {
    return {so3_exp({0.02 * frame, -0.1, 0.05}), Eigen::Vector3d(0.1, 0.02 * frame, 0.0)};
  }
  static std::string name_of(const std::string& folder, int frame, const std::string& ending) {
    return fmt::format("{}/frame-{:06}.{}", folder, frame, ending);
  }
  void write_sequence(const std::string& folder, int frames) const {
    for (int i = 0; i < frames; ++i) {
      const Grid2d<Rgb8> color(640, 480, Rgb8{10, 20, static_cast<std::uint8_t>(30 + i)});
      write(name_of(folder, i, "color.png"), encode_png(color_image(color)));
      const auto depth =
          WallAndSquare::depth_image(seven_scenes_depth().camera, world_from_depth(i), 1000);
      write(name_of(folder, i, "depth.png"), encode_png(depth));
      write(name_of(folder, i, "pose.txt"), matrix_text(world_from_depth(i), "\t\r\n"));
    }
  }
  OpenedRecording open(const std::string& name) const {
    return open_sequence((folder_ / name).string(), {.whole = true});
  }
};

// Depth in the color camera has its closed form: that of the near square, that of the wall behind
// it, and none where the square hides the wall only from the depth camera.
TEST_F(SevenScenes, DepthIsRegisteredToTheColorCamera) {
  write_sequence("seq-01", 2);
  const OpenedRecording opened = open("seq-01");
  const Sequence& sequence = *opened.sequence;
  ASSERT_EQ(sequence.size(), 2U);
  EXPECT_EQ(sequence.camera().fx_px, 525);
  EXPECT_EQ(sequence.stamp_ns(1), 33'333'333);
  const Camera& color = sequence.camera();
  const DepthCamera depth = seven_scenes_depth();
  const RgbdFrame frame = sequence.frame(1, RandomStream());
  EXPECT_EQ(frame.color(7, 5), (Rgb8{10, 20, 31}));
  const SE3 world_from_color = sequence.truth()->at(1).world_from_camera;
  EXPECT_TRUE((world_from_color * depth.color_from_depth)
                  .translation()
                  .isApprox(world_from_depth(1).translation(), 1e-9));
  enum Class : std::uint8_t { kSquare, kWall, kHidden, kOutside };
  Grid2d<Class> class_of(640, 480, kOutside);
  Grid2d<double> seen_m(640, 480);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      seen_m(u, v) = WallAndSquare::depth_m(color, world_from_color, u, v);
      const Eigen::Vector3d point =
          depth.color_from_depth.inverse() * color.unproject(u, v, seen_m(u, v));
      const Eigen::Vector2d pixel = depth.camera.project(point);
      const double from_depth_m =
          WallAndSquare::depth_m(depth.camera, world_from_depth(1), pixel.x(), pixel.y());
      if (depth.camera.in_image(pixel.x(), pixel.y()))
        class_of(u, v) = from_depth_m < point.z() - 0.5 ? kHidden
                         : seen_m(u, v) < 2             ? kSquare
                                                        : kWall;
    }
  std::array<int, 4> count{};
  for (int v = 1; v + 1 < 480; ++v)
    for (int u = 1; u + 1 < 640; ++u) {
      const Class here = class_of(u, v);
      bool at_edge = false;  // rounding may move a point across it
      for (int k = 0; k < 9; ++k)
        at_edge = at_edge || class_of(u + k % 3 - 1, v + k / 3 - 1) != here;
      if (at_edge) continue;
      ++count[here];
      // Half a millimeter is due to the files, the rest to half a pixel on a wall turned by 6
      // degrees.
      const double expected_m = here == kHidden || here == kOutside ? 0 : seen_m(u, v);
      EXPECT_NEAR(frame.depth_m(u, v), expected_m, 1.5e-3) << u << ' ' << v;
    }
  EXPECT_GT(count[kSquare], 40'000);
  EXPECT_GT(count[kWall], 100'000);
  EXPECT_GT(count[kHidden], 500) << "the cameras are 2.6 cm apart";
  EXPECT_GT(count[kOutside], 10'000) << "the color camera sees more";
}

TEST_F(SevenScenes, ACameraOfAnotherSizeIsRefused) {
  write_sequence("seq-01", 1);
  RecordingConfig config;
  config.calibration = "half.yaml";
  config.read_camera = [](const fs::path&) {
    RecordedCamera camera;
    camera.camera.width_px = 320;
    camera.camera.height_px = 240;
    return camera;
  };
  try {
    open_sequence((folder_ / "seq-01").string(), config);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("half.yaml: has 320 x 240"), std::string::npos)
        << error.what();
  }
}

TEST_F(SevenScenes, PixelsWithoutMeasurementHaveNoDepth) {
  write_sequence("seq-01", 1);
  write(name_of("seq-01", 0, "depth.png"), encode_png(Grid2d<std::uint16_t>(640, 480, 65535)));
  const RgbdFrame frame = open("seq-01").sequence->frame(0, RandomStream());
  EXPECT_TRUE(std::ranges::all_of(frame.depth_m, [](float z) { return z == 0.0F; }));
}

TEST_F(SevenScenes, ASplitIsARecordingOfItsSequences) {
  write_sequence("seq-01", 2);
  write_sequence("seq-12", 1);
  write("TrainSplit.txt", "sequence1\r\nsequence12\r\n");
  write("TestSplit.txt", "sequence12 \n");
  const OpenedRecording train = open("TrainSplit.txt"), test = open("TestSplit.txt");
  ASSERT_EQ(train.sequence->size(), 3U);
  EXPECT_EQ(train.files.size(), 6U);
  EXPECT_EQ(train.sequence->stamp_ns(2), 10'033'333'333) << "ten seconds later";
  EXPECT_EQ(train.sequence->truth()->size(), 3U);
  EXPECT_EQ(test.sequence->size(), 1U);
  write("TrainSplit.txt", "sequence1\nsequence3\n");
  EXPECT_NE(complaint("seven_scenes", "TrainSplit.txt").find("seq-03 is not a folder"),
            std::string::npos);
  write("seq-03.zip", "");
  EXPECT_NE(complaint("seven_scenes", "TrainSplit.txt").find("unpack"), std::string::npos);
  write("TrainSplit.txt", "chess\n");
  EXPECT_NE(complaint("seven_scenes", "TrainSplit.txt").find("'chess' is not a sequence"),
            std::string::npos);
  write("TrainSplit.txt", "");
  EXPECT_NE(complaint("seven_scenes", "TrainSplit.txt").find("names no sequence"),
            std::string::npos);
}

TEST_F(SevenScenes, WhatCannotBeUsedIsCounted) {
  write_sequence("seq-01", 6);
  write(name_of("seq-01", 1, "pose.txt"), "nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  write(name_of("seq-01", 2, "pose.txt"), "1 0 0 0 0 1 0 0 0 0 1 0");
  write(name_of("seq-01", 3, "pose.txt"), "-1.#IND000e+000 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  fs::remove(folder_ / name_of("seq-01", 4, "pose.txt"));
  fs::remove(folder_ / name_of("seq-01", 5, "depth.png"));
  const OpenedRecording opened = open("seq-01");
  EXPECT_EQ(opened.sequence->size(), 5U);
  EXPECT_EQ(opened.sequence->truth()->size(), 1U);
  ASSERT_EQ(opened.notes.size(), 2U);
  EXPECT_NE(opened.notes[0].find("1 of 6 color images have no depth image"), std::string::npos)
      << opened.notes[0];
  EXPECT_NE(opened.notes[1].find("4 of 5 frames have no valid pose"), std::string::npos);
  EXPECT_NE(opened.notes[1].find("frame-000001.pose.txt: holds a number that is not finite"),
            std::string::npos)
      << opened.notes[1];
}

TEST_F(SevenScenes, AFolderWithoutFramesIsRefused) {
  EXPECT_NE(complaint("seven_scenes").find("holds no frame-XXXXXX.color.png"), std::string::npos);
  EXPECT_NE(complaint("seven_scenes", "absent").find("absent"), std::string::npos);
}

// The key of a run covers poses and splits as well as images.
TEST_F(SevenScenes, EveryFileIsOfTheRecording) {
  write_sequence("seq-01", 2);
  write("TestSplit.txt", "sequence1\n");
  const auto key = [&] {
    const ReadScope scope;
    open("TestSplit.txt");
    return digest(scope.record());
  };
  const std::uint64_t first = key();
  EXPECT_EQ(key(), first);
  write(name_of("seq-01", 1, "pose.txt"), matrix_text(world_from_depth(7)));
  const std::uint64_t other_pose = key();
  EXPECT_NE(other_pose, first);
  write(name_of("seq-01", 0, "depth.png"), encode_png(Grid2d<std::uint16_t>(640, 480, 1)));
  EXPECT_NE(key(), other_pose);
}

}  // namespace
}  // namespace mh
