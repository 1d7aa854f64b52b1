// SPDX-License-Identifier: Apache-2.0
#include "bench/audit/replay/replay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <meshoptimizer.h>

#include "bench/audit/audit.hpp"
#include "bench/audit/replay/views.hpp"
#include "bench/report/packed.hpp"
#include "scenes/mesh_io/seen_colors.hpp"
#include "slam/core/labels.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

/// Size of a mesh in base64: 9 bytes per vertex, 12 per triangle.
std::size_t bytes_of(std::size_t vertices, std::size_t triangles) {
  return (9 * vertices + 12 * triangles) * 4 / 3;
}

/// The scene with its faces split as finely as the size limit allows.
Scene with_small_faces(const Scene& scene) {
  for (const float edge_m : {0.08F, 0.12F, 0.18F, 0.27F, 0.4F, 0.6F, 1.0F}) {
    Scene split = split_for_colors(scene, edge_m);
    if (bytes_of(split.positions_m.size(), split.triangles.size()) <= kMeshBytes) return split;
  }
  return scene;
}

/// How many vertices the triangles use.
std::size_t used_vertices(const std::vector<std::uint32_t>& corners, std::size_t vertices) {
  std::vector<bool> used(vertices);
  for (const std::uint32_t corner : corners) used[corner] = true;
  return static_cast<std::size_t>(std::ranges::count(used, true));
}

/// The corners of a simplified scene with as many triangles as the size limit allows.
std::vector<std::uint32_t> decimated(const Scene& scene) {
  std::vector<std::uint32_t> all;
  all.reserve(3 * scene.triangles.size());
  for (const auto& triangle : scene.triangles)
    all.insert(all.end(), triangle.begin(), triangle.end());
  const std::size_t vertices = scene.positions_m.size();
  const float* const first = scene.positions_m.front().data();
  std::vector<std::uint32_t> few = all;
  for (std::size_t target = all.size();
       bytes_of(used_vertices(few, vertices), few.size() / 3) > kMeshBytes && target > 3;
       target = target / 12 * 9) {
    few.resize(all.size());
    few.resize(meshopt_simplify(few.data(), all.data(), all.size(), first, vertices,
                                sizeof(Eigen::Vector3f), target, 0.02F, 0, nullptr));
    if (few.size() <= target + target / 4) continue;
    // If the scene has many loose parts, only this second method reaches the limit.
    few.resize(all.size());
    few.resize(meshopt_simplifySloppy(few.data(), all.data(), all.size(), first, vertices,
                                      sizeof(Eigen::Vector3f), target, 0.1F, nullptr));
  }
  return few;
}

Json landmarks_json(const Map& map, const SE3& to_dock) {
  Json mm = Json::array(), classes = Json::array();
  std::array<bool, 256> used{};
  for (const Landmark& landmark : map.landmarks()) {
    if (landmark.erased) continue;
    const Eigen::Vector3d at = to_dock * landmark.position_in_world;
    for (int i = 0; i < 3; ++i) mm.push_back(std::lround(at[i] * 1e3));
    classes.push_back(landmark.label);
    used[landmark.label] = true;
  }
  Json names = Json::object();
  for (const ClassInfo& info : mh::classes())
    if (used[info.id])
      names[std::to_string(info.id)] = {
          {"name", info.name},
          {"color", fmt::format("#{:02x}{:02x}{:02x}", info.r, info.g, info.b)}};
  return {{"mm", mm}, {"class", classes}, {"classes", names}};
}

Json keyframes_json(const Map& map, const SE3& to_dock) {
  Json list = Json::array();
  for (const Keyframe& keyframe : map.keyframes()) {
    if (keyframe.erased) continue;
    const SE3 pose = to_dock * keyframe.camera_from_world.inverse();
    Json one = Json::array();
    for (int i = 0; i < 3; ++i) one.push_back(std::lround(pose.translation()[i] * 1e3));
    const Eigen::Quaterniond turn = pose.quaternion();
    for (const double part : turn.coeffs()) one.push_back(std::lround(part * 1e4));
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace

Json mesh_json(const Scene& whole) {
  if (whole.triangles.empty()) return nullptr;
  const Scene scene = with_small_faces(whole);
  const std::vector<Rgb8> colors = seen_colors(scene);
  const std::vector<std::uint32_t> corners = decimated(scene);
  Eigen::Vector3f low = scene.positions_m.front(), high = low;
  for (const Eigen::Vector3f& p : scene.positions_m) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Eigen::Vector3f step = ((high - low) / 65535.0F).cwiseMax(1e-9F);
  constexpr std::uint32_t kUnused = 0xffffffff;
  std::vector<std::uint32_t> place(scene.positions_m.size(), kUnused);
  std::vector<std::uint8_t> positions, shades, indices;
  std::uint32_t count = 0;
  for (const std::uint32_t corner : corners) {
    if (place[corner] == kUnused) {
      place[corner] = count++;
      for (int i = 0; i < 3; ++i)
        put(positions,
            static_cast<std::uint32_t>(
                std::lround((scene.positions_m[corner][i] - low[i]) / step[i])),
            2);
      for (const std::uint8_t channel : {colors[corner].r, colors[corner].g, colors[corner].b})
        shades.push_back(channel);
    }
    put(indices, place[corner], 4);
  }
  return {{"low_m", {low.x(), low.y(), low.z()}},
          {"step_m", {step.x(), step.y(), step.z()}},
          {"vertices", count},
          {"triangles", corners.size() / 3},
          {"of_triangles", whole.triangles.size()},
          {"positions", base64(positions)},
          {"colors", base64(shades)},
          {"indices", base64(indices)}};
}

Replay make_replay(const RunResult& result, const ReplayTools& tools) {
  const RunSpec& spec = result.spec;
  require_auditable(spec);
  const World world = build_world(spec, tools.threads, tools.cache, tools.say);
  for (const InputDigest& input : world.inputs)
    if (std::ranges::find(result.place.inputs, input) == result.place.inputs.end())
      throw InputChanged(fmt::format(
          "{}: its '{}' was changed since this result was made: run the suite again, or put the "
          "file back",
          spec.name, input.name));
  SlamState frozen;
  tools.say(fmt::format("{}: runs again", spec.name));
  const RunResult run = run_with_map(spec, world, {.maps = tools.cache}, frozen);
  const SE3& to_dock = run.alignment.dock_from_estimate;
  const auto is_same = [](const TimedPose& a, const TimedPose& b) {
    return a.stamp_ns == b.stamp_ns &&
           a.world_from_camera.translation() == b.world_from_camera.translation();
  };
  Json scene = {{"run", spec.name},
                {"same", std::ranges::equal(run.estimate, result.estimate, is_same)},
                {"mesh", mesh_json(*world.simulated->scene)},
                {"landmarks", landmarks_json(frozen.map, to_dock)},
                {"keyframes", keyframes_json(frozen.map, to_dock)}};
  Replay replay{.scene = std::move(scene), .views = views_json(run, world, frozen)};
  require_unchanged(world.held);
  return replay;
}

}  // namespace mh
