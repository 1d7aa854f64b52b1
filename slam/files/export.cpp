// SPDX-License-Identifier: Apache-2.0
#include "slam/files/export.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "slam/core/labels.hpp"

namespace mh {
namespace {

struct Edge {
  KeyframeId a, b;
  int shared = 0;
};

/// All pairs that currently share enough landmarks. (Keyframe::covisible dates from its last
/// update, which is recent enough for mapping.)
std::vector<Edge> covisibility(const Map& map) {
  std::vector<Edge> edges;
  std::vector<int> shared(map.keyframes().size());
  for (const Keyframe& k : map.keyframes()) {
    if (k.erased) continue;
    std::fill(shared.begin(), shared.end(), 0);
    for (const LandmarkId landmark : k.landmarks)
      if (landmark.valid())
        for (const Observation& o : map.at(landmark).observations) ++shared[o.keyframe.value];
    for (std::size_t other = k.id.value + 1; other < shared.size(); ++other)
      if (shared[other] >= Map::kMinShared)
        edges.push_back({k.id, map.keyframes()[other].id, shared[other]});
  }
  return edges;
}

std::ptrdiff_t landmarks_seen(const Keyframe& keyframe) {
  return std::count_if(keyframe.landmarks.begin(), keyframe.landmarks.end(),
                       [](LandmarkId id) { return id.valid(); });
}

}  // namespace

std::string landmarks_ply(const Map& map) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\ncomment landmarks; meters; label: class id\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property uchar label\nproperty int observations\nend_header\n",
      map.landmark_count());
  for (const Landmark& l : map.landmarks()) {
    if (l.erased) continue;
    const ClassInfo& info = classes()[l.label];
    const Eigen::Vector3f p = l.position_in_world.cast<float>();
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}\n", p.x(), p.y(), p.z(),
                   info.r, info.g, info.b, l.label, l.observations.size());
  }
  return text;
}

std::string keyframes_ply(const Map& map) {
  const std::vector<Edge> edges = covisibility(map);
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\ncomment keyframes and what they share; meters\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "property int landmarks\n"
      "element edge {}\nproperty int vertex1\nproperty int vertex2\nproperty int shared\n"
      "end_header\n",
      map.keyframe_count(), edges.size());
  std::vector<int> vertex_of(map.keyframes().size(), -1);
  int vertices = 0;
  for (const Keyframe& k : map.keyframes()) {
    if (k.erased) continue;
    vertex_of[k.id.value] = vertices++;
    const Eigen::Vector3f p = k.camera_from_world.inverse().translation().cast<float>();
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", p.x(), p.y(), p.z(),
                   landmarks_seen(k));
  }
  for (const Edge& edge : edges)
    fmt::format_to(std::back_inserter(text), "{} {} {}\n", vertex_of[edge.a.value],
                   vertex_of[edge.b.value], edge.shared);
  return text;
}

std::string keyframes_json(const Map& map) {
  std::string text = "{\n  \"keyframes\": [";
  const char* between = "\n";
  for (const Keyframe& k : map.keyframes()) {
    if (k.erased) continue;
    const SE3 world_from_camera = k.camera_from_world.inverse();
    const Eigen::Vector3d& p = world_from_camera.translation();
    const Eigen::Quaterniond q = world_from_camera.quaternion();
    fmt::format_to(std::back_inserter(text),
                   "{}    {{\"id\": {}, \"stamp_ns\": {}, \"position_m\": [{}, {}, {}], "
                   "\"quaternion_xyzw\": [{}, {}, {}, {}], \"landmarks\": {}}}",
                   between, k.id.value, k.stamp_ns, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(),
                   landmarks_seen(k));
    between = ",\n";
  }
  text += "\n  ],\n  \"edges\": [";
  between = "\n";
  for (const Edge& edge : covisibility(map)) {
    fmt::format_to(std::back_inserter(text), "{}    {{\"a\": {}, \"b\": {}, \"shared\": {}}}",
                   between, edge.a.value, edge.b.value, edge.shared);
    between = ",\n";
  }
  return text + "\n  ]\n}\n";
}

}  // namespace mh
