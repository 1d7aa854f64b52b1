// SPDX-License-Identifier: Apache-2.0
#include "bench/world/frame_studio.hpp"

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "bench/protocol/digest.hpp"
#include "bench/world/lockstep.hpp"

namespace mh {
namespace {

class Stripes : public Renderer {
 public:
  RenderedFrame render(const Camera& camera, const SE3& pose) const override {
    ++pictures;
    const int shift = static_cast<int>(pose.translation().x());
    RenderedFrame f;
    f.colour = Grid2d<Rgb8>(camera.width_px, camera.height_px);
    f.depth_m = Grid2d<float>(camera.width_px, camera.height_px, 1.5F);
    f.classes = Grid2d<ClassId>(camera.width_px, camera.height_px, ClassId{1});
    f.instances = Grid2d<InstanceId>(camera.width_px, camera.height_px, InstanceId{1});
    for (int y = 0; y < camera.height_px; ++y)
      for (int x = 0; x < camera.width_px; ++x) {
        f.colour(x, y) = {static_cast<std::uint8_t>(10 * ((x + shift) % 20)), 100, 50};
        if (x < 20) f.classes(x, y) = 5, f.instances(x, y) = 2;  // a chair
      }
    return f;
  }
  mutable std::atomic<int> pictures = 0;
};

Camera small_camera() {
  Camera camera;
  camera.width_px = 48;
  camera.height_px = 36;
  camera.fx_px = camera.fy_px = 48;
  camera.cx_px = 23.5;
  camera.cy_px = 17.5;
  return camera;
}

std::vector<TimedPose> path(std::size_t frames) {
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < frames; ++i)
    poses.push_back({static_cast<Stamp>(i) * 1000,
                     SE3(Eigen::Matrix3d::Identity(), {static_cast<double>(i), 0, 0})});
  return poses;
}

TEST(FrameStudio, ASharedPictureWithLabelsIsTheFrameThatTheSensorWouldGive) {
  const auto renderer = std::make_shared<Stripes>();
  const Camera camera = small_camera();
  FrameStudio studio(renderer, camera, path(5), {});
  const RandomStream noise(3);
  for (const LabelMode mode : {LabelMode::kNone, LabelMode::kExact, LabelMode::kBoxes}) {
    const RenderedFrame exact = renderer->render(camera, studio.path()[2].world_from_camera);
    RgbdFrame direct = sense(exact, camera, {}, noise.fork(2), studio.path()[2].stamp_ns);
    direct.semantics = label_image(exact, mode);
    EXPECT_EQ(digest(studio.frame(2, noise, mode)), digest(direct)) << static_cast<int>(mode);
  }
  EXPECT_NE(digest(studio.frame(2, noise, LabelMode::kExact)),
            digest(studio.frame(2, noise, LabelMode::kNone)));
  EXPECT_NE(digest(studio.frame(2, RandomStream(4), LabelMode::kNone)),
            digest(studio.frame(2, noise, LabelMode::kNone)));
}

TEST(FrameStudio, RendersOnceWhatIsAskedForAgainAndForgetsTheOldest) {
  const auto renderer = std::make_shared<Stripes>();
  FrameStudio studio(renderer, small_camera(), path(10), {}, 4);
  const RandomStream noise(3);
  for (std::size_t i = 0; i < 4; ++i) studio.frame(i, noise, LabelMode::kNone);
  for (std::size_t i = 0; i < 4; ++i) studio.frame(i, noise, LabelMode::kExact);
  EXPECT_EQ(renderer->pictures, 4);
  const std::uint64_t first = digest(studio.frame(0, noise, LabelMode::kNone));
  studio.frame(4, noise, LabelMode::kNone);  // frame 0 is the oldest and goes
  EXPECT_EQ(digest(studio.frame(0, noise, LabelMode::kNone)), first);
  EXPECT_EQ(renderer->pictures, 6);
}

TEST(Lockstep, KeepsRunsWithinTheWindowAndNeverMoreAtWorkThanJobs) {
  constexpr std::size_t kRuns = 5, kSteps = 200, kWindow = 3;
  constexpr int kJobs = 2;
  Lockstep lockstep(kRuns, kJobs, kWindow);
  std::atomic<int> at_work = 0, most = 0;
  std::atomic<std::size_t> position[kRuns] = {};
  std::atomic<bool> too_far = false;
  {
    std::vector<std::jthread> threads;
    for (std::size_t run = 0; run < kRuns; ++run)
      threads.emplace_back([&, run] {
        lockstep.start(run);
        for (std::size_t step = 0; step < kSteps; ++step) {
          lockstep.advance(run, step);
          const int now = ++at_work;
          for (int m = most; now > m && !most.compare_exchange_weak(m, now);) {
          }
          position[run] = step;
          for (const auto& other : position)
            if (step > other + kWindow + 1) too_far = true;
          --at_work;
        }
        position[run] = SIZE_MAX / 2;
        lockstep.finish(run);
      });
  }
  EXPECT_LE(most, kJobs);
  EXPECT_FALSE(too_far);
}

TEST(Lockstep, ARunThatGoesBackIsWaitedForAndNothingHangs) {
  Lockstep lockstep(2, 1, 2);
  std::atomic<int> done = 0;
  {
    std::vector<std::jthread> threads;
    for (std::size_t run = 0; run < 2; ++run)
      threads.emplace_back([&, run] {
        lockstep.start(run);
        for (std::size_t step = 0; step < 40; ++step) lockstep.advance(run, step);
        if (run == 0)
          for (std::size_t step = 10; step < 60; ++step) lockstep.advance(run, step);
        ++done;
        lockstep.finish(run);
      });
  }
  EXPECT_EQ(done, 2);
}

}  // namespace
}  // namespace mh
