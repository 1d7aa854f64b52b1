// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/mapping.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/bench/protocol/fake_system.hpp"

namespace mh {
namespace {

constexpr std::size_t kCount = 120;  // test frames are 29, 59, 89, 119: 116 are offered

TEST(MapSequence, OffersEveryFrameButTheTestFramesOnce) {
  FakeSystem system([](Stamp, int) { return true; });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  EXPECT_EQ(outcome.offered, 116u);
  EXPECT_EQ(system.fed.size(), 116u);
  for (const Stamp test : {29, 59, 89, 119})
    EXPECT_EQ(std::count(system.fed.begin(), system.fed.end(), test), 0) << test;
  EXPECT_EQ(outcome.restarts, 0);
  EXPECT_TRUE(outcome.dropped.empty());
}

// By hand: frame 80 is never tracked. First pass: 0..80 without 29 and 59 = 79 calls, failure 1.
// Each of the rewinds goes to frame 30 and feeds 30..80 without 59 = 50 calls. Failures 2 to 6
// come after restarts 1 to 5; at the sixth failure the frame is dropped and the feed goes back a
// sixth time, feeding 30..119 without 59, 80, 89, 119 = 86 calls. 79 + 5 * 50 + 86 = 415.
TEST(MapSequence, DropsTheOffendingFrameAfterFiveFailedRestarts) {
  FakeSystem system([](Stamp frame, int) { return frame != 80; });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  EXPECT_EQ(outcome.failures, 6);
  EXPECT_EQ(outcome.restarts, 6);
  EXPECT_EQ(system.rewinds, 6);
  EXPECT_EQ(system.resets, 0);
  EXPECT_EQ(outcome.dropped, std::vector<std::size_t>{80});
  EXPECT_EQ(outcome.calls.size(), 415u);
  EXPECT_EQ(std::count(system.fed.begin(), system.fed.end(), 80), 6);
  EXPECT_EQ(system.trajectory().size(), 115u);  // completeness 115 / 116
  EXPECT_FALSE(outcome.gave_up);
  EXPECT_EQ(system.fed[79], 30);  // after the failure at 80, the feed goes back to 80 - 50
}

TEST(MapSequence, AFrameThatIsTrackedOnTheThirdShowingCostsTwoRestarts) {
  FakeSystem system([](Stamp frame, int showing) { return frame != 80 || showing >= 3; });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  EXPECT_EQ(outcome.restarts, 2);
  EXPECT_TRUE(outcome.dropped.empty());
  EXPECT_EQ(system.trajectory().size(), 116u);
}

TEST(MapSequence, LostFramesOnTheWayBackAreNoFailures) {
  // After the failure at 80, the system does not track again until frame 75.
  FakeSystem system([](Stamp frame, int showing) {
    if (frame == 80) return showing >= 2;
    return showing == 1 || frame >= 75;
  });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  EXPECT_EQ(outcome.failures, 1);
  EXPECT_EQ(outcome.restarts, 1);
  EXPECT_TRUE(outcome.dropped.empty());
}

TEST(MapSequence, CountsAnewAfterTheTroubleIsPassed) {
  // Frame 70 is tracked at its fifth showing, frame 100 would be at its ninth.
  FakeSystem system([](Stamp frame, int showing) {
    return (frame != 70 && frame != 100) || showing >= (frame == 70 ? 5 : 9);
  });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  // Frame 100 is not shown until 70 is passed; its sixth failure drops it. Frame 70 costs four
  // restarts and is kept.
  EXPECT_EQ(outcome.dropped, std::vector<std::size_t>{100});
  EXPECT_EQ(outcome.restarts, 4 + 6);
}

TEST(MapSequence, TheOtherReadingOfResetForgetsTheMap) {
  FakeSystem system([](Stamp frame, int) { return frame != 80; });
  ProtocolConfig config;
  config.reset = DropReset::kMap;
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), config, RandomStream(1));
  EXPECT_EQ(system.resets, 1);
  EXPECT_EQ(outcome.dropped.size(), 1u);
  EXPECT_EQ(system.trajectory().size(), 86u);  // the frames fed after the reset, as counted above
}

// By hand, in addition to the count above: there are again 415 calls, since the feed goes back by
// 50 in either case. But the drop forgets frames 0 to 80; frames 30 to 119 without 59, 80, 89 and
// 119 are fed again, so that 86 of 116 frames have a pose in the end and frame 30 begins the new
// map.
TEST(MapSequence, ResettingTheMapCostsWhatLiesBeforeTheRewind) {
  FakeSystem system([](Stamp frame, int) { return frame != 80; });
  ProtocolConfig config;
  config.reset = DropReset::kMap;
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), config, RandomStream(1));
  EXPECT_EQ(outcome.calls.size(), 415u);
  EXPECT_EQ(outcome.failures, 6);
  EXPECT_EQ(outcome.restarts, 6);
  EXPECT_EQ(outcome.dropped, std::vector<std::size_t>{80});
  EXPECT_EQ(system.trajectory().front().stamp_ns, 30);
  EXPECT_EQ(system.trajectory().back().stamp_ns, 118);
}

// By hand: frame 10 fails twice, and the feed cannot go back beyond frame 0: 11 calls, 11 calls,
// then all of 0 to 119 except the four test frames: 22 + 116 = 138.
TEST(MapSequence, GoesBackToTheStartAtMost) {
  FakeSystem system([](Stamp frame, int showing) { return frame != 10 || showing >= 3; });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  EXPECT_EQ(outcome.failures, 2);
  EXPECT_EQ(outcome.restarts, 2);
  EXPECT_EQ(outcome.calls.size(), 138u);
  EXPECT_EQ(system.fed[11], 0);
}

// By hand: without restarts, the first failure at 80 drops it. 0 to 80 without two test frames = 79
// calls, then 30 to 119 without 59, 80, 89, 119 = 86: 165 in all.
TEST(MapSequence, WithoutRestartsTheFirstFailureDropsTheFrame) {
  FakeSystem system([](Stamp frame, int) { return frame != 80; });
  ProtocolConfig config;
  config.restarts_per_frame = 0;
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), config, RandomStream(1));
  EXPECT_EQ(outcome.failures, 1);
  EXPECT_EQ(outcome.restarts, 1);
  EXPECT_EQ(outcome.dropped, std::vector<std::size_t>{80});
  EXPECT_EQ(outcome.calls.size(), 165u);
}

// By hand, with rewinds of 5: 80 and 81 are never tracked. 0 to 80 without 29, 59 = 79 calls; five
// times 75 to 80 = 30; after the drop of 80, 75 to 81 without it = 6, where 81 fails for the first
// time; five times 76 to 81 without 80 = 25; after the drop of 81, 76 to 119 without 80, 81, 89,
// 119 = 40. Together 79 + 30 + 6 + 25 + 40 = 180; failures 6 + 6.
TEST(MapSequence, TwoOffendingFramesInARowAreDroppedOneAfterTheOther) {
  FakeSystem system([](Stamp frame, int) { return frame != 80 && frame != 81; });
  ProtocolConfig config;
  config.rewind_frames = 5;
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), config, RandomStream(1));
  EXPECT_EQ(outcome.dropped, (std::vector<std::size_t>{80, 81}));
  EXPECT_EQ(outcome.failures, 12);
  EXPECT_EQ(outcome.restarts, 12);
  EXPECT_EQ(outcome.calls.size(), 180u);
  EXPECT_EQ(system.trajectory().size(), 114u);
}

TEST(MapSequence, FramesBringTheReadingsSinceTheFrameBefore) {
  MadeSequence frames = fake_frames(kCount);
  for (Stamp at = 0; at < static_cast<Stamp>(kCount); ++at) frames.readings.push_back({at, {}, {}});
  FakeSystem system([](Stamp frame, int showing) { return frame != 80 || showing > 1; });
  map_sequence(system, frames, {}, RandomStream(1));
  const auto stamps = [&](std::size_t shown) {
    std::vector<Stamp> of;
    for (const ImuReading& reading : system.imu[shown]) of.push_back(reading.stamp_ns);
    return of;
  };
  EXPECT_EQ(stamps(0), std::vector<Stamp>{0});
  EXPECT_EQ(system.fed[29], 30);  // 29 is a test frame
  EXPECT_EQ(stamps(29), (std::vector<Stamp>{29, 30}));
  EXPECT_EQ(system.fed[79], 30);  // again, after the failure at 80
  EXPECT_EQ(stamps(79), std::vector<Stamp>{30});
}

// Frames 80 to 99 are never tracked. By hand: 79 + 5 * 50 calls up to the sixth failure of 80 (see
// above), then 30 to 119 without 59, 80, 89, 119 = 86: 415 in all. In these last calls, each of 81
// to 99 (except 89) is shown once.
TEST(MapSequence, AHopelessSpellIsShownOnce) {
  FakeSystem system([](Stamp frame, int) { return frame < 80 || frame > 99; });
  ProtocolConfig config;
  config.hopeless_after = 1;
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), config, RandomStream(1));
  EXPECT_EQ(outcome.calls.size(), 415u);
  EXPECT_EQ(outcome.restarts, 6);
  EXPECT_EQ(system.rewinds, 6);
  EXPECT_EQ(outcome.dropped.size(), 19u);
  EXPECT_EQ(system.trajectory().size(), 116u - 19u);
  config.hopeless_after = 0;
  FakeSystem other([](Stamp frame, int) { return frame < 80 || frame > 99; });
  const MappingOutcome all = map_sequence(other, fake_frames(kCount), config, RandomStream(1));
  EXPECT_TRUE(all.gave_up);
}

TEST(MapSequence, AfterAHopelessSpellFramesGetTheirRestartsAgain) {
  FakeSystem system([](Stamp frame, int) { return frame != 80 && frame != 81 && frame != 110; });
  ProtocolConfig config;
  config.hopeless_after = 1;
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), config, RandomStream(1));
  EXPECT_EQ(outcome.dropped, (std::vector<std::size_t>{80, 81, 110}));
  EXPECT_EQ(outcome.restarts, 6 + 6);
}

TEST(MapSequence, AFeedThatContinuesShowsEachFrameOnceAndHoldsNoneOut) {
  FakeSystem system([](Stamp frame, int) { return frame < 40 || frame >= 50; });
  std::vector<std::size_t> seen;
  const MappingOutcome outcome = map_sequence(
      system, fake_frames(kCount), live_feed(), RandomStream(1),
      [&](const MappedFrame& call, const RgbdFrame&, const SystemReport&) {
        seen.push_back(call.index);
      },
      7);
  EXPECT_EQ(outcome.offered, 113u);
  ASSERT_EQ(system.fed.size(), 113u);
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i + 7);
  EXPECT_EQ(outcome.failures, 1) << "ten lost frames in a row are one failure";
  EXPECT_EQ(outcome.restarts + system.rewinds, 0);
  // Each frame gets the same random draws as in a feed from the start.
  FakeSystem whole([](Stamp, int) { return true; });
  map_sequence(whole, fake_frames(kCount), live_feed(), RandomStream(1));
  EXPECT_EQ(std::vector(whole.streams.begin() + 7, whole.streams.end()), system.streams);
}

TEST(MapSequence, PassesOverFramesBeforeTheMapExists) {
  FakeSystem system([](Stamp frame, int) { return frame >= 7; });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  EXPECT_EQ(outcome.before_map, 7);
  EXPECT_EQ(outcome.failures, 0);
  EXPECT_EQ(outcome.restarts, 0);
  EXPECT_EQ(outcome.calls.size(), 116u);
}

TEST(MapSequence, ASystemThatNeverFindsBackComesToAnEnd) {
  FakeSystem system([](Stamp frame, int showing) { return showing == 1 && frame < 60; });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  EXPECT_TRUE(outcome.gave_up);
  EXPECT_LE(outcome.calls.size(), kCount + 1000);
  EXPECT_GE(outcome.dropped.size(), 1u);
}

TEST(MapSequence, EndsByItselfWhenEveryFrameFromSomewhereOnMustBeDropped) {
  FakeSystem system([](Stamp frame, int) { return frame < 100; });
  ProtocolConfig config;
  config.max_effort = 1000;
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), config, RandomStream(1));
  EXPECT_FALSE(outcome.gave_up);
  EXPECT_EQ(outcome.dropped.size(), 19u);  // 100 .. 118
  EXPECT_EQ(outcome.restarts, 19 * 6);
}

TEST(MapSequence, ARestartIsNoReplica) {
  FakeSystem system([](Stamp frame, int showing) { return frame != 80 || showing >= 3; });
  const MappingOutcome outcome = map_sequence(system, fake_frames(kCount), {}, RandomStream(1));
  std::set<std::uint64_t> draws(system.streams.begin(), system.streams.end());
  EXPECT_EQ(draws.size(), system.streams.size());
  std::set<std::uint64_t> images_of_80;
  for (const MappedFrame& call : outcome.calls)
    if (call.index == 80) images_of_80.insert(call.image_digest);
  EXPECT_EQ(images_of_80.size(), 3u);
}

TEST(MapSequence, IsAPureFunctionOfItsStream) {
  const auto run = [](std::uint64_t seed) {
    FakeSystem system([](Stamp frame, int showing) { return frame != 80 || showing >= 3; });
    map_sequence(system, fake_frames(kCount), {}, RandomStream(seed));
    return system.streams;
  };
  EXPECT_EQ(run(4), run(4));
  EXPECT_NE(run(4), run(5));
}

}  // namespace
}  // namespace mh
