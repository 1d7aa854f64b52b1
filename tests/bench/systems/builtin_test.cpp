// SPDX-License-Identifier: Apache-2.0
// Our own system as driven by the protocol: what is frozen stays unchanged, and no query leaves a
// trace.
#include "bench/systems/builtin.hpp"

#include <gtest/gtest.h>

#include "bench/protocol/query.hpp"
#include "slam/core/digest.hpp"
#include "tests/slam/core/made_sequence.hpp"
#include "tests/slam/pipeline/box_room.hpp"

namespace mh {
namespace {

using testing_support::BoxRoom;

constexpr int kTurnFrames = 240;
constexpr int kMapped = 45;

RgbdFrame frame(std::size_t i) {
  return BoxRoom::render(BoxRoom::round_trip(static_cast<int>(i), kTurnFrames),
                         static_cast<Stamp>(i) * 33'333'333);
}

SlamConfig settings() {
  SlamConfig config;
  config.features.count = 500;  // the images have a quarter of the usual size
  return config;
}

/// A part of a room, mapped and frozen.
std::unique_ptr<System> frozen() {
  std::vector<std::vector<Descriptor>> images;
  for (std::size_t i = 0; i < 4; ++i)
    images.push_back(extract(frame(10 * i), BoxRoom::camera(), settings().features).descriptors);
  auto vocabulary =
      std::make_shared<const Vocabulary>(Vocabulary::train(images, {.branching = 10, .depth = 3}));
  auto system = make_builtin_system(BoxRoom::camera(), settings(), vocabulary);
  for (std::size_t i = 0; i < kMapped; ++i)
    if (i % 10 != 9) system->track(frame(i), RandomStream(7).fork(i));
  system->freeze();
  return system;
}

QueryAnswer ask(const System& system, std::size_t index) {
  const MadeSequence frames(
      index + 1, [](std::size_t i, RandomStream) { return frame(i); }, BoxRoom::camera());
  return query(system, index, frames, ProtocolConfig{}, RandomStream(3));
}

TEST(BuiltinSystem, QueriesLeaveNoTraceInTheFrozenMapOrInEachOther) {
  const auto system = frozen();
  const std::uint64_t before = digest(system->trajectory());
  std::vector<QueryAnswer> forwards, backwards;
  const std::vector<std::size_t> queries = {9, 19, 120, 29};  // 120: a view that was never mapped
  for (const std::size_t i : queries) forwards.push_back(ask(*system, i));
  for (auto i = queries.rbegin(); i != queries.rend(); ++i) backwards.push_back(ask(*system, *i));
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const QueryAnswer &a = forwards[i], &b = backwards[queries.size() - 1 - i];
    EXPECT_EQ(a.pose_digest, b.pose_digest) << queries[i];
    EXPECT_EQ(a.matching_digest, b.matching_digest) << queries[i];
    EXPECT_EQ(a.attempts, b.attempts) << queries[i];
  }
  EXPECT_TRUE(forwards[0].world_from_camera && forwards[1].world_from_camera);
  EXPECT_FALSE(forwards[2].world_from_camera);
  EXPECT_EQ(digest(system->trajectory()), before);
}

TEST(BuiltinSystem, ASessionStartsLostWhateverTheOneBeforeItDid) {
  const auto system = frozen();
  const auto first = system->open_session();
  ASSERT_EQ(first->feed(frame(9), RandomStream(1)).status, TrackStatus::kRelocalized);
  ASSERT_EQ(first->feed(frame(10), RandomStream(1)).status, TrackStatus::kTracked);
  const auto second = system->open_session();
  EXPECT_EQ(second->feed(frame(10), RandomStream(1)).status, TrackStatus::kRelocalized);
}

}  // namespace
}  // namespace mh
