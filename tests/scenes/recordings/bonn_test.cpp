// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/tum_folder.hpp"
#include "slam/io/read_record.hpp"
#include "tests/scenes/recordings/made_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Three frames in the layout of the data set.
class Bonn : public MadeFolder {
 protected:
  Bonn() {
    Camera camera;
    TumWriter writer(folder_ / kName, camera);
    for (int i = 0; i < 3; ++i)
      writer.add({i * 33'333'333LL,
                  Grid2d<Rgb8>(640, 480, Rgb8{1, 2, static_cast<std::uint8_t>(3 + i)}),
                  Grid2d<float>(640, 480, 1.5F),
                  {}});
    writer.finish();
    for (const char* not_there : {"camera.yaml", "camera_info.yaml", "associations.txt"})
      fs::remove(folder_ / kName / not_there);
    write_truth("0 0 0 0 0 0 0 1\n0.01 1 2 3 0 0 0 1\n0.02 0 0 0 0 0 1 0\n");
  }
  void write_truth(const std::string& text) const {
    write("rgbd_bonn_balloon/groundtruth.txt", text);
  }
  OpenedRecording open() const { return open_sequence((folder_ / kName).string() + "/", {}); }

  static constexpr const char* kName = "rgbd_bonn_balloon";
};

TEST_F(Bonn, IsRecognizedByItsNameAndHasThePublishedCamera) {
  const OpenedRecording opened = open();
  const Camera& camera = opened.sequence->camera();
  EXPECT_EQ(opened.sequence->size(), 3U);
  EXPECT_EQ(camera.fx_px, 542.822841);
  EXPECT_EQ(camera.cy_px, 237.756098);
  EXPECT_EQ(camera.distortion.k2, -0.099343);
  EXPECT_EQ(camera.distortion.p1, -0.000730);
  const RgbdFrame frame = opened.sequence->frame(2, RandomStream());
  EXPECT_EQ(frame.color(5, 5), (Rgb8{1, 2, 5}));
  EXPECT_EQ(frame.depth_m(5, 5), 1.5F);
  write("rgbd_bonn_balloon/camera.yaml", "");
  EXPECT_STREQ(reader_of((folder_ / kName).string()).name, "tum") << "somebody's own calibration";
}

// world_from_camera = T_ros T T_ros T_m, as the page of the data set defines it.
TEST_F(Bonn, TheMarkersTruthIsMovedToTheCamera) {
  const Trajectory truth = *open().sequence->truth();
  ASSERT_EQ(truth.size(), 3U);
  Eigen::Matrix3d published;
  published << 1.0157, 0.1828, -0.2389, 0.0009, -0.8431, -0.6413, -0.3009, 0.6147, -0.8085;
  const Eigen::Vector3d place_m(0.0113, -0.0098, 0.0111);
  const SE3& first = truth[0].world_from_camera;
  EXPECT_TRUE(first.rotation().isUnitary(1e-12));
  EXPECT_NEAR(first.rotation().determinant(), 1, 1e-12);
  // The published numbers have four decimals.
  EXPECT_TRUE((1.0593 * first.rotation()).isApprox(published, 2e-4));
  EXPECT_TRUE(first.translation().isApprox(place_m, 1e-12));
  EXPECT_TRUE(truth[1].world_from_camera.translation().isApprox(Eigen::Vector3d(-1, 3, 2) + place_m,
                                                                1e-12));
  // Half a turn about z in the file is half a turn about y in the scan.
  const Eigen::DiagonalMatrix<double, 3> half_turn(-1, 1, -1);
  EXPECT_TRUE(truth[2].world_from_camera.rotation().isApprox(
      half_turn.toDenseMatrix() * first.rotation(), 1e-12));
  EXPECT_TRUE(truth[2].world_from_camera.translation().isApprox(half_turn * place_m, 1e-12));
}

TEST_F(Bonn, LinesThatAreNoPoseAreCounted) {
  write_truth("0 0 0 0 0 0 0 1\n0.01 nan 0 0 0 0 0 1\n0.02 0 0 0\n");
  const OpenedRecording opened = open();
  EXPECT_EQ(opened.sequence->truth()->size(), 1U);
  std::string notes;
  for (const std::string& note : opened.notes) notes += note + "\n";
  EXPECT_NE(notes.find("groundtruth.txt: 2 of 3 poses are left out"), std::string::npos) << notes;
  EXPECT_NE(notes.find("the first in line 2: tx"), std::string::npos) << notes;
  write_truth("0.01 nan 0 0 0 0 0 1\n");
  EXPECT_EQ(open().sequence->truth(), nullptr);
  EXPECT_NE(open().notes.back().find("groundtruth.txt: holds no pose"), std::string::npos);
  fs::remove(folder_ / kName / "groundtruth.txt");
  fs::create_directories(folder_ / kName / "groundtruth.txt");
  ASSERT_FALSE(open().notes.empty());
  EXPECT_NE(open().notes.back().find("groundtruth.txt: is not a file"), std::string::npos);
  fs::remove(folder_ / kName / "rgb.txt");
  EXPECT_NE(complaint("bonn", kName).find("rgb.txt"), std::string::npos);
}

TEST_F(Bonn, EveryFileIsOfTheRecording) {
  const auto key = [&] {
    const ReadScope scope;
    open();
    return digest(scope.record());
  };
  const std::uint64_t first = key();
  EXPECT_EQ(key(), first);
  write_truth("0 0 0 0 0 0 0 1\n");
  EXPECT_NE(key(), first);
}

}  // namespace
}  // namespace mh
