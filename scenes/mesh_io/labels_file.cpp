// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/labels_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_number.hpp"
#include "slam/io/json_text.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr std::string_view kFormat = "modelhouse-labels";
constexpr int kVersion = 1;

Json face_runs(const Scene& scene) {
  Json runs = Json::array();
  const std::size_t faces = scene.triangles.size();
  for (std::size_t begin = 0, end = 0; begin < faces; begin = end) {
    while (end < faces && scene.class_of[end] == scene.class_of[begin] &&
           scene.instance_of[end] == scene.instance_of[begin])
      ++end;
    runs.push_back({end - begin, scene.instance_of[begin],
                    std::string(classes()[scene.class_of[begin]].name)});
  }
  return runs;
}

ClassId read_class(const Json& name) {
  const auto id = class_by_name(name.get<std::string>());
  if (!id) throw InputError(fmt::format("unknown class {}", name.get<std::string>()));
  return *id;
}

void read_runs(Scene& scene, const Json& runs) {
  scene.class_of.clear();
  scene.instance_of.clear();
  for (const Json& run : runs) {
    const auto count = whole_number<std::size_t>(run.at(0));
    if (count > scene.triangles.size() - scene.class_of.size())
      throw InputError("runs cover more faces than the mesh has");
    scene.instance_of.insert(scene.instance_of.end(), count, whole_number<InstanceId>(run.at(1)));
    scene.class_of.insert(scene.class_of.end(), count, read_class(run.at(2)));
  }
  if (scene.class_of.size() != scene.triangles.size())
    throw InputError(
        fmt::format("runs cover {} of {} faces", scene.class_of.size(), scene.triangles.size()));
}

void check_belongs(const Scene& scene, const Json& json) {
  if (json.at("format") != kFormat || json.at("version") != kVersion)
    throw InputError(fmt::format("not a {} file of version {}", kFormat, kVersion));
  const auto vertices = whole_number<std::size_t>(json.at("vertices"));
  const auto faces = whole_number<std::size_t>(json.at("faces"));
  if (vertices != scene.positions_m.size() || faces != scene.triangles.size())
    throw InputError(
        fmt::format("labels are for {} vertices and {} faces, but the mesh beside it has {} and {}",
                    vertices, faces, scene.positions_m.size(), scene.triangles.size()));
}

void read(Scene& scene, const Json& json) {
  check_belongs(scene, json);
  scene.name = json.at("name").get<std::string>();
  scene.instances.clear();
  for (const Json& item : json.at("instances")) {
    Instance instance;
    instance.id = whole_number<InstanceId>(item.at(0));
    instance.class_id = read_class(item.at(1));
    instance.name = item.at(2).get<std::string>();
    scene.instances.push_back(instance);
  }
  read_runs(scene, json.at("runs"));
  scene.rooms.clear();
  for (const Json& item : json.at("rooms")) {
    Room room{.name = item.at(0).get<std::string>(), .polygon_m = {}};
    for (const Json& corner : item.at(1))
      room.polygon_m.emplace_back(corner.at(0).get<double>(), corner.at(1).get<double>());
    scene.rooms.push_back(room);
  }
}

}  // namespace

fs::path labels_path(const fs::path& mesh) {
  return fs::path(mesh).replace_extension(".labels.json");
}

bool is_labels_file(const fs::path& file) {
  return read_file(file).find(fmt::format("\"format\":\"{}\"", kFormat)) != std::string::npos;
}

void save_labels(const Scene& scene, const fs::path& file) {
  Json instances = Json::array(), rooms = Json::array();
  for (const Instance& instance : scene.instances)
    instances.push_back(
        {instance.id, std::string(classes()[instance.class_id].name), instance.name});
  for (const Room& room : scene.rooms) {
    Json polygon = Json::array();
    for (const Eigen::Vector2d& corner : room.polygon_m)
      polygon.push_back({corner.x(), corner.y()});
    rooms.push_back({room.name, polygon});
  }
  const Json json = {{"format", kFormat},
                     {"version", kVersion},
                     {"name", scene.name},
                     {"vertices", scene.positions_m.size()},
                     {"faces", scene.triangles.size()},
                     {"instances", instances},
                     {"runs", face_runs(scene)},
                     {"rooms", rooms}};
  write_atomically(file, json.dump() + "\n");
}

void load_labels(Scene& scene, const fs::path& file) {
  try {
    read(scene, parse_json<Json>(read_text(file)));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: {}", file.string(), json_fault(error)));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace mh
