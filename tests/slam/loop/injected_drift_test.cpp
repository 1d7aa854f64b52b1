// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "slam/pipeline/slam.hpp"
#include "tests/slam/pipeline/box_room_slam.hpp"

namespace mh {
namespace {

using testing_support::BoxRoom;
using testing_support::kTurnFrames;

/// Bends what is mapped so far as drift would: nothing at the first keyframe, all of it at the
/// newest, evenly between. Tracking goes on from the bent end.
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

/// Distance of the newest frame from the truth, both starting from the first.
double end_error_m(const SlamState& state, int frame) {
  return (BoxRoom::round_trip(0, kTurnFrames) *
              trajectory(state).back().world_from_camera.translation() -
          BoxRoom::round_trip(frame, kTurnFrames).translation())
      .norm();
}

Vector6d injected() {
  Vector6d drift;
  drift << 0.20, -0.05, 0.10, 0.0, 0.05, 0.0;  // m, rad: more than any tour of this house gathers
  return drift;
}

// The local map's look around is off: what comes back into view is a loop.
TEST(Loop, CutsInjectedDriftByFiveTimes) {
  SlamConfig config = testing_support::box_room_settings(SemanticConfig{});
  config.track.near_distance_m = 0;
  SlamState state = make_slam(BoxRoom::camera(), config, testing_support::box_room_vocabulary());
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
    // What the loop says of its ends is what is true of them.
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
  config.loop.max_drift_m = 0.02;  // less than what any two ends of the bent map are apart
  config.loop.max_drift_share = 0;
  SlamState state = make_slam(BoxRoom::camera(), config, testing_support::box_room_vocabulary());
  for (int i = 0; i < kTurnFrames + 60; ++i) {
    if (i == 120) inject_drift(state, injected());
    const StepReport report =
        step(state, testing_support::box_room_frame(i, true), RandomStream(7).fork(i));
    ASSERT_FALSE(report.loop_closed) << i;
  }
}

}  // namespace
}  // namespace mh
