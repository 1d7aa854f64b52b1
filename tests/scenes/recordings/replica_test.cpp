// SPDX-License-Identifier: Apache-2.0
#include "scenes/image_file.hpp"
#include "slam/io/files.hpp"
#include "slam/io/read_record.hpp"
#include "tests/scenes/recordings/made_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A data set with one scene in the layout of NICE-SLAM's archive, with smaller images.
class Replica : public MadeFolder {
 protected:
  Replica() {
    camera_.width_px = 120;
    camera_.height_px = 68;
    camera_.fx_px = camera_.fy_px = 60;
    camera_.cx_px = 59.5;
    camera_.cy_px = 33.5;
    write("cam_params.json",
          R"({"camera": {"w": 120, "h": 68, "fx": 60.0, "fy": 60.0, "cx": 59.5, "cy": 33.5,)"
          R"( "scale": 6553.5}})");
    std::string poses;
    for (int i = 0; i < 3; ++i) {
      write(fmt::format("room0/results/frame{:06}.jpg", i),
            encode_jpeg(Grid2d<Rgb8>(120, 68, Rgb8{200, 100, static_cast<std::uint8_t>(50 + i)}),
                        95));
      write(fmt::format("room0/results/depth{:06}.png", i),
            encode_png(WallAndSquare::depth_image(camera_, world_from_camera(i), 6553.5)));
      poses += matrix_text(world_from_camera(i), " ");
    }
    write("room0/traj.txt", poses);
  }
  static SE3 world_from_camera(int frame) {
    return {so3_exp({0.1, -0.1 * frame, 0.05}), Eigen::Vector3d(0.1 * frame, 0.1, 0.3)};
  }
  OpenedRecording open() const { return open_sequence((folder_ / "room0").string(), {}); }

  Camera camera_;
};

// The camera looks along z, and its pixels and depths agree: each point is on the wall or the
// square.
TEST_F(Replica, PosesAndDepthAgree) {
  const OpenedRecording opened = open();
  const Sequence& sequence = *opened.sequence;
  ASSERT_EQ(sequence.size(), 3U);
  EXPECT_TRUE(opened.notes.empty());
  EXPECT_EQ(opened.files.size(), 6U);
  EXPECT_EQ(sequence.camera().cx_px, 59.5);
  EXPECT_EQ(sequence.stamp_ns(2), 66'666'667);
  const RgbdFrame frame = sequence.frame(2, RandomStream());
  EXPECT_NEAR(frame.color(60, 30).r, 200, 3) << "JPEG";
  EXPECT_NEAR(frame.color(60, 30).b, 52, 3);
  const SE3& pose = sequence.truth()->at(2).world_from_camera;
  int on_square = 0;
  for (int v = 0; v < 68; ++v)
    for (int u = 0; u < 120; ++u) {
      const double z = (pose * sequence.camera().unproject(u, v, frame.depth_m(u, v))).z();
      const bool near = z < 2;
      on_square += near ? 1 : 0;
      EXPECT_NEAR(z, near ? WallAndSquare::kSquare_m : WallAndSquare::kWall_m, 2e-4);
    }
  EXPECT_GT(on_square, 500);
}

TEST_F(Replica, BlankLinesAreNoPosesAndSurplusOnesAreTold) {
  const std::string poses = read_file(folder_ / "room0/traj.txt");
  const auto first = poses.find('\n') + 1;
  write("room0/traj.txt", poses.substr(0, first) + "\n \n" + poses.substr(first) +
                              matrix_text(world_from_camera(3), " "));
  const OpenedRecording opened = open();
  ASSERT_EQ(opened.sequence->truth()->size(), 3U);
  EXPECT_TRUE(opened.sequence->truth()->at(2).world_from_camera.translation().isApprox(
      world_from_camera(2).translation(), 1e-9));
  ASSERT_EQ(opened.notes.size(), 1U);
  EXPECT_NE(opened.notes[0].find("holds 4 poses, and the last frame is number 2"),
            std::string::npos)
      << opened.notes[0];
}

TEST_F(Replica, LinesBelongToFramesByNumber) {
  fs::remove(folder_ / "room0/results/frame000001.jpg");
  fs::remove(folder_ / "room0/results/depth000000.png");
  const OpenedRecording opened = open();
  ASSERT_EQ(opened.sequence->size(), 1U);
  EXPECT_TRUE(opened.sequence->truth()->front().world_from_camera.translation().isApprox(
      world_from_camera(2).translation(), 1e-9));
  ASSERT_EQ(opened.notes.size(), 1U);
  EXPECT_NE(opened.notes[0].find("1 of 2 color images have no depth image"), std::string::npos);
}

TEST_F(Replica, BadPosesAreCounted) {
  write("room0/traj.txt", "inf 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n1 0 0\n");
  const OpenedRecording opened = open();
  EXPECT_EQ(opened.sequence->size(), 3U);
  EXPECT_EQ(opened.sequence->truth(), nullptr);
  ASSERT_EQ(opened.notes.size(), 1U);
  EXPECT_NE(opened.notes[0].find("3 of 3 frames have no valid pose"), std::string::npos);
  EXPECT_NE(opened.notes[0].find("traj.txt:1: holds a number that is not finite"),
            std::string::npos);
}

TEST_F(Replica, BadCameraFilesAreNamed) {
  const std::string head = R"({"camera": {"w": 120, "h": 68, "fx": 60, "fy": 60, "cx": 59.5,)";
  write("cam_params.json", head + R"("cy": 33.5}})");
  EXPECT_NE(complaint("replica", "room0").find("cam_params.json: camera: key 'scale' is missing"),
            std::string::npos)
      << complaint("replica", "room0");
  write("cam_params.json", head + R"("cy": 33.5, "scale": "big"}})");
  EXPECT_NE(complaint("replica", "room0").find("scale: \"big\" is not a number between"),
            std::string::npos)
      << complaint("replica", "room0");
  write("cam_params.json", head + R"("cy": 335, "scale": 6553.5}})");
  EXPECT_NE(complaint("replica", "room0").find("cam_params.json: "), std::string::npos);
  write("cam_params.json", head);
  EXPECT_NE(complaint("replica", "room0").find("is not JSON"), std::string::npos);
  fs::remove(folder_ / "cam_params.json");
  EXPECT_NE(complaint("replica", "room0").find("cam_params.json is neither here nor beside"),
            std::string::npos);
}

TEST_F(Replica, ANamedCalibrationKeepsTheScale) {
  const RecordingConfig config{
      .calibration = "mine.yaml", .classes = {}, .read_camera = [&](const fs::path&) {
        return RecordedCamera{.camera = camera_};
      }};
  const auto opened = open_sequence((folder_ / "room0").string(), config);
  EXPECT_NEAR(opened.sequence->frame(0, RandomStream()).depth_m(0, 0),
              open().sequence->frame(0, RandomStream()).depth_m(0, 0), 0);
  fs::remove(folder_ / "cam_params.json");
  EXPECT_EQ(open_sequence((folder_ / "room0").string(), config).sequence->size(), 3U);
}

TEST_F(Replica, EveryFileIsOfTheRecording) {
  const auto key = [&] {
    const ReadScope scope;
    open();
    return digest(scope.record());
  };
  const std::uint64_t first = key();
  EXPECT_EQ(key(), first);
  write("room0/traj.txt", matrix_text(SE3(), " "));
  const std::uint64_t other_truth = key();
  EXPECT_NE(other_truth, first);
  write("cam_params.json",
        R"({"camera": {"w": 120, "h": 68, "fx": 61, "fy": 60, "cx": 59.5, "cy": 33, "scale": 9}})");
  EXPECT_NE(key(), other_truth);
}

}  // namespace
}  // namespace mh
