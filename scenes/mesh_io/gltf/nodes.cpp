// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/gltf/nodes.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace mh::gltf {
namespace {

/// One property of a node's instances: their translations, rotations or scales.
struct Track {
  const char* name;     ///< in the extension
  const char* in_node;  ///< in a node
  Values values{};
};

/// Nodes with the name, mesh and extras of `node`, one for each instance.
std::vector<Json> instances_of(const Json& node, const Json& attributes, Data& data) {
  std::array<Track, 3> tracks = {
      {{"TRANSLATION", "translation"}, {"ROTATION", "rotation"}, {"SCALE", "scale"}}};
  std::size_t count = 0;
  for (Track& track : tracks) {
    const std::size_t accessor = index_in(attributes, track.name, kNone);
    if (accessor == kNone) continue;
    track.values = data.values(accessor);
    const std::size_t wanted = track.name == std::string_view("ROTATION") ? 4 : 3;
    if (track.values.width != wanted || (count != 0 && track.values.count() != count))
      data.fail(fmt::format("accessors[{}]: does not fit the other instances", accessor));
    count = track.values.count();
  }
  Json bare;
  for (const char* kept : {"name", "mesh", "extras"})
    if (node.contains(kept)) bare[kept] = node[kept];
  std::vector<Json> nodes(count, bare);
  for (const Track& track : tracks)
    for (std::size_t i = 0; i < track.values.count(); ++i)
      for (std::size_t k = 0; k < track.values.width; ++k)
        nodes[i][track.in_node].push_back(track.values.numbers[i * track.values.width + k]);
  return nodes;
}

}  // namespace

void drop_movement(Json& gltf) {
  gltf.erase("animations");
  gltf.erase("skins");
  for (Json& node : list_of(gltf, "nodes"))
    if (node.is_object()) node.erase("skin");
}

void drop_hidden(Json& gltf) {
  const Json::json_pointer place("/extensions/KHR_node_visibility/visible");
  for (Json& node : list_of(gltf, "nodes"))
    if (node.is_object() && node.contains(place) && node[place] == false)
      for (const char* part : {"mesh", "children"}) node.erase(part);
}

void place_instances(Json& gltf, Data& data) {
  const Json::json_pointer place("/extensions/EXT_mesh_gpu_instancing");
  const std::size_t count = list_of(gltf, "nodes").size();
  for (std::size_t i = 0; i < count; ++i) {
    const Json& node = gltf["nodes"][i];
    if (!node.is_object() || !node.contains(place) || !node.contains("mesh")) continue;
    std::vector<Json> instances = instances_of(node, node[place].at("attributes"), data);
    Json& nodes = gltf["nodes"];  // which grows
    for (Json& instance : instances) {
      nodes[i]["children"].push_back(nodes.size());
      nodes.push_back(std::move(instance));
    }
    nodes[i].erase("mesh");
    nodes[i]["extensions"].erase("EXT_mesh_gpu_instancing");
  }
}

}  // namespace mh::gltf
