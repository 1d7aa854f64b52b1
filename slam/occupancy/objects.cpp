// SPDX-License-Identifier: Apache-2.0
#include "slam/occupancy/objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/lower_case.hpp"
#include "slam/io/suggest.hpp"

namespace mh {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Classes that are structure or otherwise not objects.
constexpr std::array<ClassId, 10> kNotThings = {
    kVoid,      1 /*wall*/,     2 /*floor*/,           8 /*door*/,    9 /*window*/,
    20 /*mat*/, 22 /*ceiling*/, 38 /*otherstructure*/, 31 /*person*/, kBackground};

struct LabeledVoxel {
  Vector3i index;
  std::uint32_t votes, all_votes;
};

/// Sets that merge (union-find); the representative is the smallest member.
class Groups {
 public:
  explicit Groups(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void merge(std::size_t a, std::size_t b) {
    a = of(a), b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Half of a voxel's 26 neighbors, so that each pair is visited once: the other half are their
/// opposites.
const std::vector<Vector3i>& forward_neighbors() {
  static const std::vector<Vector3i> kAll = [] {
    std::vector<Vector3i> all;
    for (int z = 0; z <= 1; ++z)
      for (int y = z == 0 ? 0 : -1; y <= 1; ++y)
        for (int x = z == 0 && y == 0 ? 1 : -1; x <= 1; ++x) all.emplace_back(x, y, z);
    return all;
  }();
  return kAll;
}

/// Voxels of one object, or of a part of one.
struct Cluster {
  std::vector<std::size_t> voxels;
  Vector3i low, high;                      ///< both included
  std::set<DetectedObjects::Id> detected;  ///< which detected objects they belong to
};

using Detected = std::set<DetectedObjects::Id>;

bool are_apart(const Detected& a, const Detected& b, const DetectedObjects& detected) {
  return std::ranges::any_of(a, [&](DetectedObjects::Id i) {
    return std::ranges::any_of(b, [&](DetectedObjects::Id j) { return detected.are_apart(i, j); });
  });
}

/// Voxels that touch, corners included, unless they belong to objects that are apart. Where three
/// clusters touch but may not all merge, the two with the longest common border merge.
std::vector<Cluster> clusters_of(const std::vector<LabeledVoxel>& voxels,
                                 const DetectedObjects& detected) {
  std::unordered_map<std::uint64_t, std::size_t> at;  // only looked up, never iterated over
  at.reserve(voxels.size());
  for (std::size_t i = 0; i < voxels.size(); ++i) at.emplace(key_of(voxels[i].index), i);
  Groups groups(voxels.size());
  std::vector<DetectedObjects::Id> ids;
  for (const LabeledVoxel& voxel : voxels) ids.push_back(detected.at(voxel.index));
  std::vector<std::pair<std::size_t, std::size_t>> borders;
  for (std::size_t i = 0; i < voxels.size(); ++i)
    for (const Vector3i& neighbor : forward_neighbors()) {
      const auto other = at.find(key_of(voxels[i].index + neighbor));
      if (other == at.end()) continue;
      if (ids[i] == ids[other->second])
        groups.merge(i, other->second);
      else
        borders.emplace_back(i, other->second);
    }
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> lengths;
  for (const auto& [i, j] : borders) ++lengths[std::minmax(groups.of(i), groups.of(j))];
  std::map<std::size_t, Detected> of_group;
  for (std::size_t i = 0; i < voxels.size(); ++i)
    if (ids[i] != 0) of_group[groups.of(i)].insert(ids[i]);
  std::vector<std::pair<std::size_t, std::pair<std::size_t, std::size_t>>> longest;
  for (const auto& [pair, length] : lengths) longest.emplace_back(length, pair);
  std::ranges::stable_sort(longest, std::ranges::greater(), [](const auto& l) { return l.first; });
  for (const auto& [length, pair] : longest) {
    const std::size_t a = groups.of(pair.first), b = groups.of(pair.second);
    if (a == b || are_apart(of_group[a], of_group[b], detected)) continue;
    Detected both = of_group[a];
    both.merge(of_group[b]);
    groups.merge(a, b);
    of_group[groups.of(a)] = std::move(both);
  }
  std::map<std::size_t, Cluster> by_first;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    Cluster& cluster = by_first[groups.of(i)];
    const Vector3i& v = voxels[i].index;
    cluster.low = cluster.voxels.empty() ? v : cluster.low.cwiseMin(v).eval();
    cluster.high = cluster.voxels.empty() ? v : cluster.high.cwiseMax(v).eval();
    cluster.voxels.push_back(i);
    if (ids[i] != 0) cluster.detected.insert(ids[i]);
  }
  std::vector<Cluster> clusters;
  for (auto& [first, cluster] : by_first) clusters.push_back(std::move(cluster));
  return clusters;
}

/// Overlap of two clusters' boxes, seen from above, as a share of the smaller box's area.
double shared_above(const Cluster& a, const Cluster& b) {
  double shared = 1, of_a = 1, of_b = 1;
  for (int axis = 0; axis < 2; ++axis) {
    shared *=
        std::max(0, std::min(a.high[axis], b.high[axis]) - std::max(a.low[axis], b.low[axis]) + 1);
    of_a *= a.high[axis] - a.low[axis] + 1;
    of_b *= b.high[axis] - b.low[axis] + 1;
  }
  return shared / std::min(of_a, of_b);
}

void absorb(Cluster& into, const Cluster& part) {
  into.voxels.insert(into.voxels.end(), part.voxels.begin(), part.voxels.end());
  into.low = into.low.cwiseMin(part.low);
  into.high = into.high.cwiseMax(part.high);
  into.detected.insert(part.detected.begin(), part.detected.end());
}

/// Whether a cluster is a fragment of a larger one: it has at most a quarter of its voxels, is not
/// known to be apart from it, and is close beside, above or below it, where missing depth left a
/// gap.
bool is_fragment(const Cluster& small, const Cluster& large, const DetectedObjects& detected,
                 int gap, int stacked_gap) {
  if (4 * small.voxels.size() > large.voxels.size()) return false;
  if (are_apart(small.detected, large.detected, detected)) return false;
  const Vector3i apart = (small.low - large.high).cwiseMax(large.low - small.high).array() -
                         1;  // empty voxels between the two boxes
  if (apart.maxCoeff() <= gap) return true;
  return apart.z() <= stacked_gap && shared_above(small, large) >= 0.5;
}

/// Merges each fragment into the largest cluster that it may belong to.
void merge_fragments(std::vector<Cluster>& clusters, const DetectedObjects& detected, int gap,
                     int stacked_gap) {
  std::ranges::stable_sort(clusters, std::ranges::greater(),
                           [](const Cluster& c) { return c.voxels.size(); });
  std::vector<Cluster> merged;
  for (const Cluster& cluster : clusters) {
    const auto whole = std::ranges::find_if(merged, [&](const Cluster& large) {
      return is_fragment(cluster, large, detected, gap, stacked_gap);
    });
    if (whole == merged.end())
      merged.push_back(cluster);
    else
      absorb(*whole, cluster);
  }
  clusters = std::move(merged);
}

/// Extent of an object's votes along an axis: least and greatest index. The outermost hundredth of
/// the votes on each side is ignored, since voxels with few votes at an object's edges are noise.
std::pair<int, int> extent_of(const Cluster& cluster, const std::vector<LabeledVoxel>& voxels,
                              int axis) {
  std::map<int, std::uint64_t> votes;
  std::uint64_t all = 0;
  for (const std::size_t i : cluster.voxels) {
    votes[voxels[i].index[axis]] += voxels[i].votes;
    all += voxels[i].votes;
  }
  const auto most_beyond = static_cast<double>(all) * 0.01;
  auto low = votes.begin();
  for (std::uint64_t sum = low->second; static_cast<double>(sum) <= most_beyond; sum += low->second)
    ++low;
  auto high = std::prev(votes.end());
  for (std::uint64_t sum = high->second; static_cast<double>(sum) <= most_beyond;
       sum += high->second)
    --high;
  return {low->first, high->first};
}

MapObject object_of(const Cluster& cluster, const std::vector<LabeledVoxel>& voxels, double r,
                    const ObjectsConfig& config) {
  MapObject object;
  object.min_m.z() = r * cluster.low.z();  // legs are thin: few votes are not noise there
  object.max_m.z() = r * (cluster.high.z() + 1);
  for (int axis = 0; axis < 2; ++axis) {
    const auto [low, high] = extent_of(cluster, voxels, axis);
    object.min_m[axis] = r * low;
    object.max_m[axis] = r * (high + 1);
  }
  object.center_m = 0.5 * (object.min_m + object.max_m);
  object.voxels = cluster.voxels.size();
  double votes = 0, all = 0;
  for (const std::size_t i : cluster.voxels) votes += voxels[i].votes, all += voxels[i].all_votes;
  const double seen = static_cast<double>(object.voxels) / (4.0 * config.min_voxels);
  object.score = votes / all * std::min(1.0, seen);
  return object;
}

std::string list(const Vector3d& v) {
  return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", v.x(), v.y(), v.z());
}

}  // namespace

bool is_thing(ClassId class_id) {
  return class_id < classes().size() && std::ranges::find(kNotThings, class_id) == kNotThings.end();
}

std::vector<MapObject> find_objects(const VoxelMap& map, const ObjectsConfig& config) {
  std::vector<std::vector<LabeledVoxel>> by_class(classes().size());
  map.for_each([&](const Voxel& voxel) {
    if (!voxel.occupied || !is_thing(voxel.label)) return;
    const std::uint32_t all = voxel.votes;
    if (voxel.label_views < config.min_label_share * all) return;
    by_class[voxel.label].push_back({voxel.index, voxel.label_views, all});
  });
  const double r = map.resolution_m();
  const int gap = static_cast<int>(std::lround(config.gap_m / r));
  std::vector<MapObject> objects;
  for (std::size_t id = 0; id < by_class.size(); ++id) {
    std::vector<Cluster> clusters = clusters_of(by_class[id], map.detected());
    merge_fragments(clusters, map.detected(), gap,
                    static_cast<int>(std::lround(config.stacked_gap_m / r)));
    int number = 0;
    for (const Cluster& cluster : clusters) {
      if (cluster.voxels.size() < static_cast<std::size_t>(config.min_voxels)) continue;
      MapObject object = object_of(cluster, by_class[id], r, config);
      object.class_id = static_cast<ClassId>(id);
      object.name = fmt::format("{} {}", classes()[id].name, ++number);
      objects.push_back(std::move(object));
    }
  }
  return objects;
}

std::vector<std::size_t> objects_named(const std::vector<MapObject>& objects,
                                       std::string_view name) {
  std::vector<std::size_t> meant;
  std::string plain = lower_case(std::string(name));  // "Potted_Plant" means "potted plant"
  std::ranges::replace(plain, '_', ' ');
  const std::optional<ClassId> class_id = class_by_name(plain);
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i].name == plain || (class_id && objects[i].class_id == *class_id))
      meant.push_back(i);
  if (meant.empty()) {
    std::vector<std::string> there;
    for (const MapObject& object : objects) {
      const std::string_view of_class = classes()[object.class_id].name;
      if (there.empty() || there.back() != of_class) there.emplace_back(of_class);
    }
    const char* why = !class_id             ? "no class and no object has this name"
                      : is_thing(*class_id) ? "the map holds none"
                                            : "is never an object in a map";
    throw InputError(fmt::format("object '{}': {}{}", name, why, hint(plain, there)));
  }
  std::ranges::stable_sort(meant, std::ranges::greater(),
                           [&](std::size_t i) { return objects[i].score; });
  return meant;
}

std::string objects_json(const std::vector<MapObject>& objects, double resolution_m) {
  std::string text = fmt::format("{{\n  \"resolution_m\": {},\n  \"objects\": [", resolution_m);
  const char* between = "\n";
  for (const MapObject& o : objects) {
    text += fmt::format(
        "{}    {{\"name\": \"{}\", \"class\": \"{}\", \"class_id\": {}, \"score\": {:.3f}, "
        "\"voxels\": {},\n     \"center_m\": {}, \"min_m\": {}, \"max_m\": {}}}",
        between, o.name, classes()[o.class_id].name, o.class_id, o.score, o.voxels,
        list(o.center_m), list(o.min_m), list(o.max_m));
    between = ",\n";
  }
  return text + "\n  ]\n}\n";
}

}  // namespace mh
