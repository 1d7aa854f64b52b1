// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/shared_exposures.hpp"

#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "sim/simulation/simulated_sequence.hpp"
#include "slam/io/temporary_folder.hpp"
#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFrames = 12;
constexpr std::uint64_t kMuch = std::uint64_t{1} << 40;

Camera tiny_camera() {
  Camera camera;
  camera.width_px = 37, camera.height_px = 23;
  return camera;
}

/// An exposure full of values that a careless copy would change.
Shutter::Exposed some_exposure(std::size_t frame) {
  const Camera camera = tiny_camera();
  const RandomStream stream = RandomStream(5).fork(frame);
  Shutter::Exposed made;
  made.gain = stream.uniform(1) / 3;
  made.seen = {.color = {camera.width_px, camera.height_px},
               .depth_m = {camera.width_px, camera.height_px},
               .classes = {camera.width_px, camera.height_px},
               .instances = {camera.width_px, camera.height_px},
               .exposure = static_cast<float>(stream.uniform(2))};
  for (std::size_t i = 0; i < made.seen.color.size(); ++i) {
    const std::uint64_t bits = stream.bits(i);
    made.seen.color.data()[i] = {static_cast<std::uint8_t>(bits),
                                 static_cast<std::uint8_t>(bits >> 8), 0};
    made.seen.depth_m.data()[i] = i % 7 == 0 ? std::numeric_limits<float>::denorm_min() * 3
                                             : static_cast<float>(stream.uniform(i)) / 3;
    made.seen.classes.data()[i] = static_cast<ClassId>(i / 11 % 3);
    made.seen.instances.data()[i] = static_cast<InstanceId>(i < 400 ? 65535 : i / 50);
  }
  return made;
}

void expect_equal(const Shutter::Exposed& a, const Shutter::Exposed& b) {
  EXPECT_EQ(a.gain, b.gain);
  EXPECT_EQ(a.seen.exposure, b.seen.exposure);
  EXPECT_EQ(a.seen.color, b.seen.color);
  EXPECT_EQ(a.seen.depth_m, b.seen.depth_m);
  EXPECT_EQ(a.seen.classes, b.seen.classes);
  EXPECT_EQ(a.seen.instances, b.seen.instances);
}

class SharedExposuresFolder : public testing::Test {
 protected:
  /// Opens the file as a separate process would.
  std::unique_ptr<SharedExposures> open(std::uint64_t limit_bytes = kMuch) {
    return std::make_unique<SharedExposures>(SharedImages{folder(), limit_bytes}, "path",
                                             tiny_camera(), kFrames);
  }
  /// Gets every frame and expects the right ones. @returns how many were made
  int get_all(SharedExposures& shared) {
    int made = 0;
    for (std::size_t i = 0; i < kFrames; ++i)
      expect_equal(shared.get(i,
                              [&](std::size_t k) {
                                ++made;
                                return some_exposure(k);
                              }),
                   some_exposure(i));
    return made;
  }
  fs::path folder() const { return place_.path() / "images"; }
  fs::path file() const { return folder() / "path"; }

  TemporaryFolder place_{fs::temp_directory_path()};
};

TEST_F(SharedExposuresFolder, OneMakesTheOthersRead) {
  EXPECT_EQ(get_all(*open()), static_cast<int>(kFrames));
  const auto another = open();
  EXPECT_EQ(get_all(*another), 0);
  EXPECT_EQ(get_all(*another), 0);
}

TEST_F(SharedExposuresFolder, WhatIsDamagedOrCutIsMadeAgain) {
  get_all(*open());
  const auto bytes = fs::file_size(file());
  for (const std::uintmax_t at : {bytes / 2, bytes - 1, std::uintmax_t{25}, std::uintmax_t{40}}) {
    std::fstream content(file(), std::ios::in | std::ios::out | std::ios::binary);
    content.seekg(static_cast<std::streamoff>(at));
    const char was = static_cast<char>(content.get());
    content.seekp(static_cast<std::streamoff>(at));
    content.put(static_cast<char>(was ^ 0x10));
    content.close();
    EXPECT_EQ(get_all(*open()), 1) << at;
    EXPECT_EQ(get_all(*open()), 0) << at;
  }
  fs::resize_file(file(), bytes / 2);
  EXPECT_GT(get_all(*open()), 1);
  EXPECT_EQ(get_all(*open()), 0);
  fs::resize_file(file(), 10);
  EXPECT_EQ(get_all(*open()), static_cast<int>(kFrames));
  std::ofstream(file(), std::ios::binary) << std::string(bytes, '\xFF');
  EXPECT_EQ(get_all(*open()), static_cast<int>(kFrames));
}

TEST_F(SharedExposuresFolder, NothingIsWrittenBeyondTheLimit) {
  get_all(*open());
  const auto whole = fs::file_size(file());
  fs::remove(file());
  get_all(*open(whole / 2));
  EXPECT_LE(fs::file_size(file()), whole / 2 + whole / kFrames);
  EXPECT_GT(fs::file_size(file()), whole / 4);
  const int made = get_all(*open(whole / 2));
  EXPECT_GT(made, static_cast<int>(kFrames / 4));
  EXPECT_LT(made, static_cast<int>(3 * kFrames / 4));
  fs::remove(file());
  EXPECT_EQ(get_all(*open(0)), static_cast<int>(kFrames));
  EXPECT_EQ(get_all(*open(0)), static_cast<int>(kFrames));
}

TEST_F(SharedExposuresFolder, AFolderThatCannotBeWrittenCostsOnlyTime) {
  std::ofstream(folder()) << "a file";
  EXPECT_EQ(get_all(*open()), static_cast<int>(kFrames));
}

TEST_F(SharedExposuresFolder, AFullDiskCostsOnlyTimeAndGivesTheRoomBack) {
  get_all(*open());
  const auto whole = fs::file_size(file());
  fs::remove(file());
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit half{.rlim_cur = whole / 2 + 11, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &half);
  const int made = get_all(*open());
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old);
  EXPECT_EQ(made, static_cast<int>(kFrames));
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_EQ(get_all(*open()), static_cast<int>(kFrames));
  EXPECT_EQ(get_all(*open()), 0);
}

TEST_F(SharedExposuresFolder, SeveralAtOnceMakeEachFrameOnce) {
  std::atomic<int> made = 0;
  std::vector<std::jthread> processes;
  for (int p = 0; p < 3; ++p)
    processes.emplace_back([&] {
      const auto shared = open();
      for (std::size_t i = 0; i < kFrames; ++i) {
        const Shutter::Exposed exposed = shared->get(i, [&](std::size_t k) {
          ++made;
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
          return some_exposure(k);
        });
        expect_equal(exposed, some_exposure(i));
      }
    });
  processes.clear();
  EXPECT_EQ(made, static_cast<int>(kFrames));
}

TEST_F(SharedExposuresFolder, AFrameThatCouldNotBeMadeIsLeftToTheOthers) {
  const auto one = open(), another = open();
  EXPECT_THROW(one->get(3, [](std::size_t) -> Shutter::Exposed { throw std::runtime_error(""); }),
               std::runtime_error);
  EXPECT_EQ(get_all(*another), static_cast<int>(kFrames));
  EXPECT_EQ(get_all(*one), 0);
}

// A path past two walls under a rolling shutter, where annotated labels differ from exact ones.
SimulatedSequence moving_past_walls(LabelMode labels) {
  Scene scene = test::plain_scene({120, 120, 120});
  test::add_quad(scene, {-9, -9, 3}, {9.1F, 0, 0}, {0, 18, 0}, 5, 1);
  test::add_quad(scene, {0.1F, -9, 4}, {18, 0, 0}, {0, 18, 0}, 7, 2);
  std::vector<TimedPose> path;
  for (int i = 0; i < 4; ++i)
    path.push_back({33'000'000 * i, SE3(Eigen::Matrix3d::Identity(), {0.05 * i, 0, 0})});
  SensorConfig sensors;
  sensors.rolling_shutter.enabled = sensors.motion_blur.enabled = true;
  sensors.auto_exposure.enabled = true;
  sensors.depth_noise.enabled = sensors.shot_noise.enabled = true;
  return {make_embree_renderer(scene), Camera{}, path, sensors, labels};
}

TEST(SimulatedSequence, SharedImagesAreThoseOfASequenceOfItsOwn) {
  const TemporaryFolder folder(fs::temp_directory_path());
  for (int turn = 0; turn < 2; ++turn)
    for (const LabelMode labels : {LabelMode::kNone, LabelMode::kExact, LabelMode::kAnnotated}) {
      SimulatedSequence shared = moving_past_walls(labels);
      shared.share({folder.path() / "images", kMuch, {RandomStream(1), RandomStream(3)}},
                   "mapping");
      const SimulatedSequence alone = moving_past_walls(labels);
      for (const std::size_t i : {1, 2}) {
        const RandomStream noise(static_cast<std::uint64_t>(turn));
        const RgbdFrame a = shared.frame(i, noise), b = alone.frame(i, noise);
        EXPECT_EQ(a.color, b.color);
        EXPECT_EQ(a.depth_m, b.depth_m);
        EXPECT_EQ(a.semantics.index, b.semantics.index);
      }
    }
  EXPECT_NE(moving_past_walls(LabelMode::kExact).frame(2, RandomStream(1)).semantics.index,
            moving_past_walls(LabelMode::kAnnotated).frame(2, RandomStream(1)).semantics.index);
}

TEST(SimulatedSequence, LeavesFramesWithTheSharedNoisesOnly) {
  const TemporaryFolder folder(fs::temp_directory_path());
  const SharedImages images{folder.path() / "images", kMuch, {RandomStream(1), RandomStream(3)}};
  SimulatedSequence sequence = moving_past_walls(LabelMode::kExact);
  sequence.share(images, "mapping");
  const RgbdFrame left = sequence.frame(1, RandomStream(1));
  const RgbdFrame other = sequence.frame(2, RandomStream(2));
  EXPECT_NE(left.depth_m, sequence.frame(1, RandomStream(2)).depth_m);
  EXPECT_NE(left.depth_m, sequence.frame(1, RandomStream(3)).depth_m);

  int made = 0;
  const auto make = [&](std::size_t) {
    ++made;
    return Shutter::Exposed{.seen = {.color = other.color,
                                     .depth_m = other.depth_m,
                                     .classes = {other.color.width(), other.color.height()},
                                     .instances = {other.color.width(), other.color.height()}}};
  };
  SharedExposures file(images, folder_of(images.noises) + "/mapping-0", sequence.camera(),
                       sequence.size());
  const RenderedFrame found = file.get(1, make).seen;
  EXPECT_EQ(made, 0);
  EXPECT_EQ(found.color, left.color);
  EXPECT_EQ(found.depth_m, left.depth_m);
  file.get(2, make);
  EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace mh
