// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A folder in the data set's layout: three frames of 640 x 480, numbered from 0.
class IclNuim : public testing::Test {
 protected:
  IclNuim() : folder_(fs::temp_directory_path() / ("mh_icl_nuim_" + std::to_string(getpid()))) {
    Camera camera;
    camera.width_px = 640;
    camera.height_px = 480;
    TumWriter writer(folder_, camera);
    std::ofstream list(folder_ / "numbers");
    for (int i = 0; i < 3; ++i) {
      writer.add({i,
                  Grid2d<Rgb8>(640, 480, Rgb8{10, 20, static_cast<std::uint8_t>(30 + i)}),
                  Grid2d<float>(640, 480, 1.5F),
                  {}});
      const std::string file = "0.00000000" + std::to_string(i) + ".png";
      list << i << " depth/" << file << ' ' << i << " rgb/" << file << '\n';
    }
    fs::rename(folder_ / "numbers", folder_ / "associations.txt");
  }
  ~IclNuim() override { fs::remove_all(folder_); }

  void write_truth(const std::string& text, const std::string& name = "livingRoom0") const {
    std::ofstream(folder_ / (name + ".gt.freiburg")) << text;
  }
  std::string complaint() const {
    try {
      open_sequence("icl_nuim:" + folder_.string(), {});
      return "none";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  fs::path folder_;
};

TEST_F(IclNuim, IsRecognizedAndReadWithItsPublishedCamera) {
  write_truth("1 0 0 -2.25 0 0 0 1\n2 0 0 -2.24 0 0 0 1\n");
  const OpenedRecording opened = open_sequence(folder_.string(), {});
  const Sequence& sequence = *opened.sequence;
  ASSERT_EQ(sequence.size(), 3U);
  EXPECT_EQ(sequence.camera().fx_px, 481.2);
  EXPECT_EQ(sequence.camera().fy_px, 480.0);
  EXPECT_EQ(sequence.stamp_ns(1), 33'333'333);
  EXPECT_EQ(sequence.stamp_ns(2), 66'666'667);
  const RgbdFrame frame = sequence.frame(2, RandomStream());
  EXPECT_EQ(frame.color(7, 5), (Rgb8{10, 20, 32})) << "color and depth are listed the other way";
  EXPECT_EQ(frame.depth_m(7, 5), 1.5F);
  ASSERT_EQ(sequence.truth()->size(), 2U) << "a frame without a pose is not scored";
  EXPECT_EQ(sequence.truth()->front().stamp_ns, sequence.stamp_ns(1));
  EXPECT_EQ(opened.files.size(), 6U);
}

TEST_F(IclNuim, AnotherCameraKeepsTheScaleOfItsDepth) {
  write_truth("1 0 0 -2.25 0 0 0 1\n");
  RecordingConfig config;
  config.calibration = folder_ / "camera.yaml";
  config.read_camera = [](const fs::path&) {
    RecordedCamera camera;
    camera.camera.fx_px = 500;
    camera.depth_per_meter = 1000;
    return camera;
  };
  const OpenedRecording opened = open_sequence("icl_nuim:" + folder_.string(), config);
  EXPECT_EQ(opened.sequence->camera().fx_px, 500);
  EXPECT_EQ(opened.sequence->frame(0, RandomStream()).depth_m(7, 5), 1.5F);
}

// In the renderer's world, y points up and rotations are mirrored: if the renderer's camera moves
// up by 1 m and yaws, ours moves by -1 m along y and yaws about the axis that points down.
TEST_F(IclNuim, PosesAreReflectedIntoTheCamerasFrame) {
  write_truth("0 1 2 3 0.1 0.2 0.3 0.9273618495495704\n");
  const Trajectory truth = *open_sequence("icl_nuim:" + folder_.string(), {}).sequence->truth();
  const SE3& pose = truth.front().world_from_camera;
  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(1, -2, 3), 1e-12));
  const Eigen::Quaterniond turned(0.9273618495495704, -0.1, 0.2, -0.3);
  EXPECT_TRUE(pose.rotation().isApprox(turned.toRotationMatrix(), 1e-9));
  EXPECT_NEAR(pose.rotation().determinant(), 1, 1e-12);
}

TEST_F(IclNuim, FramesWithoutAPoseAreCounted) {
  write_truth("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  const OpenedRecording opened = open_sequence("icl_nuim:" + folder_.string(), {});
  EXPECT_EQ(opened.sequence->size(), 3U);
  ASSERT_EQ(opened.notes.size(), 1U);
  EXPECT_NE(opened.notes[0].find("1 of 3 frames have no pose"), std::string::npos)
      << opened.notes[0];
}

TEST_F(IclNuim, ALineThatIsNoPoseCostsItsFrameTheTruth) {
  write_truth("0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n2 1e300 0 0 0 0 0 1\n");
  const OpenedRecording opened = open_sequence("icl_nuim:" + folder_.string(), {});
  EXPECT_EQ(opened.sequence->truth()->size(), 1U);
  ASSERT_FALSE(opened.notes.empty());
  EXPECT_NE(opened.notes[0].find("2 of 3 poses are left out"), std::string::npos)
      << opened.notes[0];
  EXPECT_NE(opened.notes[0].find("in line 2: tx: 'nan'"), std::string::npos) << opened.notes[0];
}

TEST_F(IclNuim, RefusesAFolderWithoutOneTruth) {
  EXPECT_NE(complaint().find("holds 0 .gt.freiburg files, one is needed"), std::string::npos)
      << complaint();
  write_truth("0 0 0 0 0 0 0 1\n");
  write_truth("0 0 0 0 0 0 0 1\n", "livingRoom1");
  EXPECT_NE(complaint().find("holds 2 .gt.freiburg files"), std::string::npos) << complaint();
}

}  // namespace
}  // namespace mh
