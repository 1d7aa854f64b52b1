// SPDX-License-Identifier: Apache-2.0
#include "slam/loop/loop.hpp"

#include <algorithm>

#include "slam/map/id_set.hpp"
#include "slam/match/expect.hpp"
#include "slam/optimize/pose_graph.hpp"

namespace mh {
namespace {

/// Covisible keyframes that share this many landmarks hold each other's relative pose well.
constexpr int kStrongEdge = 100;

/// Tells the keyframes that may be the newest one's other end of a loop.
class Unrelated {
 public:
  Unrelated(const Map& map, KeyframeId newest, const LoopConfig& config)
      : map_(map), newest_(newest), min_gap_(static_cast<std::uint32_t>(config.min_gap)) {
    related_.insert(newest);
    for (const Keyframe::Neighbour& n : map.at(newest).covisible)
      if (n.shared >= config.loosely_shared) related_.insert(n.id);
  }
  bool operator()(KeyframeId id) const {
    return id.value + min_gap_ <= newest_.value && !map_.at(id).erased && !related_.contains(id);
  }

 private:
  const Map& map_;
  KeyframeId newest_;
  std::uint32_t min_gap_;
  IdSet<KeyframeId> related_;
};

std::vector<KeyframeId> candidates(const Map& map, KeyframeId newest,
                                   const SemanticConfig& semantics, const LoopConfig& config) {
  const Unrelated is_old(map, newest, config);
  const auto view = [&](KeyframeId k) {
    return config.augmented ? map.at(k).words.vector : words_alone(map.at(k).words.vector);
  };
  const AugmentedVector query = view(newest);

  // No candidate may be much less alike than the neighbours that are known to see the same.
  double least = 1.0;
  for (const Keyframe::Neighbour& n : map.at(newest).covisible)
    if (n.shared >= kStrongEdge) least = std::min(least, l1_similarity(query, view(n.id)));

  std::vector<KeyframeId> old;
  std::vector<int> shared(map.keyframes().size(), 0);
  for (const InvertedIndex::Score& s : map.sharing(query))
    if (is_old(s.keyframe)) {
      old.push_back(s.keyframe);
      shared[s.keyframe.value] = s.shared_words + s.shared_labels;
    }
  // A keyframe is asked for once per neighbourhood that it belongs to.
  std::vector<double> known(map.keyframes().size(), -1.0);
  const auto similarity = [&](KeyframeId k) {
    double& s = known[k.value];
    if (s < 0) s = l1_similarity(query, view(k));
    return s;
  };
  const auto selection = select_candidates(
      std::span<const KeyframeId>(old), [&](KeyframeId k) { return shared[k.value]; },
      [&](KeyframeId k) {
        std::vector<KeyframeId> group{k};
        for (const Keyframe::Neighbour& n : map.at(k).covisible)
          if (group.size() <= 10 && is_old(n.id)) group.push_back(n.id);
        return group;
      },
      similarity, semantics.alpha, semantics.beta);
  std::vector<KeyframeId> result;
  for (const auto& candidate : selection.candidates)
    if (similarity(candidate.keyframe) >= config.min_similarity_share * least)
      result.push_back(candidate.keyframe);
  return result;
}

struct Graph {
  std::vector<KeyframeId> keyframes;  // of each pose; the first is the map's first standing one
  std::vector<SE3> poses;
  std::vector<PoseGraphEdge> edges;
};

/// The essential graph: each keyframe with its best earlier neighbour, with those that share much,
/// and the loop.
Graph essential_graph(const Map& map, const Loop& loop) {
  Graph graph;
  std::vector<std::uint32_t> index(map.keyframes().size(), UINT32_MAX);
  for (const Keyframe& k : map.keyframes()) {
    if (k.erased) continue;
    index[k.id.value] = static_cast<std::uint32_t>(graph.keyframes.size());
    graph.keyframes.push_back(k.id);
    graph.poses.push_back(k.camera_from_world);
  }
  const auto connect = [&](KeyframeId a, KeyframeId b, const SE3& a_from_b) {
    graph.edges.push_back({index[a.value], index[b.value], a_from_b});
  };
  for (std::size_t i = 1; i < graph.keyframes.size(); ++i) {
    const Keyframe& k = map.at(graph.keyframes[i]);
    bool has_parent = false;
    for (const Keyframe::Neighbour& n : k.covisible) {
      if (!(n.id < k.id)) continue;
      if (has_parent && n.shared < kStrongEdge) break;  // most shared first
      has_parent = true;
      connect(k.id, n.id, k.camera_from_world * map.at(n.id).camera_from_world.inverse());
    }
    if (!has_parent) {
      const Keyframe& before = map.at(graph.keyframes[i - 1]);
      connect(k.id, before.id, k.camera_from_world * before.camera_from_world.inverse());
    }
  }
  connect(loop.keyframe, loop.old_keyframe,
          loop.camera_from_world * map.at(loop.old_keyframe).camera_from_world.inverse());
  return graph;
}

void spread_drift(Map& map, const Loop& loop) {
  const Graph graph = essential_graph(map, loop);
  const std::vector<SE3> poses = optimize_pose_graph(graph.poses, graph.edges);
  std::vector<SE3> moved(map.keyframes().size());  // new world from old world, per keyframe
  for (std::size_t i = 0; i < poses.size(); ++i)
    moved[graph.keyframes[i].value] = poses[i].inverse() * graph.poses[i];
  for (const Landmark& l : map.landmarks())
    if (!l.erased)
      map.set_position(l.id, moved[l.observations.front().keyframe.value] * l.position_in_world);
  for (std::size_t i = 0; i < poses.size(); ++i) map.set_pose(graph.keyframes[i], poses[i]);
}

/// Old landmarks take over what the newest keyframe sees of them.
void join_landmarks(Map& map, const Loop& loop) {
  for (std::uint32_t i = 0; i < loop.landmarks.size(); ++i) {
    const LandmarkId old = loop.landmarks[i];
    if (!old.valid() || map.at(old).erased) continue;
    const LandmarkId mine = map.at(loop.keyframe).landmarks[i];
    if (mine.valid())
      map.fuse(mine, old);
    else
      map.add_observation(old, loop.keyframe, i);
  }
}

}  // namespace

std::optional<Loop> detect_loop(const Map& map, KeyframeId newest, LoopMemory& memory,
                                const MappingContext& context, const RelocalizeConfig& relocalize,
                                const LoopConfig& config, RandomStream stream,
                                MatchCounts& counts) {
  const Keyframe& keyframe = map.at(newest);
  const auto found =
      try_candidates({keyframe.features, keyframe.grid, keyframe.words},
                     candidates(map, newest, context.semantics, config), map, context.camera,
                     context.features, context.semantics, context.match, relocalize, stream, counts,
                     {.words = Matcher::kLoop, .projection = Matcher::kLoop}, context.trace);
  if (!found.camera_from_world) return std::nullopt;
  const SE3 drift = found.camera_from_world->inverse() * keyframe.camera_from_world;
  const bool agrees =
      memory.drift &&
      newest.value - memory.keyframe.value <= static_cast<std::uint32_t>(config.patience) &&
      (memory.drift->translation() - drift.translation()).norm() < config.same_drift_m &&
      angle_between_rad(*memory.drift, drift) < config.same_drift_rad;
  memory = {.drift = drift, .keyframe = newest, .agreeing = agrees ? memory.agreeing + 1 : 1};
  if (memory.agreeing < config.agreeing) return std::nullopt;
  memory = {};
  return Loop{newest, found.keyframe, *found.camera_from_world, found.landmarks};
}

void close_loop(Map& map, const Loop& loop, const MappingContext& context, const LoopConfig& config,
                MatchCounts& counts) {
  const SE3 drift = loop.camera_from_world.inverse() * map.at(loop.keyframe).camera_from_world;
  const bool negligible = drift.translation().norm() < config.negligible_m &&
                          angle_between_rad(drift, SE3()) < config.negligible_rad;
  if (!negligible) spread_drift(map, loop);
  join_landmarks(map, loop);
  map.update_covisibility(loop.keyframe);
  map.update_covisibility(loop.old_keyframe);
  fuse_with_neighbours(map, loop.keyframe, context, at(counts, Matcher::kFusion));
  map.update_covisibility(loop.keyframe);
  if (negligible)
    adjust_neighbourhood(map, loop.keyframe, context);
  else
    adjust_all(map, context);
}

}  // namespace mh
