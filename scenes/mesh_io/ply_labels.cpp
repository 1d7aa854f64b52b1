// SPDX-License-Identifier: Apache-2.0
#include "scenes/mesh_io/ply_labels.hpp"

#include <array>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scenes/mesh_io/node_name.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/json_text.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
constexpr std::uint16_t kLastNyu40InPly = 40;
constexpr std::uint32_t kLastObjectInPly = 65534;  // its instance is the largest 16-bit id

/// Object names from a file next to the mesh.
using NamesById = std::map<std::uint32_t, std::string>;

/// Reads {list: [{id: 3, name: "chair"}, ...]}; empty if none of the files exists.
NamesById read_names(std::initializer_list<fs::path> files, const char* list, const char* id,
                     const char* name) {
  NamesById names;
  for (const fs::path& file : files) {
    if (!is_file(file)) continue;
    try {
      const Json json = parse_json<Json>(read_file(file));
      for (const Json& item : json.at(list))
        if (item.at(id).is_number_unsigned() &&
            item.at(id).get<std::uint64_t>() <= kLastObjectInPly)
          names[item.at(id).get<std::uint32_t>()] = item.at(name).get<std::string>();
    } catch (const Json::exception& wrong) {
      throw InputError(fmt::format("{}: {}", file.string(), json_fault(wrong)));
    } catch (const InputError& wrong) {
      throw InputError(fmt::format("{}: {}", file.string(), wrong.what()));
    }
    return names;
  }
  return names;
}

class Labeler {
 public:
  Labeler(Scene& scene, const fs::path& file, std::vector<std::string>* warnings)
      : scene_(scene), file_(file), warnings_(warnings) {}

  void by_face(const std::vector<std::uint32_t>& objects) {
    const fs::path folder = file_.parent_path();
    const NamesById names =
        read_names({folder / "info_semantic.json", folder / "habitat" / "info_semantic.json"},
                   "objects", "id", "class_name");
    if (names.empty()) warn("has objects, but no info_semantic.json beside it gives their classes");
    for (std::size_t face = 0; face < scene_.triangles.size(); ++face) {
      if (objects[face] == kNoObject) continue;
      scene_.instance_of[face] = object(objects[face]);
      const auto named = names.find(objects[face]);
      if (named != names.end()) scene_.class_of[face] = class_named(named->second);
    }
    enter_objects(names);
  }

  void by_vertex(const std::vector<std::uint16_t>& nyu40,
                 const std::vector<std::uint32_t>& objects) {
    const fs::path folder = file_.parent_path();
    const NamesById names = objects.empty()
                                ? NamesById{}
                                : read_names({folder / "semseg.v2.json", folder / "semseg.json"},
                                             "segGroups", "objectId", "label");
    for (std::size_t face = 0; face < scene_.triangles.size(); ++face) {
      const auto& [a, b, c] = scene_.triangles[face];
      if (!nyu40.empty())
        scene_.class_of[face] = nyu40_class(most(std::array{nyu40[a], nyu40[b], nyu40[c]}));
      if (objects.empty()) continue;
      const std::uint32_t most_have = most(std::array{objects[a], objects[b], objects[c]});
      if (most_have == 0) continue;  // 3RScan counts objects from 1
      scene_.instance_of[face] = object(most_have - 1);
      if (const auto named = names.find(most_have); named != names.end())
        refine(scene_.class_of[face], named->second);
    }
    NamesById shifted;
    for (const auto& [id, name] : names)
      if (id > 0) shifted[id - 1] = name;
    enter_objects(shifted);
    if (unknown_ > 0)
      warn(fmt::format("{} faces carry a label that is not an NYU40 id: not used", unknown_));
  }

 private:
  void warn(const std::string& what) const {
    if (warnings_ != nullptr) warnings_->push_back(fmt::format("{}: {}", file_.string(), what));
  }

  /// The value that at least two of three values have; the first value if all differ.
  template <class T>
  static T most(const std::array<T, 3>& values) {
    return values[1] == values[2] && values[0] != values[1] ? values[1] : values[0];
  }

  ClassId nyu40_class(std::uint16_t id) {
    if (id <= kLastNyu40InPly) return static_cast<ClassId>(id);
    ++unknown_;
    return kVoid;
  }

  /// The class of a name; cached.
  ClassId class_named(const std::string& name) {
    const auto [place, is_new] = class_of_name_.try_emplace(name, kVoid);
    if (is_new) place->second = guess_class(name);
    return place->second;
  }

  /// Replaces a missing class, or a class in which NYU40 merges several others, with the class that
  /// the name gives.
  void refine(ClassId& id, const std::string& name) {
    const ClassId named = class_named(name);
    if (id == kVoid || is_finer(class_of_noun(name).value_or(kVoid), id)) id = named;
  }

  InstanceId object(std::uint32_t id) {
    if (id > kLastObjectInPly)
      throw InputError(
          fmt::format("{}: object {} is more than {}", file_.string(), id, kLastObjectInPly));
    return static_cast<InstanceId>(id + 1);
  }

  /// Adds the objects that have faces, each with the class of its first face.
  void enter_objects(const NamesById& names) {
    std::map<InstanceId, ClassId> found;
    for (std::size_t face = 0; face < scene_.triangles.size(); ++face)
      if (scene_.instance_of[face] != 0)
        found.try_emplace(scene_.instance_of[face], scene_.class_of[face]);
    for (const auto& [id, class_id] : found) {
      const auto named = names.find(id - 1U);
      scene_.instances.push_back(
          {.id = id,
           .class_id = class_id,
           .name = fmt::format("{}_{}", named == names.end() ? "object" : named->second, id)});
    }
  }

  Scene& scene_;
  const fs::path& file_;
  std::vector<std::string>* warnings_;
  std::map<std::string, ClassId> class_of_name_;
  std::size_t unknown_ = 0;
};

}  // namespace

void label_ply(Scene& scene, const PlyMesh& mesh, const fs::path& file,
               std::vector<std::string>* warnings) {
  Labeler labeler(scene, file, warnings);
  if (!mesh.face_objects.empty())
    labeler.by_face(mesh.face_objects);
  else if (!mesh.nyu40.empty() || !mesh.objects.empty() || !mesh.labels.empty())
    labeler.by_vertex(mesh.nyu40.empty() ? mesh.labels : mesh.nyu40, mesh.objects);
}

}  // namespace mh
