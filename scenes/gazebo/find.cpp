// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo/find.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <vector>

#include "scenes/find_file.hpp"
#include "scenes/mesh_io/percent.hpp"
#include "slam/io/files.hpp"

namespace mh::gazebo {
namespace fs = std::filesystem;

namespace {

constexpr int kLevels = 5;  // a folder and the four above it

/// Folders named by environment variables.
std::vector<fs::path> folders_of(std::initializer_list<const char*> variables) {
  std::vector<fs::path> folders;
  for (const char* variable : variables) {
    const char* value = std::getenv(variable);
    std::istringstream list(value == nullptr ? "" : value);
    std::string folder;
    while (std::getline(list, folder, ':'))
      if (!folder.empty()) folders.push_back(fs::absolute(folder));
  }
  return folders;
}

std::vector<fs::path> with_those_above(fs::path folder) {
  std::vector<fs::path> folders;
  for (int level = 0; level < kLevels; ++level, folder = folder.parent_path())
    folders.push_back(folder);
  return folders;
}

std::optional<fs::path> find_in(const std::vector<fs::path>& folders, const fs::path& named) {
  for (const fs::path& folder : folders)
    if (is_there(folder / named)) return folder / named;
  for (const fs::path& folder : folders)
    if (auto found = find_any_case(folder / named)) return found;
  return std::nullopt;
}

fs::path folder_of(const fs::path& file) {
  return fs::absolute(file).lexically_normal().parent_path();
}

/// The newest version of a model that Gazebo has downloaded before: HOST/OWNER/models/NAME/VERSION,
/// in lower case. `named` is HOST/1.0/OWNER/models/NAME[/VERSION][/files/...].
std::optional<fs::path> find_in_fuel_cache(const std::string& named) {
  std::vector<std::string> parts;
  std::istringstream list(named);
  for (std::string part; std::getline(list, part, '/');) parts.push_back(part);
  constexpr std::size_t kLeast = 5;
  if (parts.size() < kLeast) return std::nullopt;
  std::vector<fs::path> caches = folders_of({"GZ_FUEL_CACHE_PATH"});
  if (const char* home = std::getenv("HOME"))
    for (const char* folder : {".gz/fuel", ".ignition/fuel"})
      caches.push_back(fs::path(home) / folder);
  for (const fs::path& cache : caches) {
    const auto model = find_any_case(cache / parts[0] / parts[2] / parts[3] / parts[4]);
    if (!model) continue;
    int newest = -1;
    for (const std::string& name : list_folder(*model, "*")) {
      int version = -1;
      std::from_chars(name.data(), name.data() + name.size(), version);
      newest = std::max(newest, version);
    }
    fs::path found = newest < 0 ? *model : *model / std::to_string(newest);
    const auto files = std::ranges::find(parts, "files");
    if (files == parts.end()) return found;
    for (auto part = files + 1; part != parts.end(); ++part) found /= *part;
    return find_any_case(found);
  }
  return std::nullopt;
}

}  // namespace

Finder::Finder(const fs::path& world) : world_folder_(folder_of(world)) {}

std::optional<fs::path> Finder::find(const std::string& uri, const fs::path& file) const {
  if (auto found = find_named(uri, file)) return found;
  const std::string decoded = percent_decoded(uri);
  return decoded == uri ? std::nullopt : find_named(decoded, file);
}

std::optional<fs::path> Finder::find_named(const std::string& uri, const fs::path& file) const {
  const std::size_t mark = uri.find("://");
  const std::string_view scheme =
      mark == uri.npos ? std::string_view() : std::string_view(uri).substr(0, mark);
  const std::string named = mark == uri.npos ? uri : uri.substr(mark + 3);
  if (named.empty()) return std::nullopt;
  std::vector<fs::path> places = with_those_above(folder_of(file));
  if (scheme.empty() || scheme == "file") return find_in(places, named);
  if (scheme == "https" || scheme == "http") return find_in_fuel_cache(named);
  std::ranges::move(with_those_above(world_folder_), std::back_inserter(places));
  for (std::size_t i = 0; i < places.size(); i += 2)
    places.insert(places.begin() + static_cast<std::ptrdiff_t>(i) + 1, places[i] / "models");
  std::ranges::move(folders_of({"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "SDF_PATH"}),
                    std::back_inserter(places));
  if (auto found = find_in(places, named)) return found;
  if (scheme != "package") return std::nullopt;
  // package://NAME/a/b: package NAME can be anywhere, and its folder may have a different name.
  for (fs::path rest = named; rest.has_parent_path();) {
    rest = rest.lexically_relative(*rest.begin());
    if (auto found = find_in(places, rest)) return found;
  }
  return std::nullopt;
}

std::optional<fs::path> Finder::model_file(const fs::path& found) {
  if (!is_folder(found)) return found;
  // model.config names one file for each version of SDF.
  std::string newest = "model.sdf";
  auto config = find_any_case(found / "model.config");
  if (!config) config = find_any_case(found / "manifest.xml");
  if (config) {
    const std::string text = read_file(*config);
    tinyxml2::XMLDocument document;
    document.Parse(text.data(), text.size());
    const tinyxml2::XMLElement* model = document.FirstChildElement("model");
    double best = -1.0;
    for (const auto* sdf = model == nullptr ? nullptr : model->FirstChildElement("sdf");
         sdf != nullptr; sdf = sdf->NextSiblingElement("sdf")) {
      const double version = sdf->DoubleAttribute("version");
      if (sdf->GetText() == nullptr || version < best) continue;
      best = version;
      newest = sdf->GetText();
    }
  }
  return find_any_case(found / newest);
}

}  // namespace mh::gazebo
