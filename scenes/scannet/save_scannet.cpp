// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "scenes/mesh_io/ply.hpp"
#include "scenes/mesh_io/seen_colors.hpp"
#include "scenes/scannet/annotation.hpp"
#include "scenes/scannet/files.hpp"
#include "scenes/scannet/label_table.hpp"
#include "scenes/scannet/scannet.hpp"
#include "slam/core/camera.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// What must be equal for faces to share a vertex.
struct Owner {
  InstanceId instance = 0;
  ClassId class_id = kVoid;
  friend auto operator<=>(const Owner&, const Owner&) = default;
};

/// Gives each vertex one owner: where faces of several owners meet, the faces of the later owners
/// get copies.
/// @returns the owner of every vertex; unused vertices are void
std::vector<Owner> part_owners(Scene& scene) {
  const std::size_t before = scene.positions_m.size();
  std::vector<Owner> owner(before);
  std::vector<bool> owned(before, false);
  std::map<std::pair<std::uint32_t, Owner>, std::uint32_t> copies;
  const auto copy = [&](std::uint32_t vertex) {
    const auto again = [vertex](auto& values) {
      if (!values.empty()) values.push_back(values[vertex]);
    };
    again(scene.positions_m);
    again(scene.uvs);
    again(scene.colors);
    again(scene.light);
    return static_cast<std::uint32_t>(scene.positions_m.size() - 1);
  };
  for (std::size_t face = 0; face < scene.triangles.size(); ++face) {
    const Owner mine{scene.instance_of[face], scene.class_of[face]};
    for (std::uint32_t& vertex : scene.triangles[face]) {
      if (!owned[vertex]) {
        owned[vertex] = true;
        owner[vertex] = mine;
      }
      if (owner[vertex] == mine) continue;
      const auto [entry, is_new] = copies.try_emplace({vertex, mine}, 0);
      if (is_new) {
        entry->second = copy(vertex);
        owner.push_back(mine);
        owned.push_back(true);
      }
      vertex = entry->second;
    }
  }
  return owner;
}

/// The segment of every vertex: connected components of the surface, named by their first vertex.
/// @pre every face's vertices have one owner
std::vector<std::uint32_t> connected_segments(const Scene& scene) {
  std::vector<std::uint32_t> parent(scene.positions_m.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : scene.triangles)
    for (const std::uint32_t other : {b, c}) {
      const std::uint32_t p = root(a), q = root(other);
      parent[std::max(p, q)] = std::min(p, q);
    }
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
  return parent;
}

std::vector<SegmentGroup> groups_of(const Scene& scene, const std::vector<Owner>& owner,
                                    const std::vector<std::uint32_t>& segments) {
  std::map<InstanceId, SegmentGroup> groups;
  for (const Instance& instance : scene.instances)
    groups[instance.id] = {.object = instance.id - 1U,
                           .category = std::string(classes()[instance.class_id].name),
                           .name = instance.name,
                           .segments = {}};
  for (std::uint32_t v = 0; v < segments.size(); ++v)
    if (segments[v] == v && owner[v].instance != 0) groups[owner[v].instance].segments.push_back(v);
  std::vector<SegmentGroup> list;
  for (auto& [id, group] : groups) list.push_back(std::move(group));
  return list;
}

/// The mesh with the class of each vertex as its label, and that class's color.
PlyMesh label_mesh(PlyMesh mesh, const std::vector<Owner>& owner) {
  for (std::size_t v = 0; v < owner.size(); ++v) {
    const ClassInfo& info = classes()[classes()[owner[v].class_id].nyu40];
    mesh.labels.push_back(info.id);
    mesh.colors[v] = {info.r, info.g, info.b};
  }
  return mesh;
}

/// A scene is not a scan: it has no frames, and the camera is our default.
std::string info_text() {
  const Camera camera;
  std::string text = "axisAlignment = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
  for (const char* sensor : {"color", "depth"})
    text += fmt::format(
        "{0}Height = {1}\n{0}Width = {2}\nfx_{0} = {3}\nfy_{0} = {4}\nmx_{0} = {5}\nmy_{0} = {6}\n",
        sensor, camera.height_px, camera.width_px, camera.fx_px, camera.fy_px, camera.cx_px,
        camera.cy_px);
  return text +
         "colorToDepthExtrinsics = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
         "numColorFrames = 0\nnumDepthFrames = 0\nnumIMUmeasurements = 0\n";
}

ScannetFiles saved_files(const fs::path& folder) {
  const fs::path full = fs::absolute(folder).lexically_normal();
  return {folder, (full.has_filename() ? full : full.parent_path()).filename().string()};
}

}  // namespace

std::vector<std::string> saved_scannet_names(const fs::path& folder) {
  const ScannetFiles files = saved_files(folder);
  std::vector<std::string> names{kLabelTableV2};
  for (const fs::path& file :
       {files.mesh, files.labels, files.segments, files.aggregation, files.info})
    names.push_back(file.filename().string());
  return names;
}

void save_scannet(const Scene& scene, const fs::path& folder, float max_edge_m) {
  validate(scene);
  Scene parted = split_for_colors(scene, max_edge_m);
  const std::vector<Owner> owner = part_owners(parted);
  const std::vector<std::uint32_t> segments = connected_segments(parted);

  make_output_folder(folder);
  const ScannetFiles files = saved_files(folder);
  const std::string& id = files.scene_id;
  PlyMesh mesh{.positions_m = parted.positions_m,
               .colors = seen_colors(parted),
               .labels = {},
               .triangles = parted.triangles};
  const std::string content = ply_bytes(mesh);
  write_atomically(files.labels, ply_bytes(label_mesh(std::move(mesh), owner)));
  write_atomically(files.segments, segments_text(segments, id));
  write_atomically(files.aggregation, aggregation_text(groups_of(parted, owner, segments), id));
  write_atomically(files.info, info_text());
  write_atomically(folder / kLabelTableV2, label_table_text());
  // Last, so that an incomplete folder is not mistaken for a scene.
  write_atomically(files.mesh, content);
}

}  // namespace mh
