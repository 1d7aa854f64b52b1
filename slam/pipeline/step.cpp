// SPDX-License-Identifier: Apache-2.0
// The whole system on one page: observe, locate, decide on a keyframe, map, look for loops,
// remember.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/match/expect.hpp"
#include "slam/optimize/depth_trust.hpp"
#include "slam/pipeline/add_keyframe.hpp"
#include "slam/pipeline/locate.hpp"
#include "slam/pipeline/pieces.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh {
namespace {

constexpr int kMinInitialPoints =
    100;  // number of points with depth that a frame needs to define the origin

/// Begins a piece of the map with a frame, if it has enough depth. The frame defines the piece's
/// world.
/// @param place  camera_from_world of the frame; absent: the identity
StepReport begin_piece(SlamState& state, PreparedFrame frame, const std::optional<SE3>& place,
                       const StepObservers& observers, StepReport report) {
  const int with_depth = points_with_depth(frame.features);
  if (with_depth < kMinInitialPoints) return report;
  const SE3 camera_from_world = place.value_or(SE3());
  const TrackedPose first{camera_from_world, std::vector<LandmarkId>(frame.features.size())};
  const KeyframeId id =
      add_keyframe(state, frame, first, KeyframeId(), RandomStream(), observers, report);
  state.tracked_frames[frame.stamp_ns] = {id, SE3()};
  report.status = TrackStatus::kInitialized;
  report.world_from_camera = place ? place->inverse() : SE3();
  report.origin = id;
  report.inliers = with_depth;
  forget(state.tracker);
  remember(state.tracker,
           {frame.stamp_ns, camera_from_world, std::move(frame.features),
            state.map.at(id).landmarks, frame.odom_from_camera},
           id, std::nullopt);
  return report;
}

/// Whether the frame with this stamp is already a keyframe: after a rewind, frames are shown again.
/// A second keyframe of the same image would count each measurement twice, as if two measurements
/// agreed, and the map would grow with every rewind.
bool is_keyframe(const Map& map, Stamp stamp_ns) {
  return std::any_of(map.keyframes().begin(), map.keyframes().end(),
                     [&](const Keyframe& k) { return !k.erased && k.stamp_ns == stamp_ns; });
}

/// Learns from a tracked frame how far its depth can be trusted. Only landmarks seen by three or
/// more keyframes are used: the position of others may come from a single depth reading.
void learn_depth_trust(SlamState& state, const TrackedPose& tracked, const Features& features) {
  if (state.camera.disparity_sigma_is_given) return;
  std::vector<LandmarkId> certain = tracked.landmarks;
  for (LandmarkId& id : certain)
    if (id.valid() && state.map.at(id).observations.size() < 3) id = LandmarkId{};
  std::vector<std::uint32_t> feature_of;
  const std::vector<PoseObservation> seen =
      observe(features, certain, state.map, state.camera, state.config.features, feature_of);
  const auto disagreement = depth_disagreement(seen, tracked.camera_from_world, state.camera);
  if (!disagreement) return;
  state.camera.disparity_sigma_px = learned_disparity_sigma_px(state.camera.disparity_sigma_px,
                                                               state.depth_frames++, *disagreement);
}

/// Whether a camera can have moved from one pose to the other, at TrackConfig::max_speed_m_s at
/// most and turning no faster than a hand does. @param elapsed_ns  of either sign
bool within_reach(const SE3& camera_from_world, const SE3& other_camera_from_world,
                  Stamp elapsed_ns, double max_speed_m_s) {
  if (max_speed_m_s == 0) return true;
  constexpr double kLeast_m = 0.3, kLeast_rad = 0.2, kNanosecond_s = 1e-9;
  constexpr double kMaxTurn_rad_s = 3;  // faster than any robot's head, about that of a hand
  const double moved_m =
      (other_camera_from_world.inverse().translation() - camera_from_world.inverse().translation())
          .norm();
  const double elapsed_s = std::abs(static_cast<double>(elapsed_ns)) * kNanosecond_s;
  return moved_m <= kLeast_m + max_speed_m_s * elapsed_s &&
         angle_between_rad(other_camera_from_world, camera_from_world) <=
             kLeast_rad + kMaxTurn_rad_s * elapsed_s;
}

/// Whether a pose is possible for a frame. It must be in the same piece of the map as the tracked
/// frame before or the one after it (the latter is known after a rewind), and within reach of each
/// of these two frames that is in this piece.
bool is_possible(const SlamState& state, Stamp stamp_ns, const MapPose& pose) {
  const auto& frames = state.tracked_frames;
  if (frames.empty()) return true;
  bool is_beside = false;
  const auto allows = [&](const auto& other) {
    if (map_pose(state, other->second).origin != pose.origin) return true;
    is_beside = true;
    return within_reach(map_pose(state, other->second).camera_from_world, pose.camera_from_world,
                        stamp_ns - other->first, state.config.track.max_speed_m_s);
  };
  const auto after = frames.lower_bound(stamp_ns);
  return (after == frames.end() || allows(after)) &&
         (after == frames.begin() || allows(std::prev(after))) && is_beside;
}

/// Where a frame was when it was shown before, if TrackConfig::earlier_poses asks for it.
std::optional<MapPose> earlier_pose(const SlamState& state, Stamp stamp_ns) {
  if (!state.config.track.earlier_poses) return std::nullopt;
  const auto frame = state.tracked_frames.find(stamp_ns);
  if (frame == state.tracked_frames.end()) return std::nullopt;
  return map_pose(state, frame->second);
}

/// Counts how often landmarks were expected and found: young ones that are seldom found are culled.
void count_sightings(Map& map, const Located& located) {
  for (const LandmarkId id : located.expected) map.count_visible(id);
  for (const LandmarkId id : located.tracked.landmarks)
    if (id.valid()) map.count_found(id);
}

}  // namespace

StepReport step(SlamState& state, const RgbdFrame& frame, RandomStream stream,
                const StepObservers& observers) {
  require_increasing_stamp(frame.stamp_ns, state.last_stamp_ns);
  return step(state, frame.stamp_ns, observed_features(frame, state, observers), stream, observers,
              frame.odom_from_camera, frame.imu);
}

StepReport step(SlamState& state, Stamp stamp_ns, Features features, RandomStream stream,
                const StepObservers& observers, const std::optional<SE3>& odom_from_camera,
                std::span<const ImuReading> imu) {
  require_increasing_stamp(stamp_ns, state.last_stamp_ns);
  if (features.descriptors.size() != features.keypoints.size())
    throw InputError(fmt::format("frame at {} ns: {} keypoints, but {} descriptors", stamp_ns,
                                 features.keypoints.size(), features.descriptors.size()));
  state.last_stamp_ns = stamp_ns;
  StepReport report;
  report.keypoints = static_cast<int>(features.size());
  const SlamContext context = context_of(state, observers, report);

  PreparedFrame frame = prepare(stamp_ns, std::move(features), state, state.tracker);
  if (state.config.track.reckon_position_m > 0) {
    frame.odom_from_camera = odom_from_camera;
    frame.imu = imu;
  }
  if (state.map.empty()) return begin_piece(state, std::move(frame), {}, observers, report);

  auto located = locate(
      state, state.tracker, frame, stream, observers, report,
      {.is_possible = [&](const MapPose& pose) { return is_possible(state, stamp_ns, pose); },
       .earlier_pose = earlier_pose(state, stamp_ns)});
  const auto new_piece = place_of_new_piece(state, stamp_ns);
  state.tracked_frames.erase(stamp_ns);
  if (!located) {
    located = dead_reckon(state.tracker, stamp_ns, frame.features, context);
    if (located) report.status = TrackStatus::kTracked;
  }
  if (!located) {
    lose(state.tracker, stamp_ns, state.config.track.coast_s);
    if (new_piece) return begin_piece(state, std::move(frame), new_piece, observers, report);
    return report;
  }
  TrackedPose& tracked = located->tracked;
  report.inliers = tracked.inliers;
  count_sightings(state.map, *located);
  if (report.status == TrackStatus::kTracked) learn_depth_trust(state, tracked, frame.features);
  update_velocity(state.tracker, stamp_ns, tracked.camera_from_world);

  KeyframeId reference = located->reference;
  ++state.tracker.frames_since_keyframe;
  // If the pose comes from another sensor alone, the image may show nothing.
  const bool shows_enough = located->reckoning.is_zero() ||
                            points_with_depth(frame.features) >= state.config.track.min_inliers;
  if (shows_enough &&
      needs_keyframe(tracked, frame.features, reference, state.tracker.frames_since_keyframe,
                     context) &&
      !is_keyframe(state.map, stamp_ns)) {
    reference = add_keyframe(state, frame, tracked, state.map.at(reference).origin, stream.fork(1),
                             observers, report);
    const Keyframe& keyframe = state.map.at(reference);
    tracked.camera_from_world = keyframe.camera_from_world;
    tracked.landmarks = keyframe.landmarks;
  }

  report.world_from_camera = tracked.camera_from_world.inverse();
  report.origin = state.map.at(reference).origin;
  state.tracked_frames[stamp_ns] = {
      reference, tracked.camera_from_world * state.map.camera_from_world(reference).inverse()};
  remember(state.tracker,
           {stamp_ns, tracked.camera_from_world, std::move(frame.features),
            std::move(tracked.landmarks), frame.odom_from_camera},
           reference, located->motion);
  state.tracker.reckoning = located->reckoning;
  state.tracker.inertial = located->inertial;
  if (located->inertial && located->reckoning.is_zero())
    state.tracker.inertial_known = located->inertial->known(tracked.camera_from_world);
  return report;
}

}  // namespace mh
