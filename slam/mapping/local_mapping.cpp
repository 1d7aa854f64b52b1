// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/local_mapping.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "slam/config/slam.hpp"
#include "slam/map/id_set.hpp"
#include "slam/match/expect.hpp"
#include "slam/optimize/bundle.hpp"
#include "slam/track/motion.hpp"

namespace mh {
namespace {

constexpr std::size_t kMinNewLandmarks = 100;
constexpr std::size_t kTriangulationNeighbors = 8;
constexpr std::size_t kFusionNeighbors = 10;
constexpr std::size_t kAdjustedNeighbors = 10;
constexpr std::size_t kFixedKeyframes = 20;
constexpr double kFoundShare = 0.25;  // least share of the frames in which a young landmark was
                                      // expected that must have found it
constexpr double kMinParallaxCosine = 0.9998;  // about 1.1 degrees between the two rays
constexpr double kChi2Line = 3.84;             // 95 % quantile of chi-square, 1 degree of freedom
constexpr double kChi2Point = 5.991;           // 95 % quantile of chi-square, 2 degrees of freedom

std::vector<KeyframeId> best_neighbors(const Map& map, KeyframeId id, std::size_t count) {
  std::vector<KeyframeId> result;
  for (const Keyframe::Neighbor& n : map.at(id).covisible) {
    if (result.size() == count) break;
    result.push_back(n.id);
  }
  return result;
}

Eigen::Vector3d bearing(const Keypoint& k, const Camera& camera) {
  return camera.unproject(k.u_px, k.v_px, 1.0);
}

/// Epipolar lines of view a's keypoints in view b, and how far b's keypoints are from them.
class EpipolarTest {
 public:
  EpipolarTest(const Features& a, const Features& b, const SE3& b_from_a, const Camera& camera)
      : px2_(camera.fx_px * camera.fy_px) {
    const Eigen::Matrix3d essential = hat(b_from_a.translation()) * b_from_a.rotation();
    for (const Keypoint& k : a.keypoints) lines_.emplace_back(essential * bearing(k, camera));
    for (const Keypoint& k : b.keypoints) bearings_.push_back(bearing(k, camera));
  }
  /// Squared distance (px^2) of a keypoint of b from the line of a keypoint of a.
  double distance2(std::uint32_t a, std::uint32_t b) const {
    // Line in normalized coordinates; focal lengths differ little, so one scale serves both axes.
    const Eigen::Vector3d& line = lines_[a];
    const double norm2 = line.head<2>().squaredNorm();
    if (norm2 < 1e-18) return 1e18;
    const double offset = line.dot(bearings_[b]);
    return offset * offset / norm2 * px2_;
  }

 private:
  double px2_;
  std::vector<Eigen::Vector3d> lines_, bearings_;
};

bool reprojects(const Eigen::Vector3d& point_in_world, const Keyframe& keyframe, const Keypoint& k,
                const Camera& camera, const FeatureConfig& features) {
  const Eigen::Vector3d p = keyframe.camera_from_world * point_in_world;
  if (p.z() < 0.05) return false;
  const double sigma = octave_scale(features, k.octave);
  const Eigen::Vector2d error = camera.project(p) - Eigen::Vector2d(k.u_px, k.v_px);
  return error.squaredNorm() <= kChi2Point * sigma * sigma;
}

/// The midpoint of the shortest segment between two rays (world frame).
std::optional<Eigen::Vector3d> midpoint(const SE3& world_from_a, const SE3& world_from_b,
                                        const Eigen::Vector3d& ray_a,
                                        const Eigen::Vector3d& ray_b) {
  const Eigen::Vector3d da = (world_from_a.rotation() * ray_a).normalized();
  const Eigen::Vector3d db = (world_from_b.rotation() * ray_b).normalized();
  const Eigen::Vector3d between = world_from_b.translation() - world_from_a.translation();
  const double cosine = da.dot(db);
  const double denominator = 1.0 - cosine * cosine;
  if (denominator < 1e-9) return std::nullopt;
  const double sa = (between.dot(da) - cosine * between.dot(db)) / denominator;
  const double sb = (cosine * between.dot(da) - between.dot(db)) / denominator;
  if (sa <= 0 || sb <= 0) return std::nullopt;
  return 0.5 * (world_from_a.translation() + sa * da + world_from_b.translation() + sb * db);
}

/// The point that two matched features show: from parallax if there is enough, otherwise from
/// whichever depth is available; nullopt if it does not reproject onto both features.
std::optional<Eigen::Vector3d> triangulate(const Keyframe& a, const Keypoint& ka, const Keyframe& b,
                                           const Keypoint& kb, const SlamContext& context) {
  const SE3 world_from_a = a.camera_from_world.inverse();
  const SE3 world_from_b = b.camera_from_world.inverse();
  const Eigen::Vector3d ray_a = bearing(ka, context.camera), ray_b = bearing(kb, context.camera);
  const double cosine = (world_from_a.rotation() * ray_a)
                            .normalized()
                            .dot((world_from_b.rotation() * ray_b).normalized());
  std::optional<Eigen::Vector3d> point;
  if (cosine < kMinParallaxCosine) {
    point = midpoint(world_from_a, world_from_b, ray_a, ray_b);
  } else if (ka.depth_m > 0) {
    point = unproject(ka, context.camera, world_from_a);
  } else if (kb.depth_m > 0) {
    point = unproject(kb, context.camera, world_from_b);
  }
  if (!point || !reprojects(*point, a, ka, context.camera, context.config.features) ||
      !reprojects(*point, b, kb, context.camera, context.config.features))
    return std::nullopt;
  return point;
}

/// All landmarks that these keyframes see, each once.
std::vector<LandmarkId> landmarks_of(const Map& map, const std::vector<KeyframeId>& keyframes) {
  IdSet<LandmarkId> seen;
  std::vector<LandmarkId> result;
  for (const KeyframeId id : keyframes)
    for (const LandmarkId l : map.at(id).landmarks)
      if (l.valid() && seen.insert(l)) result.push_back(l);
  return result;
}

void refresh_keyframe(Map& map, KeyframeId keyframe, const SlamContext& context) {
  for (const LandmarkId id : std::vector(map.at(keyframe).landmarks))
    if (id.valid()) map.refresh(id, context.config.features);
}

}  // namespace

void add_landmarks_from_depth(Map& map, KeyframeId keyframe, const SlamContext& context) {
  const SE3 world_from_camera = map.at(keyframe).camera_from_world.inverse();
  std::vector<std::pair<float, std::uint32_t>> by_depth;
  const auto& keypoints = map.at(keyframe).features.keypoints;
  for (std::uint32_t i = 0; i < keypoints.size(); ++i)
    if (keypoints[i].depth_m > 0) by_depth.emplace_back(keypoints[i].depth_m, i);
  std::sort(by_depth.begin(), by_depth.end());

  std::size_t count = 0;
  for (const auto& [depth, i] : by_depth) {
    if (depth > context.config.keyframe.close_depth_m && count >= kMinNewLandmarks) break;
    ++count;
    if (map.at(keyframe).landmarks[i].valid()) continue;
    const Eigen::Vector3d point =
        unproject(map.at(keyframe).features.keypoints[i], context.camera, world_from_camera);
    map.refresh(map.add_landmark(point, keyframe, i), context.config.features);
  }
}

void cull_young_landmarks(Map& map, KeyframeId newest) {
  // Landmark ids increase with their first keyframe: the young ones are at the end.
  for (auto n = static_cast<std::uint32_t>(map.landmarks().size()); n > 0; --n) {
    const Landmark& l = map.at(LandmarkId{n - 1});
    if (l.erased) continue;
    const std::uint32_t age = newest.value - l.first_keyframe.value;
    if (age > 3) break;
    const bool seldom_found = l.found < kFoundShare * l.visible;
    const bool seen_once = age >= 2 && l.observations.size() < 2;
    if (seldom_found || seen_once) map.erase(l.id);
  }
}

void triangulate_with_neighbors(Map& map, KeyframeId keyframe, const SlamContext& context) {
  for (const KeyframeId other : best_neighbors(map, keyframe, kTriangulationNeighbors)) {
    const Keyframe& a = map.at(keyframe);
    const Keyframe& b = map.at(other);
    const SE3 b_from_a = b.camera_from_world * a.camera_from_world.inverse();
    if (b_from_a.translation().norm() < context.camera.baseline_m)
      continue;  // too close for parallax: depth is more accurate
    const EpipolarTest epipolar(a.features, b.features, b_from_a, context.camera);

    const auto unmapped = [](const Keyframe& k) {
      std::vector<std::uint8_t> use(k.features.size());
      for (std::size_t i = 0; i < use.size(); ++i) use[i] = !k.landmarks[i].valid();
      return use;
    };
    const auto on_line = [&](std::uint32_t fa, std::uint32_t fb) {
      const double sigma = octave_scale(context.config.features, b.features.keypoints[fb].octave);
      return epipolar.distance2(fa, fb) < kChi2Line * sigma * sigma;
    };
    const std::vector<std::uint8_t> use_a = unmapped(a), use_b = unmapped(b);
    const auto matches =
        match_by_words({a.features, a.words, use_a}, {b.features, b.words, use_b},
                       {.max_distance = static_cast<float>(context.config.match.max_distance)},
                       semantic_matcher(context, Matcher::kTriangulation), on_line);
    trace_words(context, Matcher::kTriangulation,
                {keyframe, a.features, {}, other, b.features, matches});
    for (const FeatureMatch& m : matches) {
      const auto point = triangulate(map.at(keyframe), map.at(keyframe).features.keypoints[m.a],
                                     map.at(other), map.at(other).features.keypoints[m.b], context);
      if (!point) continue;
      const LandmarkId id = map.add_landmark(*point, keyframe, m.a);
      map.add_observation(id, other, m.b);
      map.refresh(id, context.config.features);
    }
  }
}

namespace {

/// Searches for landmarks in a keyframe: if the matched feature already has a landmark, the one
/// with more observations absorbs the other.
void fuse_into(Map& map, KeyframeId keyframe, const std::vector<LandmarkId>& landmarks,
               const SlamContext& context) {
  constexpr float kRadius_px = 3.0F;
  const Keyframe& k = map.at(keyframe);
  const Eigen::Vector3d camera_in_world = k.camera_from_world.inverse().translation();
  IdSet<LandmarkId> seen;
  for (const LandmarkId id : k.landmarks)
    if (id.valid()) seen.insert(id);

  std::vector<ProjectionTarget> targets;
  std::vector<LandmarkId> target_landmark;
  for (const LandmarkId id : landmarks) {
    if (!id.valid() || map.at(id).erased || !seen.insert(id)) continue;
    const auto target = expect(map.at(id), k.camera_from_world, camera_in_world, context.camera,
                               context.config.features, kRadius_px);
    if (!target) continue;
    targets.push_back(*target);
    target_landmark.push_back(id);
  }
  const std::vector<std::uint8_t> taken(k.features.size(), 0);
  const auto found =
      match_by_projection(targets, k.features, k.grid, taken,
                          {.max_distance = static_cast<float>(context.config.match.max_distance)},
                          semantic_matcher(context, Matcher::kFusion));
  trace_projection(context, Matcher::kFusion,
                   {keyframe, k.features, targets, found, target_landmark});
  for (std::size_t t = 0; t < found.size(); ++t) {
    if (found[t] < 0) continue;
    const auto feature = static_cast<std::uint32_t>(found[t]);
    const LandmarkId mine = map.at(keyframe).landmarks[feature];
    const LandmarkId theirs = target_landmark[t];
    if (map.at(theirs).erased) continue;
    if (!reprojects(map.at(theirs).position_in_world, map.at(keyframe),
                    map.at(keyframe).features.keypoints[feature], context.camera,
                    context.config.features))
      continue;
    if (!mine.valid()) {
      map.add_observation(theirs, keyframe, feature);
    } else if (map.at(mine).observations.size() > map.at(theirs).observations.size()) {
      map.fuse(theirs, mine);
    } else {
      map.fuse(mine, theirs);
    }
  }
}

}  // namespace

void fuse_with_neighbors(Map& map, KeyframeId keyframe, const SlamContext& context) {
  std::vector<KeyframeId> neighbors = best_neighbors(map, keyframe, kFusionNeighbors);
  for (const KeyframeId first : std::vector(neighbors))
    for (const KeyframeId second : best_neighbors(map, first, 5))
      if (second != keyframe &&
          std::find(neighbors.begin(), neighbors.end(), second) == neighbors.end())
        neighbors.push_back(second);

  for (const KeyframeId neighbor : neighbors)
    fuse_into(map, neighbor, std::vector(map.at(keyframe).landmarks), context);
  std::vector<LandmarkId> theirs;
  for (const KeyframeId neighbor : neighbors)
    theirs.insert(theirs.end(), map.at(neighbor).landmarks.begin(),
                  map.at(neighbor).landmarks.end());
  fuse_into(map, keyframe, theirs, context);
}

namespace {

/// The keyframes not among these that see landmarks of these, ordered by how many such landmarks
/// they see.
std::vector<KeyframeId> observing_keyframes(const Map& map,
                                            const std::vector<KeyframeId>& keyframes) {
  std::vector<std::int32_t> sees(map.keyframes().size(), 0);
  for (const LandmarkId l : landmarks_of(map, keyframes))
    for (const Observation& o : map.at(l).observations) ++sees[o.keyframe.value];
  for (const KeyframeId id : keyframes) sees[id.value] = 0;
  std::vector<KeyframeId> result;
  for (std::uint32_t i = 0; i < sees.size(); ++i)
    if (sees[i] > 0) result.push_back(KeyframeId{i});
  std::stable_sort(result.begin(), result.end(),
                   [&](KeyframeId a, KeyframeId b) { return sees[a.value] > sees[b.value]; });
  return result;
}

/// The live keyframes with odometry that come just before and just after a keyframe in time;
/// invalid where there is none.
std::array<KeyframeId, 2> beside_in_time(const Map& map, const Keyframe& keyframe) {
  std::array<KeyframeId, 2> beside;
  for (const Keyframe& k : map.keyframes()) {
    if (k.erased || !k.odom_from_camera || k.stamp_ns == keyframe.stamp_ns ||
        k.origin != keyframe.origin)
      continue;
    const bool is_later = k.stamp_ns > keyframe.stamp_ns;
    KeyframeId& nearest = beside[is_later ? 1 : 0];
    if (!nearest.valid() || (k.stamp_ns < map.at(nearest).stamp_ns) == is_later) nearest = k.id;
  }
  return beside;
}

/// Pairs of successive keyframes that wheel odometry links, at least one of each pair free. If the
/// other one is neither free nor fixed, it is added to the fixed ones.
std::vector<std::pair<KeyframeId, KeyframeId>> wheel_steps(const Map& map,
                                                           const std::vector<KeyframeId>& free,
                                                           std::vector<KeyframeId>& fixed) {
  std::vector<std::pair<KeyframeId, KeyframeId>> steps;
  for (const KeyframeId id : free) {
    if (!map.at(id).odom_from_camera) continue;
    const auto [before, after] = beside_in_time(map, map.at(id));
    for (const auto& [a, b] : {std::pair(before, id), std::pair(id, after)}) {
      if (!a.valid() || !b.valid()) continue;
      if (std::ranges::find(steps, std::pair(a, b)) != steps.end()) continue;
      steps.emplace_back(a, b);
      for (const KeyframeId end : {a, b})
        if (std::ranges::find(free, end) == free.end() &&
            std::ranges::find(fixed, end) == fixed.end())
          fixed.push_back(end);
    }
  }
  return steps;
}

BundleMotion motion_of(const Keyframe& a, const Keyframe& b) {
  constexpr double kLeast_m = 0.005, kLeast_rad = 0.005;  // errors of joints and stamps
  BundleMotion motion;
  motion.b_from_a = b.odom_from_camera->inverse() * *a.odom_from_camera;
  const Vector6d twist = motion.b_from_a.log();
  const PoseSigma drift = odometry_drift(twist.head<3>().norm(), twist.tail<3>().norm());
  motion.sigma_m = kLeast_m + drift.position_m;
  motion.sigma_rad = kLeast_rad + drift.angle_rad;
  return motion;
}

/// Adjusts the free keyframes and all landmarks that they see; the fixed ones define the frame of
/// reference. Without fixed keyframes, nothing is adjusted.
void adjust_keyframes(Map& map, const std::vector<KeyframeId>& free, std::vector<KeyframeId> fixed,
                      const SlamContext& context) {
  const auto steps = wheel_steps(map, free, fixed);
  if (free.empty() || fixed.empty()) return;
  std::vector<std::int32_t> pose_of(map.keyframes().size(), -1);
  BundleProblem problem;
  problem.free_poses = static_cast<std::uint32_t>(free.size());
  const auto add_pose = [&](KeyframeId id) {
    pose_of[id.value] = static_cast<std::int32_t>(problem.camera_from_world.size());
    problem.camera_from_world.push_back(map.at(id).camera_from_world);
  };
  for (const KeyframeId id : free) add_pose(id);
  for (const KeyframeId id : fixed) add_pose(id);
  for (const auto& [a, b] : steps) {
    BundleMotion motion = motion_of(map.at(a), map.at(b));
    motion.a = static_cast<std::uint32_t>(pose_of[a.value]);
    motion.b = static_cast<std::uint32_t>(pose_of[b.value]);
    problem.motions.push_back(motion);
  }

  const std::vector<LandmarkId> points = landmarks_of(map, free);
  std::vector<Observation> observation_of;
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    const Landmark& l = map.at(points[p]);
    problem.points_in_world.push_back(l.position_in_world);
    for (const Observation& o : l.observations) {
      const std::int32_t pose = pose_of[o.keyframe.value];
      if (pose < 0) continue;
      const PoseObservation seen_at =
          observe(l.position_in_world, map.at(o.keyframe).features.keypoints[o.feature],
                  context.camera, context.config.features);
      problem.observations.push_back({.pose = static_cast<std::uint32_t>(pose),
                                      .point = p,
                                      .u_px = static_cast<float>(seen_at.u_px),
                                      .v_px = static_cast<float>(seen_at.v_px),
                                      .disparity_px = static_cast<float>(seen_at.disparity_px),
                                      .sigma_px = static_cast<float>(seen_at.sigma_px)});
      observation_of.push_back(o);
    }
  }

  const BundleResult result = adjust(problem, context.camera, context.config.bundle);
  for (std::size_t i = 0; i < free.size(); ++i)
    map.set_pose(free[i], result.camera_from_world[i].normalized());
  for (std::size_t p = 0; p < points.size(); ++p)
    map.set_position(points[p], result.points_in_world[p]);
  for (std::size_t j = 0; j < observation_of.size(); ++j)
    if (result.outlier[j] != 0)
      map.erase_observation(points[problem.observations[j].point], observation_of[j].keyframe);
  for (const LandmarkId l : points) map.refresh(l, context.config.features);
}

}  // namespace

void adjust_neighborhood(Map& map, KeyframeId keyframe, const SlamContext& context) {
  // Free: the keyframe and its best neighbors, but never the one that defines their world.
  const KeyframeId origin = map.at(keyframe).origin;
  std::vector<KeyframeId> free;
  if (keyframe != origin) free.push_back(keyframe);
  for (const KeyframeId id : best_neighbors(map, keyframe, kAdjustedNeighbors))
    if (id != origin) free.push_back(id);
  std::vector<KeyframeId> fixed = observing_keyframes(map, free);
  if (fixed.size() > kFixedKeyframes) fixed.resize(kFixedKeyframes);
  adjust_keyframes(map, free, fixed, context);
}

void adjust_piece(Map& map, KeyframeId origin, const SlamContext& context) {
  std::vector<KeyframeId> free;
  for (const Keyframe& k : map.keyframes())
    if (!k.erased && k.origin == origin && k.id != origin) free.push_back(k.id);
  adjust_keyframes(map, free, {origin}, context);
}

void cull_redundant_keyframes(Map& map, KeyframeId newest, const SlamContext& context) {
  for (const KeyframeId id : best_neighbors(map, newest, map.keyframes().size())) {
    const Keyframe& k = map.at(id);
    // The latest few keyframes are kept, since tracking depends on them.
    if (id == k.origin || newest.value - id.value < 3) continue;
    int total = 0, redundant = 0;
    for (std::size_t i = 0; i < k.landmarks.size(); ++i) {
      const Keypoint& keypoint = k.features.keypoints[i];
      if (!k.landmarks[i].valid() || keypoint.depth_m <= 0 ||
          keypoint.depth_m > context.config.keyframe.close_depth_m)
        continue;
      ++total;
      int others = 0;
      for (const Observation& o : map.at(k.landmarks[i]).observations)
        others += o.keyframe != id &&
                  map.at(o.keyframe).features.keypoints[o.feature].octave <= keypoint.octave + 1;
      redundant += others >= 3;
    }
    if (redundant > context.config.keyframe.redundant_share * total) map.erase(id);
  }
}

void map_keyframe(Map& map, KeyframeId keyframe, const SlamContext& context) {
  cull_young_landmarks(map, keyframe);
  map.update_covisibility(keyframe);
  triangulate_with_neighbors(map, keyframe, context);
  fuse_with_neighbors(map, keyframe, context);
  refresh_keyframe(map, keyframe, context);
  map.update_covisibility(keyframe);
  adjust_neighborhood(map, keyframe, context);
  cull_redundant_keyframes(map, keyframe, context);
}

}  // namespace mh
