// SPDX-License-Identifier: Apache-2.0
#include "scenes/scannet/files.hpp"

#include <algorithm>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kMeshEnding = "_vh_clean_2.ply";

std::string id_of_mesh(const fs::path& mesh) {
  const std::string name = mesh.filename().string();
  return name.substr(0, name.size() - kMeshEnding.size());
}

bool is_mesh_name(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(kMeshEnding) && name.size() > kMeshEnding.size();
}

std::vector<std::string> ids_in(const fs::path& folder) {
  std::vector<std::string> ids;
  for (const std::string& name : list_folder(folder, fmt::format("?*{}", kMeshEnding)))
    ids.push_back(id_of_mesh(name));
  return ids;
}

/// The folder with its own name as the last component: not "." and without a trailing slash.
fs::path named(const fs::path& folder) {
  std::error_code error;
  fs::path full = fs::absolute(folder, error).lexically_normal();
  return full.has_filename() ? full : full.parent_path();
}

}  // namespace

ScannetFiles::ScannetFiles(const fs::path& folder, const std::string& id)
    : scene_id(id),
      mesh(folder / (id + "_vh_clean_2.ply")),
      labels(folder / (id + "_vh_clean_2.labels.ply")),
      segments(folder / (id + "_vh_clean_2.0.010000.segs.json")),
      aggregation(folder / (id + ".aggregation.json")),
      info(folder / (id + ".txt")) {}

bool is_scannet_scene(const fs::path& path) {
  if (is_folder(path)) return !ids_in(path).empty();
  if (!is_mesh_name(path)) return false;
  const ScannetFiles files(path.parent_path(), id_of_mesh(path));
  return is_there(files.segments) || is_there(files.labels);
}

ScannetFiles find_scannet_files(const fs::path& path) {
  if (is_mesh_name(path)) return {path.parent_path(), id_of_mesh(path)};
  if (!is_folder(path))
    throw InputError(
        fmt::format("{}: is neither a folder nor a mesh of a ScanNet scene", path.string()));
  const std::vector<std::string> ids = ids_in(path);
  if (ids.empty())
    throw InputError(
        fmt::format("{}: holds no *{}: it is not a ScanNet scene", path.string(), kMeshEnding));
  const std::string own = named(path).filename().string();
  if (ids.size() == 1) return {path, ids[0]};
  if (std::ranges::find(ids, own) != ids.end()) return {path, own};
  throw InputError(fmt::format("{}: holds {} scenes ({}, {}, ...): name one mesh", path.string(),
                               ids.size(), ids[0], ids[1]));
}

std::vector<fs::path> find_label_tables(const fs::path& folder) {
  constexpr int kLevels = 4;
  fs::path place = named(folder);
  std::vector<fs::path> tables;
  for (int level = 0; level < kLevels && tables.empty(); ++level, place = place.parent_path())
    for (const char* name : {kLabelTableV2, kLabelTableV1})
      if (is_file(place / name)) tables.push_back(place / name);
  return tables;
}

}  // namespace mh
