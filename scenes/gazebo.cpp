// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <sdf/sdf.hh>

#include "scenes/gazebo/expand.hpp"
#include "scenes/gazebo/lights.hpp"
#include "scenes/gazebo/shapes.hpp"
#include "scenes/guard.hpp"
#include "scenes/mesh_io/image_in.hpp"
#include "scenes/mesh_io/label_rules.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/node_name.hpp"
#include "scenes/mesh_io/subdivide.hpp"
#include "scenes/placed_objects.hpp"
#include "slam/io/error.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"
#include "slam/io/lower_case.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

Eigen::Affine3d affine_of(const ignition::math::Pose3d& pose) {
  const auto& q = pose.Rot();
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized().toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.X(), pose.Y(), pose.Z());
  return result;
}

std::uint8_t level_of(float share) {
  return static_cast<std::uint8_t>(255.0F * std::clamp(share, 0.0F, 1.0F) + 0.5F);
}

class WorldReader {
 public:
  explicit WorldReader(const fs::path& file) : file_(file), rules_(find_label_rules(file)) {}

  Scene read(std::vector<std::string>* warnings) {
    require_readable(file_);
    // libsdformat returns its messages as errors, but would also print them.
    sdf::Console::Instance()->SetQuiet(true);
    const gazebo::Expanded expanded = gazebo::expand(file_, collected_);
    scene_.name = file_.stem().string();
    const std::string scene = add_piece(expanded.scene, {}) ? expanded.scene : "";
    for (const std::vector<std::string>& piece : expanded.pieces) add_piece(scene, piece);
    if (!scene_.lights.empty())
      scene_.lights.push_back({.kind = Light::Kind::kAmbient, .color = ambient_});
    if (visuals_ < expanded.visuals)
      collected_.add(fmt::format("{}: {} of {} visuals could not be read", file_.string(),
                                 expanded.visuals - visuals_, expanded.visuals));
    std::vector<std::string> collected;
    collected_.append_to(&collected);
    if (scene_.triangles.empty())
      throw InputError(fmt::format("{}: has nothing visible{}", file_.string(),
                                   collected.empty() ? "" : ": " + collected.front()));
    if (warnings != nullptr) warnings->insert(warnings->end(), collected.begin(), collected.end());
    meshes_.clear();
    if (!scene_.lights.empty()) {
      const float edge_m = gazebo::edge_for_light_m(scene_);
      constexpr std::size_t kEnoughFaces = 1'000'000;  // reached, for example, by a 100 km road
      scene_ = subdivide(std::move(scene_), edge_m, kEnoughFaces);
    }
    finish_parts(scene_);
    return std::move(scene_);
  }

 private:
  /// Adds elements of a world. libsdformat rejects a whole document if it rejects one element; the
  /// other elements are then read without the rejected one.
  /// @returns whether nothing was rejected
  bool add_piece(const std::string& scene, std::span<const std::string> elements) {
    sdf::ParserConfig config;
    config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
    sdf::Root root;
    const sdf::Errors errors = root.LoadSdfString(gazebo::document_of(scene, elements), config);
    const sdf::World* world = root.WorldByIndex(0);
    if (world == nullptr && elements.size() > 1) {
      for (const auto half :
           {elements.first(elements.size() / 2), elements.subspan(elements.size() / 2)})
        add_piece(scene, half);
      return false;
    }
    for (const sdf::Error& error : errors)
      collected_.add(fmt::format("{}: {}", file_.string(), error.Message()));
    if (world != nullptr) add_world(*world);
    return world != nullptr;
  }

  void add_world(const sdf::World& world) {
    for (std::uint64_t m = 0; m < world.ModelCount(); ++m)
      add_model(*world.ModelByIndex(m), Eigen::Affine3d::Identity());
    for (std::uint64_t l = 0; l < world.LightCount(); ++l)
      add_light(*world.LightByIndex(l), Eigen::Affine3d::Identity());
    const auto ambient =
        world.Scene() == nullptr ? sdf::Scene().Ambient() : world.Scene()->Ambient();
    ambient_ = {ambient.R(), ambient.G(), ambient.B()};
  }

  /// If a pose refers to a missing frame, the pose is taken as relative to the parent of its
  /// element.
  template <class Thing>
  Eigen::Affine3d pose_of(const Thing& thing, const std::string& what) {
    ignition::math::Pose3d pose;
    const sdf::Errors errors = thing.SemanticPose().Resolve(pose);
    if (errors.empty()) return affine_of(pose);
    collected_.add(fmt::format("{}: {}: {}", file_.string(), what, errors.front().Message()));
    return affine_of(thing.RawPose());
  }

  void add_light(const sdf::Light& light, const Eigen::Affine3d& world_from_parent) {
    scene_.lights.push_back(
        gazebo::light_of(light, world_from_parent * pose_of(light, "light " + light.Name())));
  }

  /// Adds a top-level model; nested models belong to it.
  void add_model(const sdf::Model& model, const Eigen::Affine3d& world_from_parent) {
    Scene parts;
    parts.name = model.Name();
    add_links(model, model.Name(), world_from_parent, parts);
    if (parts.triangles.empty()) return;  // models that hold only lights or ground truth
    std::optional<ClassId> class_id = rules_.find({model.Name()});
    if (!class_id && guess_class(model.Name()) != kVoid) class_id = guess_class(model.Name());
    const bool known = std::ranges::any_of(parts.class_of, [](ClassId c) { return c != kVoid; });
    if (!class_id && !known) class_id = kVoid;  // void instead of nullopt: the model is one object
    append_part(scene_, std::move(parts), Eigen::Affine3d::Identity(), model.Name(), class_id);
  }

  void add_links(const sdf::Model& model, const std::string& name,
                 const Eigen::Affine3d& world_from_parent, Scene& parts) {
    const Eigen::Affine3d world_from_model = world_from_parent * pose_of(model, "model " + name);
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const std::string what = name + "/" + link.Name();
      const Eigen::Affine3d world_from_link = world_from_model * pose_of(link, "link " + what);
      for (std::uint64_t v = 0; v < link.VisualCount(); ++v)
        add_visual(*link.VisualByIndex(v), what, world_from_link, parts);
      for (std::uint64_t l = 0; l < link.LightCount(); ++l)
        add_light(*link.LightByIndex(l), world_from_link);
    }
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i)
      add_links(*model.ModelByIndex(i), name, world_from_model, parts);
  }

  void add_visual(const sdf::Visual& visual, const std::string& link,
                  const Eigen::Affine3d& world_from_link, Scene& parts) {
    ++visuals_;
    constexpr float kUnseen = 0.99F;
    if (visual.Transparency() > kUnseen) return;
    const std::string what = fmt::format("link {}: visual {}", link, visual.Name());
    const Eigen::Affine3d world_from_visual = world_from_link * pose_of(visual, what);
    const sdf::Geometry& geometry = *visual.Geom();
    const std::string name = fmt::format("{}_{}", visual.Name(), parts_++);
    if (geometry.Type() == sdf::GeometryType::MESH) {
      add_mesh(visual, world_from_visual, name, parts);
    } else if (const auto fault = gazebo::fault_of(geometry)) {
      collected_.add(fmt::format("{}: {}: {}: left out", file_.string(), what, *fault));
    } else if (const auto shape = gazebo::shape_of(geometry, look_of(visual))) {
      append_part(parts, *shape, world_from_visual, name, kVoid);
    } else {
      collected_.add(fmt::format("{}: {}: this kind of shape is not shown", file_.string(), what));
    }
  }

  void add_mesh(const sdf::Visual& visual, Eigen::Affine3d world_from_visual,
                const std::string& name, Scene& parts) {
    const sdf::Mesh& mesh = *visual.Geom()->MeshShape();
    const Scene* found = mesh_of(mesh.Uri());
    if (found == nullptr) return;
    const auto scale = mesh.Scale();
    world_from_visual.linear() *= Eigen::Vector3d(scale.X(), scale.Y(), scale.Z()).asDiagonal();
    Scene shown = mesh.Submesh().empty() ? *found : submesh_of(*found, mesh);
    if (visual.Material() != nullptr) dress(shown, look_of(visual));
    append_part(parts, std::move(shown), world_from_visual, name);
  }

  /// Cached, since worlds show the same mesh many times. An unreadable mesh is omitted.
  const Scene* mesh_of(const fs::path& file) {
    const auto [place, is_new] = meshes_.try_emplace(file);
    if (is_new) {
      try {
        std::vector<std::string> warnings;
        place->second = load_mesh(file, &warnings, rules_, {.images = &images_, .in_gazebo = true});
        for (const std::string& warning : warnings) collected_.add(warning);
      } catch (const InputError& error) {
        const std::string what = error.what();
        const bool is_named =
            what.find(file.string()) != what.npos;  // errors about a Scene do not name its file
        collected_.add(fmt::format("{}{}: left out", is_named ? "" : file.string() + ": ", what));
      }
    }
    return place->second ? &*place->second : nullptr;
  }

  /// The submesh that a visual names, centered on the origin if the visual asks for that.
  Scene submesh_of(const Scene& mesh, const sdf::Mesh& wanted) {
    const auto found = std::ranges::find_if(mesh.instances, [&](const Instance& instance) {
      return lower_case(instance.name) == lower_case(wanted.Submesh());
    });
    if (found == mesh.instances.end()) {
      collected_.add(
          fmt::format("{}: has no submesh {}: all of it is shown", wanted.Uri(), wanted.Submesh()));
      return mesh;
    }
    Scene part = mesh;
    part.triangles.clear(), part.material_of.clear(), part.class_of.clear();
    part.instance_of.clear();
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
      if (mesh.instance_of[face] != found->id) continue;
      part.triangles.push_back(mesh.triangles[face]);
      part.material_of.push_back(mesh.material_of[face]);
      part.class_of.push_back(mesh.class_of[face]);
      part.instance_of.push_back(mesh.instance_of[face]);
    }
    part.instances = {*found};
    if (wanted.CenterSubmesh())
      for (Eigen::Vector3f& p : part.positions_m) p -= 0.5F * (found->min_m + found->max_m);
    return part;
  }

  /// If the visual itself has a texture, it replaces the mesh's materials; a plain color replaces
  /// only those without a texture.
  static void dress(Scene& mesh, const Material& look) {
    for (Material& material : mesh.materials)
      if (!look.texture.empty() || material.texture.empty()) {
        const std::string name = material.name;
        material = look;
        material.name = name;
        if (mesh.uvs.empty()) material.texture = {}, material.opacity = {};
      }
  }

  Material look_of(const sdf::Visual& visual) {
    Material look{.name = "color", .texture = {}};
    float opacity = 1.0F - std::clamp(visual.Transparency(), 0.0F, 1.0F);
    if (const sdf::Material* material = visual.Material()) {
      const auto c = material->Diffuse();
      look.base_color = {level_of(c.R()), level_of(c.G()), level_of(c.B())};
      opacity *= std::clamp(c.A(), 0.0F, 1.0F);
      const auto e = material->Emissive();
      look.emission = Eigen::Vector3f(e.R(), e.G(), e.B()).cwiseMax(0.0F);
      if (const sdf::Pbr* pbr = material->PbrMaterial())
        if (const auto* metal = pbr->Workflow(sdf::PbrWorkflowType::METAL))
          put_texture(metal->AlbedoMap(), look);
    }
    // As for mesh materials: alpha 0 is more often a mistake than an invisible object.
    if (opacity > 0.0F && opacity <= 0.5F) {
      const Eigen::Vector3f tint =
          Eigen::Vector3f(look.base_color.r, look.base_color.g, look.base_color.b) / 255.0F;
      look.transmission = Eigen::Vector3f::Constant(1.0F - opacity) + opacity * tint;
    }
    return look;
  }

  void put_texture(const fs::path& file, Material& look) {
    const ImageIn image = images_.read(file);
    if (image.color.empty())
      collected_.add(fmt::format("{}: texture {} {}", file_.string(), file.string(), image.fault));
    look.texture = image.color;
    look.opacity = image.opacity;
  }

  fs::path file_;
  gazebo::UniqueWarnings collected_;
  LabelRules rules_;
  Scene scene_;
  Eigen::Vector3f ambient_ = Eigen::Vector3f::Zero();
  ImageStore images_;
  std::map<fs::path, std::optional<Scene>> meshes_;
  std::size_t visuals_ = 0;
  int parts_ = 0;
};

}  // namespace

Scene load_gazebo_world(const fs::path& file, std::vector<std::string>* warnings) {
  // libsdformat takes 3 s per megabyte of small models.
  constexpr GuardLimits kLimits{.processor_s_per_mb = 5.0};
  return load_guarded(
      file, warnings,
      [&](std::vector<std::string>* collected) { return WorldReader(file).read(collected); },
      kLimits);
}

}  // namespace mh
