// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/tum_folder.hpp"
#include "tests/scenes/recordings/made_folder.hpp"

namespace mh {
namespace {

using TruePoses = MadeFolder;

TEST_F(TruePoses, OfATumFolderMayBeEurocCsv) {
  Camera camera;
  camera.width_px = 8;
  camera.height_px = 6;
  camera.cx_px = camera.cy_px = 3;
  TumWriter writer(folder_, camera);
  writer.add({2'000'000'000, Grid2d<Rgb8>(8, 6), Grid2d<float>(8, 6, 1.0F), {}});
  writer.finish();
  const auto truth = [&] {
    const auto read_camera = [&](const std::filesystem::path&) {
      return RecordedCamera{.camera = camera};
    };
    const auto opened = open_sequence(
        folder_.string(), {.calibration = {}, .classes = {}, .read_camera = read_camera});
    const Trajectory* poses = opened.sequence->truth();
    return poses == nullptr ? Trajectory() : *poses;
  };
  EXPECT_TRUE(truth().empty());
  write("groundtruth.csv", "#timestamp, ...\n2000000000,1,2,3,1,0,0,0,9,9\n");
  ASSERT_EQ(truth().size(), 1U);
  EXPECT_EQ(truth()[0].stamp_ns, 2'000'000'000);
  EXPECT_EQ(truth()[0].world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
  write("groundtruth.txt", "2 4 5 6 0 0 0 1\n");
  EXPECT_EQ(truth()[0].world_from_camera.translation(), Eigen::Vector3d(4, 5, 6));
}

}  // namespace
}  // namespace mh
