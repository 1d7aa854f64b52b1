// SPDX-License-Identifier: Apache-2.0
// Pieces of a map: begun where nothing known is in view, joined where they meet.
#include <algorithm>

#include <gtest/gtest.h>

#include "slam/files/map_file.hpp"
#include "slam/pipeline/slam.hpp"
#include "source_dir.hpp"
#include "tests/slam/pipeline/feature_world.hpp"

namespace mh {
namespace {

using testing_support::FeatureWorld;

constexpr Stamp kFrameStep_ns = 33'333'333;
const FeatureWorld kRowOfRooms(2500, 400);

std::shared_ptr<const Vocabulary> shipped_words() {
  static const auto loaded = std::make_shared<const Vocabulary>(
      Vocabulary::load(std::string(MH_SOURCE_DIR) + "/assets/vocabulary.mhvoc"));
  return loaded;
}

/// A walk through three rooms and back; the camera sees nothing from the first room to the last.
struct BlindWalk {
  std::vector<SE3> path = FeatureWorld::there_and_back(0, 3);
  std::size_t blind_from = 155, blind_to = 600;
  SlamState state;
  std::vector<StepReport> reports = {};

  explicit BlindWalk(double new_piece_after_s) {
    SlamConfig config;
    config.features.count = 400;
    config.track.max_speed_m_s = 1.5;
    config.track.new_piece_after_s = new_piece_after_s;
    state = make_slam(FeatureWorld::camera(), config, shipped_words());
  }
  const StepReport& feed() {
    const std::size_t i = reports.size();
    const bool blind = i >= blind_from && i < blind_to;
    reports.push_back(step(state, static_cast<Stamp>(i + 1) * kFrameStep_ns,
                           blind ? Features() : kRowOfRooms.see(path[i], RandomStream(2).fork(i)),
                           RandomStream(3).fork(i)));
    return reports.back();
  }
  bool ended() const { return reports.size() == path.size(); }
  /// Error of a pose in the map that began with frame 0.
  double error_m(std::size_t i, const SE3& world_from_camera) const {
    return (world_from_camera.inverse() * path.front().inverse() * path[i]).translation().norm();
  }
};

TEST(Pieces, BeginAfterABlindSpellAndAreJoinedWhereTheyMeet) {
  BlindWalk walk(1);
  std::size_t joined_at = 0;
  while (!walk.ended()) {
    const StepReport& report = walk.feed();
    const std::size_t i = walk.reports.size() - 1;
    if (i < walk.blind_from) {
      EXPECT_EQ(report.origin, KeyframeId{0}) << i;
    } else if (i == walk.blind_to) {
      EXPECT_EQ(report.status, TrackStatus::kInitialized);
      EXPECT_GT(report.origin.value, 0u);
      const Trajectory all = trajectory(walk.state);
      EXPECT_EQ(of_map(all, 0).size(), walk.blind_from);
      EXPECT_EQ(of_map(all, report.origin.value).size(), 1u);
      EXPECT_EQ(largest_map(all), 0u);
    } else if (i > walk.blind_to) {
      ASSERT_NE(report.status, TrackStatus::kLost) << i;
      if (joined_at == 0 && report.origin == KeyframeId{0}) {
        joined_at = i;
        EXPECT_TRUE(report.loop_closed);
      }
      EXPECT_EQ(report.origin == KeyframeId{0}, joined_at > 0) << i;
    }
  }
  EXPECT_GT(joined_at, 0u);
  walk.state.map.check_invariants();
  const Trajectory all = trajectory(walk.state);
  EXPECT_EQ(all.size(), walk.path.size() - (walk.blind_to - walk.blind_from));
  for (const TimedPose& pose : all) {
    EXPECT_EQ(pose.map, 0u);
    const auto i = static_cast<std::size_t>(pose.stamp_ns / kFrameStep_ns - 1);
    ASSERT_LT(walk.error_m(i, pose.world_from_camera), 0.15) << i;
  }
}

// One second after the camera was in the third room, its view looks like the first room.
TEST(Pieces, ACopyOutOfReachIsNoPlace) {
  BlindWalk walk(0.5);
  walk.blind_from = 620, walk.blind_to = 650;
  std::copy(walk.path.begin(), walk.path.begin() + 300, walk.path.begin() + 650);
  while (walk.reports.size() < 950) {
    const StepReport& report = walk.feed();
    const std::size_t i = walk.reports.size();
    if (i <= walk.blind_from) EXPECT_EQ(report.origin, KeyframeId{0}) << i;
    if (i > walk.blind_to) {
      ASSERT_NE(report.status, TrackStatus::kLost) << i;
      EXPECT_NE(report.origin, KeyframeId{0}) << i;
    }
  }
}

TEST(Pieces, AreKeptApartByDefault) {
  BlindWalk walk(0);
  while (walk.reports.size() < walk.blind_to + 60) walk.feed();
  for (std::size_t i = walk.blind_to; i < walk.reports.size(); ++i)
    EXPECT_EQ(walk.reports[i].status, TrackStatus::kLost) << i;
}

TEST(Pieces, AreSavedWithTheMapAndAnswerInTheirOwnWorld) {
  BlindWalk walk(1);
  while (walk.reports.size() < walk.blind_to + 150) walk.feed();
  const KeyframeId second = walk.reports.back().origin;
  ASSERT_GT(second.value, 0u);
  const std::string saved = encode_slam(walk.state);
  const SlamState loaded = decode_slam(saved, "map", shipped_words());
  EXPECT_EQ(encode_slam(loaded), saved);
  for (const auto& [i, origin] :
       {std::pair(std::size_t{20}, KeyframeId{0}), std::pair(walk.blind_to + 20, second)}) {
    const RandomStream noise = RandomStream(9).fork(i);
    SlamState scratch = loaded;
    rewind(scratch);
    const StepReport found = step(scratch, static_cast<Stamp>(i + 1) * kFrameStep_ns,
                                  kRowOfRooms.see(walk.path[i], noise), RandomStream(4).fork(i));
    EXPECT_EQ(found.status, TrackStatus::kRelocalized) << i;
    EXPECT_EQ(found.origin, origin) << i;
  }
}

TEST(MapJoin, MovesAPieceIntoAnothersWorld) {
  Map map;
  Keyframe keyframe;
  keyframe.features.keypoints.resize(2);
  keyframe.features.descriptors.resize(2);
  const KeyframeId first = map.add(keyframe);
  keyframe.origin = KeyframeId();
  keyframe.camera_from_world = SE3(Eigen::Matrix3d::Identity(), {0, 0, 1});
  const KeyframeId second = map.add(keyframe);
  EXPECT_EQ(map.at(second).origin, second);
  const LandmarkId own = map.add_landmark({1, 0, 0}, first, 0),
                   others = map.add_landmark({2, 0, 0}, second, 0);
  Vector6d turn = Vector6d::Zero();
  turn << 1, 2, 3, 0, 0, 0.5;
  const SE3 first_from_second = SE3::exp(turn);
  const Eigen::Vector3d seen = map.at(second).camera_from_world * map.at(others).position_in_world;
  map.join(second, first, first_from_second);
  EXPECT_EQ(map.at(second).origin, first);
  EXPECT_EQ(map.at(own).position_in_world, Eigen::Vector3d(1, 0, 0));
  EXPECT_LT((map.at(second).camera_from_world * map.at(others).position_in_world - seen).norm(),
            1e-12);
  EXPECT_LT(
      (map.at(others).position_in_world - first_from_second * Eigen::Vector3d(2, 0, 0)).norm(),
      1e-12);
  map.erase(second);
  EXPECT_TRUE(map.at(second).erased) << "it is no origin any more";
  map.erase(first);
  EXPECT_FALSE(map.at(first).erased);
}

}  // namespace
}  // namespace mh
