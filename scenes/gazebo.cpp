// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <sdf/sdf.hh>

#include "scenes/guard.hpp"
#include "scenes/mesh_builder.hpp"
#include "scenes/mesh_io/label_rules.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/mesh_io/node_name.hpp"
#include "scenes/placed_objects.hpp"
#include "slam/core/error.hpp"
#include "slam/core/file_errors.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Folders named by the environment variables of Gazebo's generations.
std::vector<fs::path> folders_of_environment() {
  std::vector<fs::path> folders;
  for (const char* variable : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "SDF_PATH"}) {
    const char* value = std::getenv(variable);
    std::istringstream list(value == nullptr ? "" : value);
    std::string folder;
    while (std::getline(list, folder, ':'))
      if (!folder.empty()) folders.emplace_back(folder);
  }
  return folders;
}

/// The file or folder that a URI means, seen from a folder; nullopt if there is none.
std::optional<fs::path> find_uri(const std::string& uri, const fs::path& folder) {
  std::error_code error;
  const std::size_t mark = uri.find("://");
  if (mark == uri.npos || uri.starts_with("file://")) {
    const fs::path path(mark == uri.npos ? uri : uri.substr(mark + 3));
    if (is_there(folder / path)) return folder / path;  // an absolute path stays itself
    return std::nullopt;
  }
  const fs::path named(uri.substr(mark + 3));
  constexpr int kLevels = 5;
  std::vector<fs::path> places;
  fs::path place = fs::absolute(folder, error).lexically_normal();
  for (int level = 0; level < kLevels; ++level, place = place.parent_path()) {
    places.push_back(place);
    places.push_back(place / "models");
  }
  std::ranges::move(folders_of_environment(), std::back_inserter(places));
  for (const fs::path& base : places)
    if (is_there(base / named)) return base / named;
  // package://NAME/a/b: NAME is wherever somebody put it, and may not be a folder's name.
  if (!uri.starts_with("package://")) return std::nullopt;
  for (fs::path rest = named; rest.has_parent_path();) {
    rest = rest.lexically_relative(*rest.begin());
    for (const fs::path& base : places)
      if (is_there(base / rest)) return base / rest;
  }
  return std::nullopt;
}

/// The SDF file of an include: a file, or a model's folder with a model.config.
fs::path file_of_include(const fs::path& found) {
  if (!is_folder(found)) return found;
  for (const char* config : {"model.config", "manifest.xml"})
    if (is_file(found / config)) {
      read_file(found / config);  // libsdformat opens it itself: to be noted
      break;
    }
  return fs::path(sdf::getModelFilePath(found.string()));
}

/// Follows includes before libsdformat does, which would follow a circle for ever.
class IncludeWalk {
 public:
  void enter(const fs::path& file) {
    std::error_code error;
    const fs::path own = fs::weakly_canonical(file, error);
    if (std::ranges::find(open_, own) != open_.end()) {
      std::string circle;
      for (const fs::path& step : open_) circle += step.string() + " includes ";
      throw InputError(fmt::format("{}{}: the includes lead in a circle", circle, own.string()));
    }
    constexpr std::size_t kMostFiles = 10000;
    if (++entered_ > kMostFiles)
      throw InputError(fmt::format("{}: more than {} includes", own.string(), kMostFiles));
    open_.push_back(own);
    tinyxml2::XMLDocument document;
    const std::string text = read_file(own);
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
      throw InputError(fmt::format("{}:{}: is no SDF that can be read: {}", own.string(),
                                   std::max(document.ErrorLineNum(), 1), document.ErrorName()));
    visit(document.RootElement(), own);
    open_.pop_back();
  }

 private:
  void visit(const tinyxml2::XMLElement* element, const fs::path& file) {
    for (; element != nullptr; element = element->NextSiblingElement()) {
      if (std::string_view(element->Name()) == "include") follow(*element, file);
      visit(element->FirstChildElement(), file);
    }
  }

  void follow(const tinyxml2::XMLElement& include, const fs::path& file) {
    const tinyxml2::XMLElement* uri = include.FirstChildElement("uri");
    if (uri == nullptr || uri->GetText() == nullptr)
      throw InputError(
          fmt::format("{}:{}: an include without a uri", file.string(), include.GetLineNum()));
    const auto found = find_uri(uri->GetText(), file.parent_path());
    if (!found)
      throw InputError(fmt::format("{}:{}: include {}: there is no such file", file.string(),
                                   uri->GetLineNum(), uri->GetText()));
    const fs::path target = file_of_include(*found);
    if (target.empty())
      throw InputError(fmt::format("{}:{}: include {}: the folder {} holds no model", file.string(),
                                   uri->GetLineNum(), uri->GetText(), found->string()));
    enter(target);
  }

  std::vector<fs::path> open_;
  std::size_t entered_ = 0;
};

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
  WorldReader(const fs::path& file, std::vector<std::string>* warnings)
      : file_(file), warnings_(warnings), rules_(find_label_rules(file)) {}

  Scene read() {
    require_readable(file_);
    // What it has to say comes as errors; it would also print it.
    sdf::Console::Instance()->SetQuiet(true);
    IncludeWalk().enter(file_);
    sdf::ParserConfig config;
    config.SetFindCallback([this](const std::string& uri) {
      const auto found = find_uri(uri, file_.parent_path());
      return found ? found->string() : std::string();
    });
    config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
    sdf::Root root;
    const sdf::Errors errors = root.Load(file_.string(), config);
    if (!errors.empty())
      throw InputError(fmt::format("{}: {}", file_.string(), errors.front().Message()));
    scene_.name = file_.stem().string();
    if (root.Model() != nullptr) add_model(*root.Model(), Eigen::Affine3d::Identity());
    for (std::uint64_t w = 0; w < root.WorldCount(); ++w)
      for (std::uint64_t m = 0; m < root.WorldByIndex(w)->ModelCount(); ++m)
        add_model(*root.WorldByIndex(w)->ModelByIndex(m), Eigen::Affine3d::Identity());
    finish_parts(scene_);
    return std::move(scene_);
  }

 private:
  static Eigen::Affine3d resolved(const sdf::SemanticPose& semantic, const std::string& what) {
    ignition::math::Pose3d pose;
    const sdf::Errors errors = semantic.Resolve(pose);
    if (!errors.empty()) throw InputError(fmt::format("{}: {}", what, errors.front().Message()));
    return affine_of(pose);
  }

  /// A top-level model; those inside it belong to it.
  void add_model(const sdf::Model& model, const Eigen::Affine3d& world_from_parent) {
    Scene parts;
    parts.name = model.Name();
    add_links(model, model.Name(), world_from_parent, parts);
    if (parts.triangles.empty()) return;  // lights and ground truths have no looks
    std::optional<ClassId> class_id = rules_.find({model.Name()});
    if (!class_id && guess_class(model.Name()) != kVoid) class_id = guess_class(model.Name());
    const bool known = std::ranges::any_of(parts.class_of, [](ClassId c) { return c != kVoid; });
    if (!class_id && !known) class_id = kVoid;  // then it is at least one object
    append_part(scene_, std::move(parts), Eigen::Affine3d::Identity(), model.Name(), class_id);
  }

  void add_links(const sdf::Model& model, const std::string& name,
                 const Eigen::Affine3d& world_from_parent, Scene& parts) {
    const Eigen::Affine3d world_from_model =
        world_from_parent * resolved(model.SemanticPose(), file_.string() + ": model " + name);
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const Eigen::Affine3d world_from_link =
          world_from_model *
          resolved(link.SemanticPose(), file_.string() + ": link " + link.Name());
      for (std::uint64_t v = 0; v < link.VisualCount(); ++v)
        add_visual(*link.VisualByIndex(v), name + "/" + link.Name(), world_from_link, parts);
    }
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i)
      add_links(*model.ModelByIndex(i), name, world_from_model, parts);
  }

  void add_visual(const sdf::Visual& visual, const std::string& link,
                  const Eigen::Affine3d& world_from_link, Scene& parts) {
    const std::string what =
        fmt::format("{}: link {}: visual {}", file_.string(), link, visual.Name());
    Eigen::Affine3d world_from_visual = world_from_link * resolved(visual.SemanticPose(), what);
    const sdf::Geometry& geometry = *visual.Geom();
    const std::string name = fmt::format("{}_{}", visual.Name(), parts_++);
    if (geometry.Type() == sdf::GeometryType::MESH) {
      const sdf::Mesh& mesh = *geometry.MeshShape();
      const fs::path from = mesh.FilePath().empty() ? file_ : fs::path(mesh.FilePath());
      const auto found = find_uri(mesh.Uri(), from.parent_path());
      if (!found)
        throw InputError(fmt::format("{}: mesh {}: there is no such file", what, mesh.Uri()));
      const auto scale = mesh.Scale();
      world_from_visual.linear() *= Eigen::Vector3d(scale.X(), scale.Y(), scale.Z()).asDiagonal();
      append_part(parts, mesh_of(*found), world_from_visual, name);
      return;
    }
    check_size(geometry, what);
    const auto shape = shape_of(geometry, visual.Material());
    if (shape)
      append_part(parts, *shape, world_from_visual, name, kVoid);
    else if (warnings_ != nullptr)
      warnings_->push_back(fmt::format("{}: its kind of shape is not shown", what));
  }

  /// Worlds show one mesh many times.
  const Scene& mesh_of(const fs::path& file) {
    const auto [place, is_new] = meshes_.try_emplace(file);
    if (is_new) place->second = load_mesh(file, warnings_, rules_);
    return place->second;
  }

  /// libsdformat lets any number pass.
  static void check_size(const sdf::Geometry& geometry, const std::string& what) {
    const auto need = [&](const char* shape, std::initializer_list<double> numbers) {
      const auto sound = [](double v) { return std::isfinite(v) && v > 0.0; };
      if (!std::ranges::all_of(numbers, sound))
        throw InputError(fmt::format("{}: a {} of {}: its measures must be above 0", what, shape,
                                     fmt::join(numbers, " x ")));
    };
    if (const auto* box = geometry.BoxShape())
      need("box", {box->Size().X(), box->Size().Y(), box->Size().Z()});
    else if (const auto* cylinder = geometry.CylinderShape())
      need("cylinder", {cylinder->Radius(), cylinder->Length()});
    else if (const auto* sphere = geometry.SphereShape())
      need("sphere", {sphere->Radius()});
    else if (const auto* plane = geometry.PlaneShape())
      need("plane", {plane->Size().X(), plane->Size().Y()});
  }

  static std::optional<Scene> shape_of(const sdf::Geometry& geometry,
                                       const sdf::Material* material) {
    MeshBuilder builder;
    Material look{.name = "colour", .texture = {}};
    if (material != nullptr) {
      const auto c = material->Diffuse();
      look.base_colour = {level_of(c.R()), level_of(c.G()), level_of(c.B())};
    }
    builder.max_edge_m = 1e6F;
    builder.scene().materials.push_back(look);
    constexpr MaterialId id = 0;
    builder.begin_instance("shape", kVoid);
    using Eigen::Vector3f;
    switch (geometry.Type()) {
      case sdf::GeometryType::BOX: {
        const auto size = geometry.BoxShape()->Size();
        const Vector3f half = 0.5F * Eigen::Vector3d(size.X(), size.Y(), size.Z()).cast<float>();
        builder.box(id, -half, half);
        break;
      }
      case sdf::GeometryType::CYLINDER: {
        const auto& cylinder = *geometry.CylinderShape();
        const Vector3f top(0, 0, static_cast<float>(0.5 * cylinder.Length()));
        builder.cylinder(id, -top, top, static_cast<float>(cylinder.Radius()),
                         static_cast<float>(cylinder.Radius()));
        break;
      }
      case sdf::GeometryType::SPHERE: {
        const auto radius = static_cast<float>(geometry.SphereShape()->Radius());
        constexpr float kPi = std::numbers::pi_v<float>;
        builder.sheet(id,
                      [radius](float u, float v) {
                        const float around = 2.0F * kPi * u, down = kPi * v;
                        return Vector3f(radius * std::sin(down) * std::cos(around),
                                        radius * std::sin(down) * std::sin(around),
                                        radius * std::cos(down));
                      },
                      32, 16, {1.0F, 1.0F});
        break;
      }
      case sdf::GeometryType::PLANE: {
        const auto& plane = *geometry.PlaneShape();
        const auto n = plane.Normal();
        const Eigen::Matrix3f turned =
            Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(),
                                               Eigen::Vector3d(n.X(), n.Y(), n.Z()).cast<float>())
                .toRotationMatrix();
        const auto sx = static_cast<float>(plane.Size().X());
        const auto sy = static_cast<float>(plane.Size().Y());
        builder.picture(id, turned * Vector3f(-0.5F * sx, 0.5F * sy, 0),
                        turned * Vector3f(sx, 0, 0), turned * Vector3f(0, -sy, 0));
        break;
      }
      default:
        return std::nullopt;
    }
    return builder.finish();
  }

  fs::path file_;
  std::vector<std::string>* warnings_;
  LabelRules rules_;
  Scene scene_;
  std::map<fs::path, Scene> meshes_;
  int parts_ = 0;
};

}  // namespace

Scene load_gazebo_world(const fs::path& file, std::vector<std::string>* warnings) {
  return load_guarded(file, warnings, [&](std::vector<std::string>* told) {
    return WorldReader(file, told).read();
  });
}

}  // namespace mh
