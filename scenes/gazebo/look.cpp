// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo/look.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "scenes/find_file.hpp"
#include "scenes/gazebo/source.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh::gazebo {
namespace fs = std::filesystem;
using tinyxml2::XMLElement;

namespace {

void append_text(XMLElement& out, const char* name, const std::string& text) {
  out.InsertNewChildElement(name)->SetText(text.c_str());
}

std::string numbers_of(const std::array<float, 4>& color) {
  return fmt::format("{} {} {} {}", color[0], color[1], color[2], color[3]);
}

std::vector<fs::path> scripts_at(const fs::path& place) {
  if (!is_folder(place)) return {place};
  std::vector<fs::path> scripts;
  for (const std::string& name : list_folder(place, "*.material")) scripts.push_back(place / name);
  return scripts;
}

}  // namespace

void LookWriter::write(const XMLElement& material, const fs::path& file, XMLElement& out) {
  std::string diffuse = text_of(material.FirstChildElement("diffuse"));
  std::string texture = texture_of_pbr(material, file);
  if (const XMLElement* script = material.FirstChildElement("script"); script && texture.empty())
    if (const auto found = material_of(*script, file)) {
      if (found->diffuse) diffuse = numbers_of(*found->diffuse);
      if (!found->texture.empty()) {
        texture = found->texture;
        if (!found->diffuse) diffuse = "1 1 1 1";
      }
    }
  if (diffuse.empty() && texture.empty()) diffuse = text_of(material.FirstChildElement("ambient"));
  append_text(out, "diffuse", diffuse.empty() ? "1 1 1 1" : diffuse);
  const std::string emissive = text_of(material.FirstChildElement("emissive"));
  if (!emissive.empty()) append_text(out, "emissive", emissive);
  if (texture.empty()) return;
  XMLElement* workflow = out.InsertNewChildElement("pbr")->InsertNewChildElement("metal");
  append_text(*workflow, "albedo_map", texture);
}

std::string LookWriter::texture_of_pbr(const XMLElement& material, const fs::path& file) {
  const XMLElement* pbr = material.FirstChildElement("pbr");
  if (pbr == nullptr) return {};
  for (const XMLElement* workflow = pbr->FirstChildElement(); workflow != nullptr;
       workflow = workflow->NextSiblingElement()) {
    const std::string uri = text_of(workflow->FirstChildElement("albedo_map"));
    if (uri.empty()) continue;
    if (const auto found = finder_.find(uri, file)) return found->string();
    if (const auto found = finder_.find("file://materials/textures/" + uri, file))
      return found->string();
    collected_.add(fmt::format("{}: albedo map {}: there is no such file", file.string(), uri));
  }
  return {};
}

std::optional<OgreMaterial> LookWriter::material_of(const XMLElement& script,
                                                    const fs::path& file) {
  const std::string name = text_of(script.FirstChildElement("name"));
  if (name.empty()) return std::nullopt;  // no material, as in some released worlds
  std::vector<fs::path> folders;
  std::optional<OgreMaterial> found;
  for (const XMLElement* uri = script.FirstChildElement("uri"); uri != nullptr;
       uri = uri->NextSiblingElement("uri")) {
    const auto place = finder_.find(text_of(uri), file);
    if (!place) continue;
    for (const fs::path& path : scripts_at(*place)) {
      folders.push_back(path.parent_path());
      if (path.extension() != ".material") continue;
      const auto& materials = materials_in(path);
      const auto same = std::ranges::find(materials, name, &OgreMaterial::name);
      if (same != materials.end() && !found) found = *same;
    }
    folders.push_back(*place);
  }
  if (!found) found = stock_material(name);
  if (!found) {
    collected_.add(fmt::format("{}: material {}: no script defines it", file.string(), name));
    return std::nullopt;
  }
  if (found->texture.empty()) return found;
  const std::string texture = std::exchange(found->texture, {});
  for (const fs::path& folder : folders)
    for (const fs::path& place : {folder / texture, folder / "../textures" / texture,
                                  folder / "../materials/textures" / texture})
      if (const auto there = find_any_case(place); there && found->texture.empty())
        found->texture = there->lexically_normal().string();
  if (found->texture.empty())
    collected_.add(
        fmt::format("{}: material {}: texture {} is missing", file.string(), name, texture));
  return found;
}

const std::vector<OgreMaterial>& LookWriter::materials_in(const fs::path& script) {
  const auto [place, is_new] = scripts_.try_emplace(script);
  if (!is_new) return place->second;
  try {
    place->second = parse_ogre_script(read_file(script));
  } catch (const InputError& error) {
    collected_.add(error.what());
  }
  return place->second;
}

}  // namespace mh::gazebo
