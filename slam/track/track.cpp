// SPDX-License-Identifier: Apache-2.0
#include "slam/track/track.hpp"

#include <algorithm>
#include <numbers>

#include "slam/config/slam.hpp"
#include "slam/map/id_set.hpp"
#include "slam/match/expect.hpp"

namespace mh {
namespace {

constexpr std::size_t kNeighborsOfEach = 10;
constexpr double kNearest_m = 0.05;

ProjectionTarget target_of(const Eigen::Vector3d& point_in_camera, const Keypoint& from,
                           const Descriptor& descriptor, const Camera& camera, float radius_px,
                           const FeatureConfig& features) {
  const Eigen::Vector2d pixel = camera.project(point_in_camera);
  return {.u_px = static_cast<float>(pixel.x()),
          .v_px = static_cast<float>(pixel.y()),
          .radius_px = radius_px * octave_scale(features, from.octave),
          .min_octave = from.octave - 1,
          .max_octave = from.octave + 1,
          .descriptor = &descriptor,
          .label = from.label,
          .angle_rad = from.angle_rad};
}

/// A point of the last frame: a landmark, or the point behind another keypoint with depth.
struct LastPoint {
  Eigen::Vector3d position_in_world;
  LandmarkId landmark;    // invalid = none
  std::uint32_t feature;  // of the last frame
};

/// The last frame's points that a camera sees.
std::vector<LastPoint> points_in_view(const LastFrame& last, const SE3& camera_from_world,
                                      const Map& map, const Camera& camera) {
  const SE3 world_from_last = last.camera_from_world.inverse();
  std::vector<LastPoint> points;
  for (std::uint32_t i = 0; i < last.features.size(); ++i) {
    const Keypoint& keypoint = last.features.keypoints[i];
    LandmarkId landmark = last.landmarks[i];
    if (landmark.valid() && map.at(landmark).erased) landmark = {};
    if (!landmark.valid() && keypoint.depth_m <= 0) continue;
    const Eigen::Vector3d point = landmark.valid() ? map.at(landmark).position_in_world
                                                   : unproject(keypoint, camera, world_from_last);
    const Eigen::Vector3d in_camera = camera_from_world * point;
    if (in_camera.z() < kNearest_m) continue;
    const Eigen::Vector2d pixel = camera.project(in_camera);
    if (camera.in_image(pixel.x(), pixel.y())) points.push_back({point, landmark, i});
  }
  return points;
}

/// Keyframes with the number of landmarks that they share with the frame; the most first, and the
/// earliest first among equals.
std::vector<std::pair<KeyframeId, int>> by_shared_landmarks(const TrackedPose& tracked,
                                                            const Map& map) {
  std::vector<int> votes(map.keyframes().size(), 0);
  for (const LandmarkId landmark : tracked.landmarks)
    if (landmark.valid())
      for (const Observation& o : map.at(landmark).observations) ++votes[o.keyframe.value];
  std::vector<std::pair<KeyframeId, int>> voted;
  for (std::uint32_t i = 0; i < votes.size(); ++i)
    if (votes[i] > 0) voted.emplace_back(KeyframeId{i}, votes[i]);
  std::stable_sort(voted.begin(), voted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return voted;
}

}  // namespace

KeyframeId reference_of(const TrackedPose& tracked, const Map& map) {
  const auto voted = by_shared_landmarks(tracked, map);
  return voted.empty() ? KeyframeId{} : voted.front().first;
}

std::optional<TrackedPose> optimize_matches(const Query& query,
                                            const std::vector<LandmarkId>& landmarks,
                                            std::span<const PassingPoint> passing, const SE3& guess,
                                            const SlamContext& context) {
  const Camera& camera = context.camera;
  const FeatureConfig& features = context.config.features;
  std::vector<std::uint32_t> feature_of;
  std::vector<PoseObservation> observations =
      observe(query.features, landmarks, context.map, camera, features, feature_of);
  for (const PassingPoint& point : passing) {
    if (landmarks[point.feature].valid()) continue;
    observations.push_back(observe(point.position_in_world, query.features.keypoints[point.feature],
                                   camera, features));
    observations.back().sigma_px *=
        std::numbers::sqrt2;  // the point's own position is as uncertain as the corner
  }
  const auto estimate = estimate_pose(observations, guess, camera, context.config.pose);
  if (!estimate) return std::nullopt;
  TrackedPose tracked{estimate->camera_from_world, std::vector<LandmarkId>(landmarks.size()), 0,
                      estimate->information};
  for (std::size_t j = 0; j < feature_of.size(); ++j)
    if (estimate->inlier[j] != 0) {
      tracked.landmarks[feature_of[j]] = landmarks[feature_of[j]];
      ++tracked.inliers;
    }
  return tracked;
}

std::optional<TrackedPose> track_motion(const Query& query, const LastFrame& last, const SE3& guess,
                                        const SlamContext& context) {
  const Camera& camera = context.camera;
  const TrackConfig& config = context.config.track;
  const std::vector<LastPoint> points = points_in_view(last, guess, context.map, camera);
  std::vector<ProjectionTarget> targets;
  for (const LastPoint& p : points)
    targets.push_back(target_of(guess * p.position_in_world, last.features.keypoints[p.feature],
                                last.features.descriptors[p.feature], camera,
                                static_cast<float>(config.search_radius_px),
                                context.config.features));

  const std::vector<std::uint8_t> taken(query.features.size(), 0);
  const ProjectionGate gate{
      .max_distance = static_cast<float>(context.config.match.max_distance_loose),
      .check_angle = true};
  // A guess that is far off finds few or inconsistent matches: search again with twice the radius,
  // then with four times.
  std::vector<std::int32_t> found;
  std::vector<std::size_t> point_of;
  std::optional<PoseEstimate> estimate;
  constexpr int kSearches = 3;
  for (int search = 1; search <= kSearches && !estimate; ++search) {
    if (search > 1)
      for (ProjectionTarget& target : targets) target.radius_px *= 2.0F;
    found = match_by_projection(targets, query.features, query.grid, taken, gate,
                                semantic_matcher(context, Matcher::kMotionModel));
    point_of.clear();
    for (std::size_t t = 0; t < found.size(); ++t)
      if (found[t] >= 0) point_of.push_back(t);
    const auto enough = static_cast<std::size_t>(2 * config.min_inliers_frame);
    if (point_of.size() < enough && search < kSearches) continue;
    std::vector<PoseObservation> observations;
    for (const std::size_t t : point_of)
      observations.push_back(observe(points[t].position_in_world,
                                     query.features.keypoints[static_cast<std::size_t>(found[t])],
                                     camera, context.config.features));
    estimate = estimate_pose(observations, guess, camera, context.config.pose);
    if (estimate && estimate->inlier_count < config.min_inliers_frame) estimate.reset();
  }

  if (context.trace != nullptr) {
    std::vector<LandmarkId> landmarks;
    std::vector<std::uint32_t> others;
    for (const LastPoint& p : points) {
      landmarks.push_back(p.landmark);
      others.push_back(p.feature);
    }
    trace_projection(context, Matcher::kMotionModel,
                     {{}, query.features, targets, found, landmarks, others});
  }
  if (!estimate) return std::nullopt;

  TrackedPose tracked{estimate->camera_from_world, std::vector<LandmarkId>(query.features.size()),
                      estimate->inlier_count, estimate->information};
  for (std::size_t j = 0; j < point_of.size(); ++j) {
    if (estimate->inlier[j] == 0) continue;
    const LastPoint& p = points[point_of[j]];
    const auto feature = static_cast<std::uint32_t>(found[point_of[j]]);
    if (p.landmark.valid())
      tracked.landmarks[feature] = p.landmark;
    else
      tracked.passing.push_back({feature, p.position_in_world});
  }
  return tracked;
}

int count_that_can_be_found(const LastFrame& last, const SE3& guess, const Map& map,
                            const Camera& camera) {
  const std::vector<LastPoint> points = points_in_view(last, guess, map, camera);
  return static_cast<int>(std::count_if(points.begin(), points.end(), [&](const LastPoint& p) {
    const Eigen::Vector2d pixel = camera.project(guess * p.position_in_world);
    return pixel.x() >= kPatchReach_px && pixel.y() >= kPatchReach_px &&
           pixel.x() < camera.width_px - kPatchReach_px &&
           pixel.y() < camera.height_px - kPatchReach_px;
  }));
}

std::optional<TrackedPose> track_reference(const Query& query, KeyframeId reference,
                                           const SE3& guess, const SlamContext& context) {
  const std::vector<LandmarkId> landmarks =
      match_landmarks(context.map.at(reference), query, context, Matcher::kReferenceKeyframe);
  auto tracked = optimize_matches(query, landmarks, {}, guess, context);
  if (!tracked || tracked->inliers < context.config.track.min_inliers_frame) return std::nullopt;
  return tracked;
}

LocalMap local_map(const TrackedPose& tracked, KeyframeId origin, const SlamContext& context) {
  const Map& map = context.map;
  const auto voted = by_shared_landmarks(tracked, map);

  LocalMap local;
  IdSet<KeyframeId> has;
  const auto limit = static_cast<std::size_t>(context.config.track.local_keyframes);
  const auto take = [&](KeyframeId id) {
    if (!map.at(id).erased && has.insert(id)) local.keyframes.push_back(id);
  };
  for (const auto& [id, count] : voted)
    if (local.keyframes.size() < limit / 2) take(id);

  // Nearby keyframes with a similar view, nearest first.
  const SE3 world_from_camera = tracked.camera_from_world.inverse();
  const double least_cosine = std::cos(context.config.track.near_angle_rad);
  std::vector<std::pair<double, KeyframeId>> near;
  for (const KeyframeId id :
       map.keyframes_near(world_from_camera.translation(), context.config.track.near_distance_m)) {
    if (map.at(id).origin != origin) continue;
    const SE3 world_from_keyframe = map.at(id).camera_from_world.inverse();
    const double distance =
        (world_from_keyframe.translation() - world_from_camera.translation()).norm();
    if (distance > context.config.track.near_distance_m) continue;
    const double cosine =
        world_from_keyframe.rotation().col(2).dot(world_from_camera.rotation().col(2));
    if (cosine < least_cosine) continue;
    near.emplace_back(distance, id);
  }
  std::sort(near.begin(), near.end());
  for (const auto& [distance, id] : near)
    if (local.keyframes.size() < 3 * limit / 4) take(id);

  for (std::size_t i = 0; i < std::min(kNeighborsOfEach, voted.size()); ++i)
    for (const Keyframe::Neighbor& n : map.at(voted[i].first).covisible)
      if (local.keyframes.size() < limit) take(n.id);

  IdSet<LandmarkId> seen;
  for (const KeyframeId id : local.keyframes)
    for (const LandmarkId landmark : map.at(id).landmarks)
      if (landmark.valid() && seen.insert(landmark)) local.landmarks.push_back(landmark);
  return local;
}

namespace {

/// Landmarks of a local map, and where they should appear from a pose.
struct Expected {
  std::vector<ProjectionTarget> targets;
  std::vector<LandmarkId> landmarks;  // of each target
};

/// @param except  landmarks that are left out
Expected expect_in_view(const LocalMap& local, const IdSet<LandmarkId>& except,
                        const SE3& camera_from_world, double radius_px,
                        const SlamContext& context) {
  const Eigen::Vector3d camera_in_world = camera_from_world.inverse().translation();
  Expected expected;
  for (const LandmarkId id : local.landmarks) {
    if (except.contains(id)) continue;
    const auto target =
        expect(context.map.at(id), camera_from_world, camera_in_world, context.camera,
               context.config.features, static_cast<float>(radius_px));
    if (!target) continue;
    expected.targets.push_back(*target);
    expected.landmarks.push_back(id);
  }
  return expected;
}

/// Matches the expected landmarks with the keypoints that have no landmark yet.
/// @param landmarks  per keypoint; receives those that were found
void find_expected(const Expected& expected, const Query& query, double max_distance,
                   const SlamContext& context, std::vector<LandmarkId>& landmarks) {
  std::vector<std::uint8_t> taken;
  for (const LandmarkId id : landmarks) taken.push_back(id.valid() ? 1 : 0);
  const auto found =
      find_landmarks({query,
                      expected.targets,
                      expected.landmarks,
                      taken,
                      {.max_distance = static_cast<float>(max_distance),
                       .ratio = static_cast<float>(context.config.match.ratio_projection)}},
                     context, Matcher::kLocalMap);
  for (std::size_t t = 0; t < found.size(); ++t)
    if (found[t] >= 0) landmarks[static_cast<std::size_t>(found[t])] = expected.landmarks[t];
}

}  // namespace

std::optional<TrackedPose> track_near(const Query& query, const MapPose& guess, double radius_px,
                                      const SlamContext& context) {
  const SE3& pose = guess.camera_from_world;
  const LocalMap local =
      local_map({.camera_from_world = pose, .landmarks = {}}, guess.origin, context);
  std::vector<LandmarkId> landmarks(query.features.size());
  find_expected(expect_in_view(local, {}, pose, radius_px, context), query,
                context.config.match.max_distance, context, landmarks);
  auto tracked = optimize_matches(query, landmarks, {}, pose, context);
  if (tracked && tracked->inliers < context.config.track.min_inliers_frame) tracked.reset();
  return tracked;
}

std::optional<LocalMapResult> track_local_map(const Query& query, const TrackedPose& tracked,
                                              const LocalMap& local, const SlamContext& context) {
  IdSet<LandmarkId> matched;
  std::vector<LandmarkId> landmarks = tracked.landmarks;
  LocalMapResult result;
  for (const LandmarkId id : landmarks)
    if (id.valid()) {
      matched.insert(id);
      result.expected.push_back(id);
    }
  const Expected expected = expect_in_view(local, matched, tracked.camera_from_world,
                                           context.config.track.local_radius_px, context);
  result.expected.insert(result.expected.end(), expected.landmarks.begin(),
                         expected.landmarks.end());
  find_expected(expected, query, context.config.match.max_distance_loose, context, landmarks);
  auto refined =
      optimize_matches(query, landmarks, tracked.passing, tracked.camera_from_world, context);
  if (!refined) return std::nullopt;
  result.tracked = std::move(*refined);
  return result;
}

bool needs_keyframe(const TrackedPose& tracked, const Features& features, KeyframeId reference,
                    int frames_since_keyframe, const SlamContext& context) {
  const KeyframeConfig& config = context.config.keyframe;
  const auto& of_reference = context.map.at(reference).landmarks;
  const auto reference_landmarks = std::count_if(of_reference.begin(), of_reference.end(),
                                                 [](LandmarkId id) { return id.valid(); });
  int close_tracked = 0, close_new = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const float depth = features.keypoints[i].depth_m;
    if (depth <= 0 || depth > config.close_depth_m) continue;
    ++(tracked.landmarks[i].valid() ? close_tracked : close_new);
  }
  // Bundle adjustment does not use the motion model, so the pose of a keyframe that is uncertain
  // from its image alone would drift. But if more close points are new than tracked, the frame may
  // become a keyframe anyway: otherwise, the next one would have too little to track.
  if (tracked.unsure && close_new <= close_tracked) return false;
  const bool thin = close_tracked < config.min_close_tracked && close_new > config.min_close_new;
  const bool drifted =
      tracked.inliers < config.min_tracked_share * static_cast<double>(reference_landmarks);
  const bool old = frames_since_keyframe >= config.max_interval && close_new > config.min_close_new;
  return thin || drifted || old;
}

}  // namespace mh
