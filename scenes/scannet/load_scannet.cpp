// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>

#include <fmt/format.h>

#include "scenes/mesh_io/instances_in.hpp"
#include "scenes/mesh_io/node_name.hpp"
#include "scenes/mesh_io/ply.hpp"
#include "scenes/scannet/annotation.hpp"
#include "scenes/scannet/files.hpp"
#include "scenes/scannet/label_table.hpp"
#include "scenes/scannet/scannet.hpp"
#include "scenes/scannet/scene_info.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/held_bytes.hpp"
#include "slam/io/text_file.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
constexpr std::uint16_t kLastNyu40 = 40;
constexpr std::uint32_t kLastObject = 65534;  // its instance is the largest 16-bit id

/// Known labels of the vertices; empty if there are none.
struct VertexLabels {
  std::vector<ClassId> classes;
  std::vector<InstanceId> instances;
};

struct Object {
  InstanceId instance = 0;
  std::optional<ClassId> class_id;  ///< nullopt for an unknown category
};

/// The object that a segment belongs to, and whether any vertex is in the segment.
struct Claim {
  std::size_t object = 0;
  bool in_mesh = false;
};
using Claims = std::unordered_map<std::uint32_t, Claim>;  // by segment; looked up, never iterated
                                                          // over

class Loader {
 public:
  Loader(const ScannetFiles& files, std::vector<std::string>* warnings)
      : files_(files), warnings_(warnings) {}

  Scene load() {
    PlyMesh mesh = read_ply(files_.mesh);
    warn_of_bytes_left(mesh, files_.mesh, warnings_);
    if (mesh.triangles.empty())
      throw InputError(fmt::format("{}: has no visible faces", files_.mesh.string()));
    scene_.name = files_.scene_id;
    scene_.positions_m = std::move(mesh.positions_m);
    scene_.colors = std::move(mesh.colors);
    scene_.triangles = std::move(mesh.triangles);
    align();
    read_labels(std::move(mesh.labels));
    choose_table();
    const VertexLabels labels = label_vertices();
    label_faces(labels);
    scene_.materials = {Material{.name = "scan", .texture = {}}};
    scene_.material_of.assign(scene_.triangles.size(), 0);
    find_boxes(scene_);
    rooms_from_floors(scene_);
    validate(scene_);
    return std::move(scene_);
  }

 private:
  void warn(const std::string& what) const {
    if (warnings_ != nullptr) warnings_->push_back(what);
  }

  void align() {
    if (!is_there(files_.info)) return;
    const ScannetInfo info = parse_scannet_info(read_text(files_.info), files_.info.string());
    aligned_ = info.aligned_from_scan.has_value();
    if (!aligned_) return;
    const Eigen::Matrix3d rotation = info.aligned_from_scan->topLeftCorner<3, 3>();
    const Eigen::Vector3d shift_m = info.aligned_from_scan->topRightCorner<3, 1>();
    for (Eigen::Vector3f& p : scene_.positions_m)
      p = (rotation * p.cast<double>() + shift_m).cast<float>();
  }

  /// Reads the label of every vertex: from the labels file, otherwise from the mesh itself.
  void read_labels(std::vector<std::uint16_t> of_mesh) {
    labels_file_ = files_.mesh;
    labels_ = std::move(of_mesh);
    if (!is_there(files_.labels)) return;
    labels_file_ = files_.labels;
    labels_ = read_ply(files_.labels, {.geometry = false}).labels;
    if (labels_.empty())
      throw InputError(
          fmt::format("{}: vertices have no property 'label'", files_.labels.string()));
    if (labels_.size() != scene_.positions_m.size())
      throw InputError(fmt::format("{}: has {} vertices, the mesh has {}", files_.labels.string(),
                                   labels_.size(), scene_.positions_m.size()));
  }

  /// If the tables of both releases are present, a missing alignment indicates that the scene is
  /// from v1.
  void choose_table() {
    const std::vector<fs::path> tables = find_label_tables(files_.mesh.parent_path());
    greatest_label_ = labels_.empty() ? 0 : *std::ranges::max_element(labels_);
    if (tables.empty()) return;
    const bool first = tables.size() == 1 || aligned_;
    table_ = load_label_table(first ? tables[0] : tables[1]);
  }

  VertexLabels label_vertices() {
    VertexLabels vertices;
    if (!labels_.empty()) vertices.classes = classes_of_labels();
    if (!is_there(files_.segments) || !is_there(files_.aggregation)) {
      warn(fmt::format("{}: has no {}: which face belongs to which object is unknown",
                       files_.mesh.string(),
                       is_there(files_.segments) ? files_.aggregation.filename().string()
                                                 : files_.segments.filename().string()));
      return vertices;
    }
    const HeldBytes json = map_file(files_.segments);
    const std::vector<std::uint32_t> segments = parse_segments(json.view, files_.segments.string());
    if (segments.size() != scene_.positions_m.size())
      throw InputError(fmt::format("{}: has segments of {} vertices, the mesh has {}",
                                   files_.segments.string(), segments.size(),
                                   scene_.positions_m.size()));
    const std::vector<SegmentGroup> groups =
        parse_aggregation(read_text(files_.aggregation), files_.aggregation.string());
    label_objects(enter_objects(groups), groups, segments, vertices);
    return vertices;
  }

  std::vector<ClassId> classes_of_labels() {
    // Labels beyond NYU40 indicate raw ids only if the scene is not aligned: some aligned scenes of
    // v2 (scene0270_00 and others) contain a few.
    raw_ids_ = (greatest_label_ > kLastNyu40 && !aligned_) ||
               (table_ && table_->release == ScannetRelease::kV1);
    if (raw_ids_ && !table_)
      throw InputError(fmt::format(
          "{}: holds label {}, which is not an NYU40 id but one of a label table: neither "
          "{} nor {} lies beside the scene or above it",
          labels_file_.string(), greatest_label_, kLabelTableV1, kLabelTableV2));
    // There are few values but many vertices, so each value is looked up once.
    std::vector<ClassId> class_of(std::size_t{greatest_label_} + 1, kVoid);
    std::vector<bool> unknown(class_of.size(), false);
    for (std::uint32_t label = 1; label < class_of.size(); ++label) {
      if (!raw_ids_) {
        unknown[label] = label > kLastNyu40;
        if (!unknown[label]) class_of[label] = static_cast<ClassId>(label);
        continue;
      }
      const auto found = table_->class_of_id.find(label);
      unknown[label] = found == table_->class_of_id.end();
      if (!unknown[label]) class_of[label] = found->second;
    }
    std::vector<ClassId> classes(labels_.size());
    std::size_t lost = 0;
    for (std::size_t v = 0; v < labels_.size(); ++v) {
      classes[v] = class_of[labels_[v]];
      lost += unknown[labels_[v]];
    }
    if (lost > 0)
      warn(fmt::format("{}: {} of {} vertices carry a label that {} lacks (up to {}): not used",
                       labels_file_.string(), lost, labels_.size(),
                       raw_ids_ ? table_->file : "NYU40", greatest_label_));
    return classes;
  }

  /// The class of a category; nullopt if unknown.
  std::optional<ClassId> class_of(const std::string& category) const {
    if (!table_) return class_by_name(category);
    const auto found = table_->class_of_category.find(category);
    if (found == table_->class_of_category.end()) return std::nullopt;
    return found->second;
  }

  /// @returns the owner of each segment, as indices into objects_
  Claims enter_objects(const std::vector<SegmentGroup>& groups) {
    Claims claims;
    std::set<std::string> unknown;
    std::set<std::uint32_t> shared;
    std::size_t unlabeled = 0;
    for (const SegmentGroup& group : groups) {
      if (group.object > kLastObject)
        throw InputError(fmt::format("{}: objectId {} is more than {}", files_.aggregation.string(),
                                     group.object, kLastObject));
      const Object object{static_cast<InstanceId>(group.object + 1), class_of(group.category)};
      if (!object.class_id) {
        ++unlabeled;
        unknown.insert(group.category);
      }
      scene_.instances.push_back(
          {.id = object.instance,
           .class_id = object.class_id.value_or(kVoid),
           .name = group.name.empty() ? fmt::format("{}_{}", group.category, object.instance)
                                      : group.name});
      for (const std::uint32_t segment : group.segments) {
        const auto [claim, is_new] = claims.try_emplace(segment, Claim{objects_.size()});
        if (!is_new && claim->second.object != objects_.size()) shared.insert(segment);
        claim->second.object = objects_.size();
      }
      objects_.push_back(object);
    }
    std::ranges::sort(scene_.instances, {}, &Instance::id);
    make_names_unique();
    if (unlabeled > 0) warn_unlabeled(unlabeled, groups.size(), unknown);
    if (!shared.empty())  // scene0217_00 of release v2 lists all its objects twice
      warn(
          fmt::format("{}: {} of {} segments belong to several objects (such as segment {}): the "
                      "last object counts",
                      files_.aggregation.string(), shared.size(), claims.size(), *shared.begin()));
    return claims;
  }

  /// Assigns every object's instance and class to the vertices of its segments.
  void label_objects(Claims claims, const std::vector<SegmentGroup>& groups,
                     const std::vector<std::uint32_t>& segments, VertexLabels& vertices) const {
    const bool labeled = !vertices.classes.empty();
    vertices.classes.resize(segments.size(), kVoid);
    vertices.instances.assign(segments.size(), 0);
    const Object* object = nullptr;
    for (std::size_t v = 0; v < segments.size(); ++v) {
      if (v == 0 || segments[v] != segments[v - 1]) {
        const auto found = claims.find(segments[v]);
        object = found == claims.end() ? nullptr : &objects_[found->second.object];
        if (object != nullptr) found->second.in_mesh = true;
      }
      if (object == nullptr) continue;
      vertices.instances[v] = object->instance;
      if (!object->class_id)
        vertices.classes[v] = kVoid;
      else if (!labeled || raw_ids_ || labels_[v] > kLastNyu40 ||
               classes()[*object->class_id].nyu40 == vertices.classes[v] ||
               is_finer(*object->class_id, vertices.classes[v]))
        vertices.classes[v] = *object->class_id;
    }
    std::set<std::uint32_t> absent;
    for (const SegmentGroup& group : groups)
      for (const std::uint32_t segment : group.segments)
        if (!claims.at(segment).in_mesh) absent.insert(segment);
    if (!absent.empty())
      warn(
          fmt::format("{}: {} of the {} segments of its objects belong to no vertex (such as "
                      "segment {}): ignored",
                      files_.aggregation.string(), absent.size(), claims.size(), *absent.begin()));
  }

  /// Names may repeat if one of our files was edited manually.
  void make_names_unique() {
    std::set<std::string> names;
    for (Instance& instance : scene_.instances)
      while (!names.insert(instance.name).second) instance.name += fmt::format("_{}", instance.id);
  }

  void warn_unlabeled(std::size_t count, std::size_t all,
                      const std::set<std::string>& categories) const {
    constexpr std::size_t kTold = 5;
    std::string names;
    std::size_t reported = 0;
    for (const std::string& category : categories) {
      if (reported++ == kTold) break;
      names += fmt::format("{}'{}'", reported > 1 ? ", " : "", category);
    }
    if (categories.size() > kTold) names += ", ...";
    warn(fmt::format("{}: {} of {} objects are of {} categories that {} lacks ({}): unlabeled",
                     files_.aggregation.string(), count, all, categories.size(),
                     table_ ? table_->file : "the list of classes, used without a label table,",
                     names));
  }

  void label_faces(const VertexLabels& vertices) {
    const std::size_t faces = scene_.triangles.size();
    scene_.class_of.assign(faces, kVoid);
    scene_.instance_of.assign(faces, 0);
    if (vertices.classes.empty()) return;
    for (std::size_t face = 0; face < faces; ++face) {
      const auto& [a, b, c] = scene_.triangles[face];
      const std::array classes = {vertices.classes[a], vertices.classes[b], vertices.classes[c]};
      const int by_class = majority(classes).value_or(0);
      scene_.class_of[face] = classes[static_cast<std::size_t>(by_class)];
      if (vertices.instances.empty()) continue;
      const std::array instances = {vertices.instances[a], vertices.instances[b],
                                    vertices.instances[c]};
      scene_.instance_of[face] =
          instances[static_cast<std::size_t>(majority(instances).value_or(by_class))];
    }
  }

  /// Index of the first of three values that occurs at least twice; nullopt if all differ.
  template <class T>
  static std::optional<int> majority(const std::array<T, 3>& values) {
    if (values[0] == values[1] || values[0] == values[2]) return 0;
    if (values[1] == values[2]) return 1;
    return std::nullopt;
  }

  const ScannetFiles& files_;
  std::vector<std::string>* warnings_;
  Scene scene_;
  bool aligned_ = false;
  fs::path labels_file_;
  std::vector<std::uint16_t> labels_;
  std::uint16_t greatest_label_ = 0;
  bool raw_ids_ = false;  ///< labels are raw category ids
  std::optional<LabelTable> table_;
  std::vector<Object> objects_;
};

}  // namespace

Scene load_scannet(const fs::path& folder, std::vector<std::string>* warnings) {
  return Loader(find_scannet_files(folder), warnings).load();
}

}  // namespace mh
