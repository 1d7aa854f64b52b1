// SPDX-License-Identifier: Apache-2.0
// Maps that grow: properties of long runs, with features made without images.
#include <gtest/gtest.h>

#include "slam/pipeline/slam.hpp"
#include "source_dir.hpp"
#include "tests/slam/pipeline/box_room.hpp"
#include "tests/slam/pipeline/feature_world.hpp"

namespace mh {
namespace {

using testing_support::BoxRoom;
using testing_support::FeatureWorld;

std::shared_ptr<const Vocabulary> world_vocabulary() {
  static const auto loaded = std::make_shared<const Vocabulary>(
      Vocabulary::load(std::string(MH_SOURCE_DIR) + "/assets/vocabulary.mhvoc"));
  return loaded;
}

constexpr Stamp kPeriod_ns = 33'333'333;
const FeatureWorld kWorld(2500, 400);

SlamState new_run() {
  SlamConfig config;
  config.features.count = 400;
  Camera camera = FeatureWorld::camera();
  camera.disparity_sigma_px = 0.1;  // more keyframes than with a learned value: some are culled
  camera.disparity_sigma_is_given = true;
  return make_slam(camera, config, world_vocabulary());
}

StepReport feed(SlamState& state, const SE3& world_from_camera, std::uint64_t frame) {
  return step(state, static_cast<Stamp>(frame) * kPeriod_ns,
              kWorld.see(world_from_camera, RandomStream(2).fork(frame)),
              RandomStream(3).fork(frame));
}

TEST(Growth, CullingAndFusionKeepTheGraphsInvariantsAfterEveryFrame) {
  SlamState state = new_run();
  const std::vector<SE3> path = FeatureWorld::there_and_back(0, 2);
  std::uint64_t frame = 0;
  int added = 0;
  for (int lap = 0; lap < 2; ++lap)
    for (const SE3& pose : path) {
      const StepReport report = feed(state, pose, ++frame);
      ASSERT_NE(report.status, TrackStatus::kLost) << frame;
      added += report.keyframe_added;
      if (report.keyframe_added) {
        ASSERT_NO_THROW(state.map.check_invariants()) << frame;
      }
      const SE3 error = report.world_from_camera->inverse() * path.front().inverse() * pose;
      EXPECT_LT(error.translation().norm(), 0.1) << frame;
    }
  // The test means something: keyframes and landmarks were added and removed.
  EXPECT_GT(added, state.map.keyframe_count());
  EXPECT_GT(state.map.landmarks().size(), static_cast<std::size_t>(state.map.landmark_count()));
}

TEST(Growth, AFrameIsComparedWithItsSurroundingsNotWithTheMap) {
  const auto compared_on_known_ground = [](int rooms) {
    SlamState state = new_run();
    std::uint64_t frame = 0;
    for (const SE3& pose : FeatureWorld::there_and_back(0, rooms)) feed(state, pose, ++frame);
    std::int64_t compared = 0;
    frame = 1'000'000;  // the same frames, regardless of what came before
    for (const SE3& pose : FeatureWorld::there_and_back(0, 1))
      for (const MatcherCounts& counts : feed(state, pose, ++frame).matches)
        compared += counts.compared;
    return compared;
  };
  const std::int64_t small = compared_on_known_ground(2);
  EXPECT_GT(small, 100'000);
  EXPECT_LT(compared_on_known_ground(6), 1.3 * static_cast<double>(small));
}

TEST(Step, FeaturesAtHandGiveTheBitsOfTheirFrames) {
  const auto run = [](bool at_hand) {
    SlamState state = make_slam(BoxRoom::camera(), SlamConfig{}, world_vocabulary());
    for (int i = 0; i < 20; ++i) {
      const RgbdFrame frame = BoxRoom::render(BoxRoom::round_trip(i, 120), (i + 1) * kPeriod_ns);
      const RandomStream stream = RandomStream(1).fork(static_cast<std::uint64_t>(i));
      if (at_hand)
        step(state, frame.stamp_ns, extract(frame, state.camera, state.config.features), stream);
      else
        step(state, frame, stream);
    }
    return state.map.digest();
  };
  EXPECT_EQ(run(true), run(false));
}

}  // namespace
}  // namespace mh
