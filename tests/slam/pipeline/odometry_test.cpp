// SPDX-License-Identifier: Apache-2.0
// How wheel odometry helps tracking and mapping, with features made without images.
#include <gtest/gtest.h>

#include "slam/core/digest.hpp"
#include "slam/pipeline/slam.hpp"
#include "source_dir.hpp"
#include "tests/slam/pipeline/feature_world.hpp"

namespace mh {
namespace {

using testing_support::FeatureWorld;

constexpr Stamp kStep_ns = 33'333'333;
const FeatureWorld kRow(2500, 400);

SlamState a_run(double reckon_position_m = TrackConfig().reckon_position_m) {
  static const auto vocabulary = std::make_shared<const Vocabulary>(
      Vocabulary::load(std::string(MH_SOURCE_DIR) + "/assets/vocabulary.mhvoc"));
  SlamConfig config;
  config.features.count = 400;
  config.track.reckon_position_m = reckon_position_m;
  return make_slam(FeatureWorld::camera(), config, vocabulary);
}

/// A walk through two rooms; the camera sees nothing for 60 frames of its first full turn.
struct Walk {
  std::vector<SE3> path = FeatureWorld::there_and_back(0, 2);
  std::size_t blind_from = 40, blind_to = 100;
  int next = 1;

  StepReport feed(SlamState& state, std::size_t i, const std::optional<SE3>& odometry) {
    const auto frame = static_cast<std::uint64_t>(next++);
    const bool blind = i >= blind_from && i < blind_to;
    return step(state, static_cast<Stamp>(frame) * kStep_ns,
                blind ? Features() : kRow.see(path[i], RandomStream(2).fork(frame)),
                RandomStream(3).fork(frame), {}, odometry);
  }
  /// Odometry with its own origin, and 1 degree of drift over a full turn.
  SE3 odometry(std::size_t i) const {
    Vector6d drift = Vector6d::Zero();
    drift[4] = 0.017 * static_cast<double>(i) / 150;
    return SE3::exp(Vector6d::Constant(0.4)) * path[i] * SE3::exp(drift);
  }
  SE3 error(std::size_t i, const StepReport& report) const {
    return report.world_from_camera->inverse() * path.front().inverse() * path[i];
  }
};

TEST(Odometry, CarriesTheMapAcrossABlindSpell) {
  SlamState state = a_run();
  Walk walk;
  for (std::size_t i = 0; i < walk.path.size(); ++i) {
    const StepReport report = walk.feed(state, i, walk.odometry(i));
    ASSERT_NE(report.status, TrackStatus::kLost) << i;
    EXPECT_FALSE(report.keyframe_added && i >= walk.blind_from && i < walk.blind_to) << i;
    const SE3 error = walk.error(i, report);
    ASSERT_LT(error.translation().norm(), 0.1) << i;
    ASSERT_LT(error.log().tail<3>().norm(), 0.04) << i;
  }
  state.map.check_invariants();

  SlamState without = a_run();
  Walk again;
  int lost = 0;
  for (std::size_t i = 0; i < again.blind_to; ++i)
    lost += again.feed(without, i, std::nullopt).status == TrackStatus::kLost;
  EXPECT_EQ(lost, 60);
}

TEST(Odometry, SwitchedOffItChangesNoBit) {
  const auto digest_of = [](bool given) {
    SlamState state = a_run(0);
    Walk walk;
    for (std::size_t i = 0; i < 200; ++i)
      walk.feed(state, i, given ? std::optional(walk.odometry(i)) : std::nullopt);
    return digest(trajectory(state));
  };
  EXPECT_EQ(digest_of(true), digest_of(false));
}

TEST(Odometry, ThatStandsWhileTheRobotIsCarriedPlacesItNowhere) {
  SlamState state = a_run();
  Walk walk;
  walk.blind_to = walk.blind_from;
  std::size_t i = 0;
  for (; i < 300; ++i) walk.feed(state, i, walk.odometry(i));  // the second room
  const SE3 stands = walk.odometry(i - 1);
  bool found = false;
  for (int k = 0; k < 60; ++k) {
    const StepReport report = walk.feed(state, 10, stands);  // the first room
    if (!report.world_from_camera) continue;
    found = true;
    EXPECT_LT(walk.error(10, report).translation().norm(), 0.1) << k;
  }
  EXPECT_TRUE(found);
}

TEST(Reach, ACameraThatWasCarriedIsFoundWhenItCanHaveComeThere) {
  const auto first_found_s = [](double max_speed_m_s) {
    SlamState state = a_run();
    state.config.track.max_speed_m_s = max_speed_m_s;
    Walk walk;
    walk.blind_to = walk.blind_from;
    for (std::size_t i = 0; i < 300; ++i) walk.feed(state, i, std::nullopt);  // the second room
    for (int k = 0; k < 300; ++k) {
      const StepReport report = walk.feed(state, 10, std::nullopt);
      if (report.world_from_camera && walk.error(10, report).translation().norm() < 0.1)
        return k / 30.0;
    }
    return 10.0;
  };
  const double apart_m = (Walk().path[299].translation() - Walk().path[10].translation()).norm();
  EXPECT_LT(first_found_s(0), 0.5);
  EXPECT_NEAR(first_found_s(1), apart_m - 0.3, 0.1);
  EXPECT_EQ(first_found_s(0.1), 10);
}

/// The status after a rewind of 50 frames when the whole map cannot be used to relocalize.
TrackStatus after_a_rewind(bool odometry_is_given, bool earlier_poses) {
  SlamState state = a_run();
  state.config.relocalize.min_word_matches = 100'000;
  state.config.track.earlier_poses = earlier_poses;
  Walk walk;
  walk.blind_to = walk.blind_from;
  const auto odometry = [&](std::size_t i) {
    return odometry_is_given ? std::optional(walk.odometry(i)) : std::nullopt;
  };
  for (std::size_t i = 0; i < 120; ++i) walk.feed(state, i, odometry(i));
  rewind(state);
  walk.next = 71;
  const StepReport report = walk.feed(state, 70, odometry(70));
  if (report.world_from_camera) {
    EXPECT_LT(walk.error(70, report).translation().norm(), 0.1);
  }
  return report.status;
}

TEST(Rewind, OdometryKnowsThePlace) {
  EXPECT_EQ(after_a_rewind(true, false), TrackStatus::kRelocalized);
  EXPECT_EQ(after_a_rewind(false, false), TrackStatus::kLost);
}

TEST(Rewind, AFrameIsWhereItWasBefore) {
  EXPECT_EQ(after_a_rewind(false, true), TrackStatus::kRelocalized);
}

TEST(Odometry, TooMuchDriftIsLost) {
  SlamState state = a_run(0.01);
  Walk walk;
  int lost = 0;
  for (std::size_t i = 0; i < walk.blind_to; ++i)
    lost += walk.feed(state, i, walk.odometry(i)).status == TrackStatus::kLost;
  EXPECT_GT(lost, 30);
  EXPECT_LT(lost, 60);
}

}  // namespace
}  // namespace mh
