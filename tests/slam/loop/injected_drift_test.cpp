// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "slam/core/random.hpp"
#include "slam/loop/loop.hpp"
#include "slam/pipeline/slam.hpp"
#include "tests/slam/pipeline/box_room_slam.hpp"

namespace mh {
namespace {

using testing_support::BoxRoom;
using testing_support::kTurnFrames;

/// Bends the map like drift: by nothing at the first keyframe, fully at the newest one, and
/// proportionally in between. Tracking continues from the bent end.
void inject_drift(SlamState& state, const Vector6d& drift) {
  const double last = static_cast<double>(state.map.keyframes().size() - 1);
  const auto bend = [&](KeyframeId k) { return SE3::exp(drift * (k.value / last)); };
  for (const Landmark& l : state.map.landmarks())
    if (!l.erased)
      state.map.set_position(l.id, bend(l.observations.front().keyframe) * l.position_in_world);
  for (const Keyframe& k : state.map.keyframes())
    if (!k.erased) state.map.set_pose(k.id, k.camera_from_world * bend(k.id).inverse());
  ASSERT_TRUE(state.tracker.last);
  SE3& camera_from_world = state.tracker.last->camera_from_world;
  camera_from_world = camera_from_world * SE3::exp(drift).inverse();
}

/// Distance of the newest frame from the truth, when both start at the first frame.
double end_error_m(const SlamState& state, int frame) {
  return (BoxRoom::round_trip(0, kTurnFrames) *
              trajectory(state).back().world_from_camera.translation() -
          BoxRoom::round_trip(frame, kTurnFrames).translation())
      .norm();
}

Vector6d injected() {
  Vector6d drift;
  drift << 0.20, -0.05, 0.10, 0.0, 0.05,
      0.0;  // m, rad: more than any tour of this house accumulates
  return drift;
}

// The local map does not look for nearby keyframes: what comes back into view is a loop.
TEST(Loop, CutsInjectedDriftByFiveTimes) {
  SlamConfig config = testing_support::box_room_settings(SemanticConfig{});
  config.track.near_distance_m = 0;
  SlamState state = make_slam(BoxRoom::camera(), config, testing_support::vocabulary());
  double before_m = 0, after_m = 0;
  int closed_at = -1;
  for (int i = 0; i < kTurnFrames + 60 && closed_at < 0; ++i) {
    if (i == 120) inject_drift(state, injected());
    if (i > 0) before_m = end_error_m(state, i - 1);
    const StepReport report =
        step(state, testing_support::box_room_frame(i, true), RandomStream(7).fork(i));
    ASSERT_NE(report.status, TrackStatus::kLost) << i;
    if (i == 121) {
      EXPECT_GT(before_m, 0.10) << "no drift to cut";
    }
    if (!report.loop_closed) continue;
    closed_at = i;
    after_m = end_error_m(state, i);
    ASSERT_TRUE(report.loop);
    // The relative pose that the loop reports is true.
    const auto truth_at = [](Stamp stamp_ns) {
      return BoxRoom::round_trip(static_cast<int>(stamp_ns / testing_support::kFrame_ns),
                                 kTurnFrames);
    };
    const SE3 exact =
        truth_at(report.loop->old_stamp_ns).inverse() * truth_at(report.loop->stamp_ns);
    EXPECT_LT((exact.translation() - report.loop->old_from_new.translation()).norm(), 0.03);
    EXPECT_LT(angle_between_rad(exact, report.loop->old_from_new), 0.02);
  }
  state.map.check_invariants();
  ASSERT_GT(closed_at, 180) << "a loop was seen where there is none, or never";
  EXPECT_GT(before_m, 0.10);
  EXPECT_LT(after_m, before_m / 5) << "before: " << before_m;
}

TEST(Loop, IsRefusedWhereItTellsOfMoreDriftThanCanBe) {
  SlamConfig config = testing_support::box_room_settings(SemanticConfig{});
  config.track.near_distance_m = 0;
  config.loop.max_drift_m =
      0.02;  // less than the distance between the ends of any loop in the bent map
  config.loop.max_drift_share = 0;
  SlamState state = make_slam(BoxRoom::camera(), config, testing_support::vocabulary());
  for (int i = 0; i < kTurnFrames + 60; ++i) {
    if (i == 120) inject_drift(state, injected());
    const StepReport report =
        step(state, testing_support::box_room_frame(i, true), RandomStream(7).fork(i));
    ASSERT_FALSE(report.loop_closed) << i;
  }
}

/// Cameras in a row, 0.2 m apart and all looking along z; each has 20 landmarks that the next one
/// sees, too. The row is too long in the map: the last camera is too far by `drift_m`, which
/// accumulates evenly. The last camera also sees the first camera's landmarks, where they really
/// are: a loop.
struct StretchedRow {
  static constexpr std::uint32_t kKeyframes = 6, kShared = 20, kLast = kKeyframes - 1;
  static constexpr double kStep_m = 0.2;
  Camera camera;
  SlamConfig config;
  Map map;
  MatchCounts counts{};
  Loop loop;

  explicit StretchedRow(double drift_m) {
    config.bundle.iterations = config.bundle.refine_iterations = 0;  // tests only the bending
    const double step_m = kStep_m + drift_m / kLast;
    const RandomStream draw(3);
    const auto descriptor = [&](std::uint32_t owner, std::uint32_t i) {
      const RandomStream bits = draw.fork(owner).fork(i);
      return Descriptor{bits.bits(0), bits.bits(1), bits.bits(2), bits.bits(3)};
    };
    const auto seen_from = [&](double x_m, std::uint32_t i) {  // landmark i of the camera at 0
      const Eigen::Vector3d p(0.05 * (i % 5) - x_m, 0.2 * (i / 5) - 0.3, 2.0 + 0.05 * i);
      return p;
    };
    for (std::uint32_t k = 0; k < kKeyframes; ++k) {
      Keyframe keyframe;
      keyframe.camera_from_world =
          SE3(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(-step_m * k, 0, 0));
      const auto see = [&](std::uint32_t owner, double x_m) {
        for (std::uint32_t i = 0; i < kShared; ++i) {
          const Eigen::Vector3d p = seen_from(x_m, i);
          Keypoint keypoint;
          keypoint.u_px = static_cast<float>(camera.project(p).x());
          keypoint.v_px = static_cast<float>(camera.project(p).y());
          keypoint.depth_m = static_cast<float>(p.z());
          keyframe.features.keypoints.push_back(keypoint);
          keyframe.features.descriptors.push_back(descriptor(owner, i));
        }
      };
      see(k, 0);                                // features 0 to 19
      if (k > 0) see(k - 1, step_m);            // 20 to 39
      if (k == kLast) see(0, kStep_m * kLast);  // 40 to 59
      keyframe.grid = FeatureGrid(keyframe.features.keypoints, camera);
      map.add(std::move(keyframe));
    }
    for (std::uint32_t k = 0; k < kKeyframes; ++k)
      for (std::uint32_t i = 0; i < kShared; ++i) {
        const LandmarkId id =
            map.add_landmark(seen_from(0, i) + Eigen::Vector3d(step_m * k, 0, 0), KeyframeId{k}, i);
        if (k < kLast) map.add_observation(id, KeyframeId{k + 1}, kShared + i);
        map.refresh(id, config.features);
      }
    for (std::uint32_t k = 0; k < kKeyframes; ++k) map.update_covisibility(KeyframeId{k});
    loop.keyframe = KeyframeId{kLast};
    loop.old_keyframe = KeyframeId{0};
    loop.camera_from_world =
        SE3(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(-kStep_m * kLast, 0, 0));
    loop.landmarks.resize(3 * kShared);
    for (std::uint32_t i = 0; i < kShared; ++i) loop.landmarks[2 * kShared + i] = LandmarkId{i};
  }

  void close() { close_loop(map, loop, {camera, config, map, counts}); }
  double x_m(std::uint32_t k) const {
    return map.at(KeyframeId{k}).camera_from_world.inverse().translation().x();
  }
};

// Each of the five steps and the loop has 20 landmarks, so each of the six takes a sixth of the
// excess.
TEST(CloseLoop, BendsARowEvenlyAndItsLandmarksWithIt) {
  constexpr double kDrift_m = 0.06;
  StretchedRow row(kDrift_m);
  const StretchedRow before(kDrift_m);
  row.close();
  for (std::uint32_t k = 0; k < StretchedRow::kKeyframes; ++k) {
    const double moved_m = -kDrift_m * k / StretchedRow::kKeyframes;
    EXPECT_NEAR(row.x_m(k) - before.x_m(k), moved_m, 1e-6) << k;
    const SE3& pose = row.map.at(KeyframeId{k}).camera_from_world;
    EXPECT_LT(angle_between_rad(pose, SE3()), 1e-6) << k;
    const LandmarkId own{k * StretchedRow::kShared + 7};
    ASSERT_FALSE(row.map.at(own).erased);
    EXPECT_LT((row.map.at(own).position_in_world - before.map.at(own).position_in_world -
               Eigen::Vector3d(moved_m, 0, 0))
                  .norm(),
              1e-6)
        << k;
  }
  row.map.check_invariants();
}

TEST(CloseLoop, BelowWhatIsNegligiblePosesStayAndLandmarksAreJoined) {
  StretchedRow row(0.009);
  const StretchedRow before(0.009);
  ASSERT_LT(0.009, row.config.loop.negligible_m);
  row.close();
  for (std::uint32_t k = 0; k < StretchedRow::kKeyframes; ++k) EXPECT_EQ(row.x_m(k), before.x_m(k));
  EXPECT_EQ(before.map.at(LandmarkId{3}).observations.size(), 2u);
  EXPECT_EQ(row.map.at(LandmarkId{3}).observations.size(), 3u);
  EXPECT_EQ(row.map.at(KeyframeId{0}).covisible.size(), 2u) << "the next one, and the last";
}

}  // namespace
}  // namespace mh
