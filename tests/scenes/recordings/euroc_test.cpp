// SPDX-License-Identifier: Apache-2.0
#include "scenes/recordings/euroc.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <opencv2/imgcodecs.hpp>

#include "sim/sensors/imu.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class Euroc : public testing::Test {
 protected:
  Euroc() {
    camera_.width_px = 64, camera_.height_px = 48;
    camera_.fx_px = camera_.fy_px = 52, camera_.cx_px = 31.5, camera_.cy_px = 23.5;
    for (int i = 0; i < 4; ++i)
      path_.push_back({1'000'000'000 + 33'333'333 * i,
                       {Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.1 * i, 0, 1)}});
  }
  ~Euroc() override { fs::remove_all(folder_); }
  ExactFrame frame(std::size_t i) const {
    ExactFrame made;
    made.seen.stamp_ns = path_[i].stamp_ns;
    made.seen.color = Grid2d<Rgb8>(64, 48, {10, 200, static_cast<std::uint8_t>(i)});
    made.world_from_camera = path_[i].world_from_camera;
    return made;
  }
  const fs::path folder_ = fs::temp_directory_path() / ("mh_euroc_" + std::to_string(::getpid()));
  Camera camera_;
  Trajectory path_;
};

TEST_F(Euroc, WritesACameraAsTheDataSetHasIt) {
  EurocCameraWriter writer(folder_, 1, 0.11, camera_);
  writer.add(1, frame(1));
  writer.add(0, frame(0));
  writer.finish();
  const fs::path cam = folder_ / "mav0/cam1";
  EXPECT_EQ(read_file(cam / "data.csv"),
            "#timestamp [ns],filename\n1000000000,1000000000.png\n1033333333,1033333333.png\n");
  const cv::Mat image = cv::imread(cam / "data/1033333333.png", cv::IMREAD_UNCHANGED);
  ASSERT_EQ(image.type(), CV_8UC1);
  EXPECT_EQ(image.size(), cv::Size(64, 48));
  EXPECT_EQ(image.at<std::uint8_t>(7, 9), 121);  // 0.299 * 10 + 0.587 * 200 + 0.114 * 1
  const std::string sensor = read_file(cam / "sensor.yaml");
  for (const char* line :
       {"sensor_type: camera\n", "resolution: [64, 48]\n", "camera_model: pinhole\n",
        "data: [1.0, 0.0, 0.0, 0.110000,", "intrinsics: [52.0000000000, 52.0000000000, 31.5",
        "distortion_model: radial-tangential\n"})
    EXPECT_NE(sensor.find(line), std::string::npos) << line << sensor;
  // An image that exists already is not written again.
  EurocCameraWriter again(folder_, 1, 0.11, camera_);
  EXPECT_TRUE(again.resume(0, path_[0].stamp_ns, path_[0].world_from_camera));
  EXPECT_FALSE(again.resume(2, path_[2].stamp_ns, path_[2].world_from_camera));
  EXPECT_EQ(again.truth().size(), 1U);
}

TEST_F(Euroc, ReadsReadingsAndCountsWhatItLeavesOut) {
  fs::create_directories(folder_);
  const fs::path file = folder_ / "imu.csv";
  std::vector<std::string> notes;
  const auto read = [&](const std::string& text) {
    notes.clear();
    write_atomically(file, text);
    return read_euroc_imu(file, notes);
  };
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::vector<ImuReading> two = {
      {1'403'636'580'838'555'648, {0.5, -0.25, 1e-3}, {0, -9.75, 0}},
      {1'403'636'580'843'555'648, {0, 0, 0}, {0, -9.5, 1}}};
  std::string text = fmt::format("{}\r\n", kEurocImuColumns);
  for (const ImuReading& reading : two) text += euroc_line(reading);
  EXPECT_EQ(read(text), two);
  EXPECT_TRUE(notes.empty());
  const std::string dirty = text +
                            "1403636580848555648,nan,0,0,0,-9.8,0\n"
                            "1403636580843555648, 0, 0, 0, 0, -9.8, 0\n";
  EXPECT_EQ(read(dirty), two);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_NE(notes[0].find("1 reading left out: not a number"), std::string::npos) << notes[0];
  EXPECT_NE(notes[1].find("the stamp does not increase"), std::string::npos) << notes[1];
  EXPECT_NE(refusal(text + "1403636580848555648,0,0,0,0,-9.8\n").find("imu.csv:4: "),
            std::string::npos);
  EXPECT_NE(refusal("1.5,0,0,0,0,-9.8,0\n").find("'1.5' does not begin with a stamp in ns"),
            std::string::npos);
  EXPECT_NE(refusal("10,0,0,0,0,-1.01,0\n")
                .find("1.01 on average, not near 9.81 m/s^2: they are "
                      "in units of g"),
            std::string::npos);
  EXPECT_NE(refusal("10,0,0,0,0,-98,0\n").find("98 on average"), std::string::npos);
  EXPECT_NE(refusal("# nothing\n").find("holds no reading"), std::string::npos);
}

TEST_F(Euroc, RefusesALensThatTheLayoutCannotHold) {
  camera_.distortion.k3 = 0.1;
  try {
    EurocCameraWriter writer(folder_, 0, 0, camera_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("k3 0.1"), std::string::npos) << error.what();
  }
}

TEST_F(Euroc, WritesReadingsAndStates) {
  const ImuConfig config{.gyro_noise = 0,
                         .gyro_walk = 0,
                         .gyro_bias = 0,
                         .accel_noise = 0,
                         .accel_walk = 0,
                         .accel_bias = 0};
  write_euroc_states(folder_, {path_[0], path_[2]}, path_,
                     imu_along(path_, config, RandomStream(1)), {200, 0.25, 0, 0.5, 0});
  const std::string readings = read_file(folder_ / "mav0/imu0/data.csv");
  EXPECT_EQ(readings.substr(0, readings.find('\n')), kEurocImuColumns);
  EXPECT_EQ(std::count(readings.begin(), readings.end(), '\n'),
            1 + 20);  // 0.1 s of readings from the start
  EXPECT_NE(readings.find("\n1005000000,"), std::string::npos);
  EXPECT_NE(read_file(folder_ / "mav0/imu0/sensor.yaml").find("gyroscope_noise_density: 0.25"),
            std::string::npos);
  const std::string states = read_file(folder_ / "mav0/state_groundtruth_estimate0/data.csv");
  EXPECT_EQ(std::count(states.begin(), states.end(), '\n'), 3);
  EXPECT_NE(states.find("\n1066666666,0.2,0,1,1,0,0,0,"), std::string::npos) << states;
  EXPECT_EQ(std::count(states.begin(), states.end(), ','), 3 * 16);
}

}  // namespace
}  // namespace mh
