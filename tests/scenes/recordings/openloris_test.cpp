// SPDX-License-Identifier: Apache-2.0
#include "scenes/image_file.hpp"
#include "scenes/recordings/images/png.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "slam/io/read_record.hpp"
#include "tests/scenes/recordings/made_folder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A package of a sequence with small images; the camera looks forward, its base moves on a floor.
class Openloris : public MadeFolder {
 protected:
  Openloris() {
    camera_.width_px = 84;
    camera_.height_px = 48;
    camera_.fx_px = 61.1;
    camera_.fy_px = 61.2;
    camera_.cx_px = 43.3;
    camera_.cy_px = 24.9;
    write("sensors.yaml", sensors("61.1, 43.3, 61.2, 24.9"));
    // As on the robot, the camera is attached to a laser, and the laser to the base.
    const SE3 base_from_laser(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.1, 0, 0.2));
    write("trans_matrix.yaml", "%YAML:1.0\n---\ntrans_matrix:\n" +
                                   transform("laser", "d400_color_optical_frame",
                                             base_from_laser.inverse() * base_from_color()) +
                                   transform("base_link", "laser", base_from_laser));
    std::string color = "#Timestamp [s] color image path\n", depth = color, truth = "#Time px\n";
    for (int i = 0; i < 3; ++i) {
      const std::string stamp = fmt::format("1560004885.{}", 400000 + 33333 * i);
      write("color/" + stamp + ".png", encode_png(color_image(Grid2d<Rgb8>(
                                           84, 48, Rgb8{9, 8, static_cast<std::uint8_t>(7 + i)}))));
      write("aligned_depth/" + stamp + ".png",
            encode_png(
                WallAndSquare::depth_image(camera_, world_from_base(i) * base_from_color(), 1000)));
      color += fmt::format("{0} color/{0}.png\n", stamp);
      depth += fmt::format("1560004885.{} aligned_depth/{}.png\n", 399990 + 33333 * i, stamp);
      const SE3 pose = world_from_base(i);
      const Eigen::Quaterniond q = pose.quaternion();
      truth +=
          fmt::format("{} {} {} {} {} {} {} {}\n", stamp, pose.translation().x(),
                      pose.translation().y(), pose.translation().z(), q.x(), q.y(), q.z(), q.w());
    }
    write("color.txt", color);
    write("aligned_depth.txt", depth);
    write("groundtruth.txt", truth);
  }
  static std::string sensors(const std::string& intrinsics) {
    return "%YAML:1.0\n---\nd400_color_optical_frame:\n   sensor_type: camera\n   fps: 30\n"
           "   width: 84\n   height: 48\n   model: pinhole\n   intrinsics: !!opencv-matrix\n"
           "      rows: 1\n      cols: 4\n      dt: d\n      data: [ " +
           intrinsics +
           " ]\n   distortion_model: \"radial-tangential\"\n"
           "   distortion_coefficients: !!opencv-matrix\n      rows: 1\n      cols: 5\n"
           "      dt: d\n      data: [ 0., 0., 0., 0.,\n          0. ]\n"
           "odometer:\n   fps: 0\n";
  }
  static std::string transform(const std::string& parent, const std::string& child,
                               const SE3& pose) {
    std::string data;
    for (int row = 0; row < 3; ++row)
      data +=
          fmt::format("{}, {}, {},\n          {}, ", pose.rotation()(row, 0),
                      pose.rotation()(row, 1), pose.rotation()(row, 2), pose.translation()[row]);
    return fmt::format(
        "   -\n      parent_frame: {}\n      child_frame: {}\n      matrix: !!opencv-matrix\n"
        "         rows: 4\n         cols: 4\n         dt: d\n"
        "         data: [ {}0., 0., 0., 1. ]\n",
        parent, child, data);
  }
  /// The base's z points up and its x forward; the camera looks along the base's x.
  static SE3 base_from_color() {
    Eigen::Matrix3d rotation;
    rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return {rotation, Eigen::Vector3d(0.23, -0.05, 0.9)};
  }
  /// The wall of the test is at z = 3 in the world: the base drives toward it.
  static SE3 world_from_base(int frame) {
    Eigen::Matrix3d rotation;
    rotation << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    return {rotation, Eigen::Vector3d(0.0, 0.9, 0.05 * frame)};
  }
  OpenedRecording open() const { return open_sequence(folder_.string(), {}); }

  Camera camera_;
};

TEST_F(Openloris, TheBasesTruthIsMovedToTheCamera) {
  const OpenedRecording opened = open();
  const Sequence& sequence = *opened.sequence;
  EXPECT_TRUE(opened.notes.empty()) << opened.notes[0];
  ASSERT_EQ(sequence.size(), 3U);
  EXPECT_EQ(opened.files.size(), 6U);
  EXPECT_EQ(sequence.camera().fy_px, 61.2) << "listed as fx, cx, fy, cy";
  EXPECT_EQ(sequence.camera().cx_px, 43.3);
  EXPECT_TRUE(sequence.camera().distortion.none());
  EXPECT_EQ(sequence.stamp_ns(0), 1'560'004'885'400'000'000);
  const RgbdFrame frame = sequence.frame(2, RandomStream());
  EXPECT_EQ(frame.color(3, 3), (Rgb8{9, 8, 9}));
  const SE3& pose = sequence.truth()->at(2).world_from_camera;
  int on_square = 0;
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 84; ++u) {
      const double z = (pose * sequence.camera().unproject(u, v, frame.depth_m(u, v))).z();
      on_square += z < 2 ? 1 : 0;
      EXPECT_NEAR(z, z < 2 ? WallAndSquare::kSquare_m : WallAndSquare::kWall_m, 6e-4);
    }
  EXPECT_GT(on_square, 300);
}

// Numbers from the tools' repository for the robot of office, corridor, cafe and home: the poses of
// its color and depth cameras. trans_matrix.yaml of cafe1-1 has -3.5019440527251228e-03 in row 2,
// column 3 of (color, depth), so a matrix gives the pose of the child in its parent.
TEST_F(Openloris, AMatrixPlacesTheChildInItsParent) {
  const SE3 base_from_color(Eigen::Quaterniond(0.5081504289345848, -0.49676229968284136,
                                               0.4998795887129771, -0.49510681269354095),
                            Eigen::Vector3d(0.2264836849091656, -0.05114194035652147, 0.916));
  const SE3 base_from_depth(
      Eigen::Quaterniond(0.5065982108450463, -0.49538006860636935, 0.49954735142309487,
                         -0.49840674562280746),
      Eigen::Vector3d(0.22722047136786871, -0.06601512576001335, 0.9157872415132173));
  const SE3 color_from_depth = base_from_color.inverse() * base_from_depth;
  EXPECT_NEAR(color_from_depth.rotation()(1, 2), -3.5019440527251228e-03, 1e-15);
  write("trans_matrix.yaml",
        "%YAML:1.0\ntrans_matrix:\n" +
            transform("d400_color_optical_frame", "d400_depth_optical_frame", color_from_depth) +
            transform("base_link", "d400_depth_optical_frame", base_from_depth));
  write("groundtruth.txt", "1560004885.4 0 0 0 0 0 0 1\n");
  const auto opened = open();
  const SE3& found = opened.sequence->truth()->front().world_from_camera;
  EXPECT_TRUE(found.translation().isApprox(base_from_color.translation(), 1e-9));
  EXPECT_TRUE(found.rotation().isApprox(base_from_color.rotation(), 1e-9));
}

TEST_F(Openloris, WhatCannotBeUsedIsCounted) {
  write("groundtruth.txt",
        "1560004885.4 0 0 0 0 0 0 1\n1560004885.4 0 0 0 0 0 0 1\n"
        "1560004885.5 nan 0 0 0 0 0 1\n1560004885.6 0 0 0\n1560004885.7 0 0 0 0 0 0 1\n");
  write("aligned_depth.txt", "1560004885.4 aligned_depth/1560004885.400000.png\n");
  const OpenedRecording opened = open();
  EXPECT_EQ(opened.sequence->size(), 1U);
  EXPECT_EQ(opened.sequence->truth()->size(), 2U);
  ASSERT_EQ(opened.notes.size(), 2U);
  EXPECT_NE(opened.notes[0].find("2 of 3 color images have no depth image"), std::string::npos);
  EXPECT_NE(opened.notes[1].find("groundtruth.txt: 3 of 5 poses are left out"), std::string::npos)
      << opened.notes[1];
  fs::remove(folder_ / "trans_matrix.yaml");
  EXPECT_EQ(open().sequence->truth(), nullptr);
  EXPECT_NE(open().notes.back().find("trans_matrix.yaml: is missing"), std::string::npos);
}

TEST_F(Openloris, BadCalibrationIsNamed) {
  write("sensors.yaml", sensors("61.1, 43.3, 61.2"));
  EXPECT_NE(complaint("openloris").find("sensors.yaml:"), std::string::npos);
  write("sensors.yaml", sensors("61.1, 61.2, 43.3, 249"));
  EXPECT_NE(complaint("openloris").find("sensors.yaml:"), std::string::npos)
      << complaint("openloris");
  const std::string fisheye = sensors("61.1, 43.3, 61.2, 24.9");
  const std::string usual = "radial-tangential";
  for (const char* other : {"equidistant", "Kannala-Brandt"}) {
    std::string foreign = fisheye;
    foreign.replace(foreign.find(usual), usual.size(), other);
    write("sensors.yaml", foreign);
    EXPECT_NE(complaint("openloris").find(fmt::format("'{}' is not supported", other)),
              std::string::npos)
        << complaint("openloris");
  }
  write("sensors.yaml", "%YAML:1.0\nother:\n   a: 1\n");
  EXPECT_NE(complaint("openloris").find("d400_color_optical_frame"), std::string::npos);
  write("sensors.yaml", sensors("61.1, 43.3, 61.2, 24.9"));
  write("trans_matrix.yaml", "trans_matrix:\n" + transform("base_link", "laser", SE3()));
  EXPECT_NE(
      complaint("openloris").find("trans_matrix.yaml: does not connect d400_color_optical_frame"),
      std::string::npos)
      << complaint("openloris");
  write("trans_matrix.yaml",
        "trans_matrix:\n   -\n      parent_frame: base_link\n      child_frame: x\n"
        "      matrix:\n         data: [1, 2, 3]\n");
  EXPECT_NE(complaint("openloris").find("trans_matrix.yaml:6"), std::string::npos)
      << complaint("openloris");
}

TEST_F(Openloris, EveryFileIsOfTheRecording) {
  const auto key = [&] {
    const ReadScope scope;
    open();
    return digest(scope.record());
  };
  const std::uint64_t first = key();
  EXPECT_EQ(key(), first);
  write("trans_matrix.yaml",
        "trans_matrix:\n" + transform("base_link", "d400_color_optical_frame", SE3()));
  EXPECT_NE(key(), first);
}

}  // namespace
}  // namespace mh
