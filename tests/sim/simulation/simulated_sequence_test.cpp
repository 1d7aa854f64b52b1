// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation/simulated_sequence.hpp"

#include <gtest/gtest.h>

#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

SimulatedSequence three_steps_towards_a_wall(LabelMode labels) {
  Scene scene = test::plain_scene({120, 120, 120});
  test::add_quad(scene, {-9, -9, 3}, {18, 0, 0}, {0, 18, 0}, 5, 1);
  std::vector<TimedPose> path;
  for (int i = 0; i < 3; ++i)
    path.push_back({1000 + i, SE3(Eigen::Matrix3d::Identity(), {0, 0, 0.5 * i})});
  return {make_embree_renderer(scene), Camera{}, path, SensorConfig{}, labels};
}

TEST(SimulatedSequence, FramesCarryStampTruthAndWhatTheCameraSees) {
  const SimulatedSequence sequence = three_steps_towards_a_wall(LabelMode::kExact);
  ASSERT_EQ(sequence.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const RgbdFrame seen = sequence.frame(i, RandomStream(1));
    EXPECT_EQ(seen.stamp_ns, 1000 + static_cast<Stamp>(i));
    const TimedPose& truth = (*sequence.truth())[i];
    EXPECT_EQ(sequence.stamp_ns(i), seen.stamp_ns);
    EXPECT_EQ(truth.stamp_ns, seen.stamp_ns);
    EXPECT_EQ(truth.world_from_camera.translation().z(), 0.5 * static_cast<double>(i));
    double sum = 0.0;
    for (const float depth : seen.depth_m) sum += depth;
    const double expected = 3.0 - 0.5 * static_cast<double>(i);
    EXPECT_NEAR(sum / 307200.0, expected, 0.01);  // noise of 1.4 cm and steps of up to 3 cm
    EXPECT_EQ(seen.semantics.at(10, 10).most_probable(), 5);
  }
}

TEST(SimulatedSequence, NoiseIsKeyedByAttemptAndFrameNotByTheOrderOfAsking) {
  const SimulatedSequence sequence = three_steps_towards_a_wall(LabelMode::kNone);
  const RandomStream first(7), other = first.fork(1);
  const RgbdFrame early = sequence.frame(1, first);
  sequence.frame(2, first);
  sequence.frame(0, other);
  const RgbdFrame late = sequence.frame(1, first);
  EXPECT_EQ(early.depth_m, late.depth_m);
  EXPECT_EQ(early.color, late.color);
  EXPECT_NE(sequence.frame(1, other).depth_m, early.depth_m);
  EXPECT_NE(sequence.frame(1, other).color, early.color);
  // The wall looks the same from everywhere, so equal noise would give equal images.
  EXPECT_NE(sequence.frame(0, first).color, early.color);
  EXPECT_TRUE(early.semantics.index.empty());
}

}  // namespace
}  // namespace mh
