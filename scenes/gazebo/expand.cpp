// SPDX-License-Identifier: Apache-2.0
#include "scenes/gazebo/expand.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/gazebo/find.hpp"
#include "scenes/gazebo/look.hpp"
#include "scenes/gazebo/names.hpp"
#include "scenes/gazebo/source.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"

namespace mh::gazebo {
namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

namespace {

constexpr std::size_t kMostIncludes = 10000;
constexpr std::size_t kMostVisuals = 20'000;  // per model: libsdformat takes 0.1 MB for each
constexpr std::size_t kDeepest = 64;          // nested includes or models

constexpr const char* kSun =
    "<sdf version='1.9'><light type='directional' name='sun'><pose>0 0 10 0 0 0</pose>"
    "<diffuse>0.8 0.8 0.8 1</diffuse><direction>-0.5 0.1 -0.9</direction></light></sdf>";
constexpr const char* kGroundPlane =
    "<sdf version='1.9'><model name='ground_plane'><link name='link'><visual name='visual'>"
    "<geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>"
    "<material><diffuse>0.7 0.7 0.7 1</diffuse></material></visual></link></model></sdf>";

class Expander {
 public:
  Expander(const fs::path& world, UniqueWarnings& collected)
      : world_(world), collected_(collected), finder_(world), looks_(finder_, collected) {}

  Expanded run() {
    XMLElement* root = out_.NewElement("sdf");
    out_.InsertEndChild(root);
    root->SetAttribute("version", "1.9");
    XMLElement* world = root->InsertNewChildElement("world");
    world->SetAttribute("name", "w");
    const Source& source = read(world_);
    std::error_code error;
    open_.push_back(fs::weakly_canonical(world_, error));
    Names names;
    for (const XMLElement& part : children(*source.document.RootElement()))
      if (std::string_view(part.Name()) == "world")
        add_parts(part, source, *world, names);
      else
        add_part(part, source, *world, names);
    Expanded expanded{.scene = {}, .pieces = {}, .visuals = visuals_};
    put_pieces(*world, expanded);
    return expanded;
  }

 private:
  static std::string text_of_all(const XMLElement& element) {
    tinyxml2::XMLPrinter printer(nullptr, true);
    element.Accept(&printer);
    return printer.CStr();
  }

  static void put_pieces(const XMLElement& world, Expanded& expanded) {
    bool refers = world.FirstChildElement("frame") != nullptr;
    std::vector<std::string> elements;
    for (const XMLElement& element : children(world)) {
      const XMLElement* pose = element.FirstChildElement("pose");
      refers = refers || (pose != nullptr && pose->Attribute("relative_to") != nullptr);
      if (std::string_view(element.Name()) == "scene")
        expanded.scene = text_of_all(element);
      else
        elements.push_back(text_of_all(element));
    }
    // libsdformat takes 4 MB for each model and 0.1 s for each document: pieces must be neither too
    // large nor too many.
    const std::size_t at_once = std::clamp<std::size_t>(elements.size() / 16, 16, 128);
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (expanded.pieces.empty() || (!refers && i % at_once == 0)) expanded.pieces.emplace_back();
      expanded.pieces.back().push_back(std::move(elements[i]));
    }
  }

  /// A range over an element's child elements.
  struct Children {
    const XMLElement* first;
    struct Iterator {
      const XMLElement* at;
      const XMLElement& operator*() const { return *at; }
      Iterator& operator++() {
        at = at->NextSiblingElement();
        return *this;
      }
      bool operator!=(const Iterator& other) const { return at != other.at; }
    };
    Iterator begin() const { return {first}; }
    Iterator end() const { return {nullptr}; }
  };
  static Children children(const XMLElement& element) { return {element.FirstChildElement()}; }

  [[noreturn]] static void fail(const Source& source, const XMLElement& at,
                                const std::string& what) {
    throw InputError(fmt::format("{}:{}: {}", source.file.string(), at.GetLineNum(), what));
  }

  const Source& read(const fs::path& file) {
    std::unique_ptr<Source>& source = sources_[file];
    if (!source) source = parse_source(file, read_file(file));
    return *source;
  }

  void add_parts(const XMLElement& parent, const Source& source, XMLElement& out, Names& names) {
    for (const XMLElement& part : children(parent)) add_part(part, source, out, names);
  }

  /// Adds an element of a world, a model or a file.
  void add_part(const XMLElement& part, const Source& source, XMLElement& out, Names& names) {
    const std::string_view kind = part.Name();
    if (kind == "include")
      add_include(part, source, out, names);
    else if (kind == "model")
      add_model(part, source, out, names, nullptr);
    else if (kind == "link")
      add_link(part, source, out, names);
    else if (kind == "light")
      add_light(part, source, out, names);
    else if (kind == "frame")
      add_frame(part, source, out, names);
    else if (kind == "joint")
      add_joint(part, source, out, names);
    else if (kind == "scene")
      add_scene(part, out);
    else if (kind == "actor" || kind == "population" || kind == "road")
      collected_.add(fmt::format("{}: {}: is not shown", source.file.string(), kind));
  }

  void add_include(const XMLElement& include, const Source& source, XMLElement& out, Names& names) {
    const std::string uri = text_of(include.FirstChildElement("uri"));
    if (uri.empty()) fail(source, include, "an include without a uri");
    if (++includes_ > kMostIncludes)
      fail(source, include, fmt::format("more than {} includes", kMostIncludes));
    const auto found = finder_.find(uri, source.file);
    const auto target = found ? Finder::model_file(*found) : std::nullopt;
    if (target)
      add_file(*target, include, source, out, names);
    else if (const char* built_in = built_in_model(uri))
      add_models(*parse_source(source.file, built_in), include, out, names);
    else
      collected_.add(
          fmt::format("{}:{}: include {}: {}: left out", source.file.string(),
                      include.FirstChildElement("uri")->GetLineNum(), uri,
                      found ? fmt::format("the folder {} holds no model", found->string())
                      : uri.starts_with("http") ? "is not in Fuel's cache"
                                                : "there is no such model"),
          "include " + uri);
  }

  /// Recognizes model://sun and model://ground_plane, also by their names in Fuel.
  static const char* built_in_model(const std::string& uri) {
    std::string name = uri;
    while (name.ends_with('/')) name.pop_back();
    name = name.substr(name.rfind('/') + 1);
    std::ranges::transform(name, name.begin(), [](unsigned char c) {
      return c == ' ' ? '_' : static_cast<char>(std::tolower(c));
    });
    if (name == "sun") return kSun;
    return name == "ground_plane" || name == "ground%20plane" ? kGroundPlane : nullptr;
  }

  void add_file(const fs::path& file, const XMLElement& include, const Source& from,
                XMLElement& out, Names& names) {
    std::error_code error;
    const fs::path own = fs::weakly_canonical(file, error);
    const bool circle = std::ranges::find(open_, own) != open_.end();
    if (circle || open_.size() >= kDeepest) {
      std::string chain;
      for (const fs::path& step : open_) chain += step.string() + " includes ";
      if (!circle) fail(from, include, fmt::format("more than {} includes deep", kDeepest));
      throw InputError(fmt::format("{}{}: the includes form a cycle", chain, own.string()));
    }
    const Source* source = readable(file, include, from);
    if (source == nullptr) return;
    open_.push_back(own);
    add_models(*source, include, out, names);
    open_.pop_back();
  }

  /// @returns null if the file is not SDF and is left out
  const Source* readable(const fs::path& file, const XMLElement& include, const Source& from) {
    try {
      return &read(file);
    } catch (const InputError& error) {
      collected_.add(fmt::format("{}:{}: include: {}: left out", from.file.string(),
                                 include.GetLineNum(), error.what()),
                     "include " + file.string());
      return nullptr;
    }
  }

  void add_models(const Source& source, const XMLElement& include, XMLElement& out, Names& names) {
    for (const XMLElement& part : children(*source.document.RootElement())) {
      const std::string_view kind = part.Name();
      if (kind == "model")
        add_model(part, source, out, names, &include);
      else if (kind == "light")
        add_light(part, source, out, names, &include);
    }
  }

  void add_model(const XMLElement& model, const Source& source, XMLElement& out, Names& names,
                 const XMLElement* include) {
    if (++depth_ > kDeepest) fail(source, model, fmt::format("models nested {} deep", kDeepest));
    if (depth_ == 1) visuals_before_ = visuals_;
    XMLElement* copy = out.InsertNewChildElement("model");
    const std::string given_name =
        include == nullptr ? "" : text_of(include->FirstChildElement("name"));
    copy->SetAttribute(
        "name",
        names.take(given_name.empty() ? model.Attribute("name") : given_name.c_str()).c_str());
    const XMLElement* pose = model.FirstChildElement("pose");
    const std::string placed =
        include == nullptr ? "" : text_of(include->FirstChildElement("placement_frame"));
    if (!placed.empty())
      copy->SetAttribute("placement_frame", placed.c_str());
    else if (const char* frame = model.Attribute("placement_frame"))
      copy->SetAttribute("placement_frame", frame);
    if (include != nullptr && include->FirstChildElement("pose") != nullptr)
      pose = include->FirstChildElement("pose");
    if (pose != nullptr) add_pose(*pose, source, *copy);
    Names inner;
    add_parts(model, source, *copy, inner);
    // libsdformat requires at least one link or nested model.
    if (copy->FirstChildElement("link") == nullptr && copy->FirstChildElement("model") == nullptr)
      copy->InsertNewChildElement("link")->SetAttribute("name", "empty");
    --depth_;
  }

  void add_link(const XMLElement& link, const Source& source, XMLElement& out, Names& names) {
    XMLElement* copy = out.InsertNewChildElement("link");
    copy->SetAttribute("name", names.take(link.Attribute("name")).c_str());
    Names inner;
    for (const XMLElement& part : children(link)) {
      const std::string_view kind = part.Name();
      if (kind == "pose")
        add_pose(part, source, *copy);
      else if (kind == "visual")
        add_visual(part, source, *copy, inner);
      else if (kind == "light")
        add_light(part, source, *copy, inner);
    }
  }

  void add_visual(const XMLElement& visual, const Source& source, XMLElement& out, Names& names) {
    const XMLElement* geometry = visual.FirstChildElement("geometry");
    const XMLElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
    while (shape != nullptr && std::strcmp(shape->Name(), "empty") == 0)
      shape = shape->NextSiblingElement();
    if (shape == nullptr) return;
    const char* given = visual.Attribute("name");
    const std::string what = fmt::format("{}: link {}: visual {}", source.file.string(),
                                         path_of(out), given == nullptr ? "" : given);
    const std::string uri = text_of(shape->FirstChildElement("uri"));
    const bool is_mesh = std::strcmp(shape->Name(), "mesh") == 0;
    const auto mesh = is_mesh ? finder_.find(uri, source.file) : std::nullopt;
    if (is_mesh && !mesh) {
      collected_.add(fmt::format("{}: mesh {}: there is no such file: left out", what, uri),
                     source.file.string() + uri);
      return;
    }
    XMLElement* copy = out.InsertNewChildElement("visual");
    copy->SetAttribute("name", names.take(given).c_str());
    if (const XMLElement* pose = visual.FirstChildElement("pose")) add_pose(*pose, source, *copy);
    if (const std::string clear = text_of(visual.FirstChildElement("transparency")); !clear.empty())
      copy->InsertNewChildElement("transparency")->SetText(clear.c_str());
    XMLElement* shown = copy->InsertNewChildElement("geometry");
    shown->InsertEndChild(shape->DeepClone(&out_));
    if (mesh)
      shown->FirstChildElement("mesh")->FirstChildElement("uri")->SetText(mesh->string().c_str());
    if (const XMLElement* material = visual.FirstChildElement("material"))
      looks_.write(*material, source.file, *copy->InsertNewChildElement("material"));
    if (++visuals_ - visuals_before_ > kMostVisuals)
      fail(source, visual, fmt::format("a model of more than {} visuals", kMostVisuals));
  }

  /// The path of a link in the output, MODEL/.../LINK.
  static std::string path_of(const XMLElement& link) {
    std::string path = link.Attribute("name");
    for (const tinyxml2::XMLNode* up = link.Parent(); up != nullptr && up->ToElement() != nullptr;
         up = up->Parent())
      if (std::strcmp(up->Value(), "model") == 0)
        path = fmt::format("{}/{}", up->ToElement()->Attribute("name"), path);
    return path;
  }

  void add_light(const XMLElement& light, const Source& source, XMLElement& out, Names& names,
                 const XMLElement* include = nullptr) {
    if (std::strcmp(out.Name(), "model") == 0) return;  // only worlds and links have lights
    XMLElement* copy = light.DeepClone(&out_)->ToElement();
    out.InsertEndChild(copy);
    copy->SetAttribute("name", names.take(light.Attribute("name")).c_str());
    if (copy->Attribute("type") == nullptr) copy->SetAttribute("type", "point");
    while (XMLElement* pose = copy->FirstChildElement("pose")) copy->DeleteChild(pose);
    const XMLElement* placed = include == nullptr ? nullptr : include->FirstChildElement("pose");
    if (placed == nullptr) placed = light.FirstChildElement("pose");
    if (placed != nullptr) add_pose(*placed, source, *copy);
  }

  void add_frame(const XMLElement& frame, const Source& source, XMLElement& out, Names& names) {
    if (!source.has_frames) return;
    XMLElement* copy = out.InsertNewChildElement("frame");
    copy->SetAttribute("name", names.take(frame.Attribute("name")).c_str());
    if (const char* to = frame.Attribute("attached_to")) copy->SetAttribute("attached_to", to);
    if (const XMLElement* pose = frame.FirstChildElement("pose")) add_pose(*pose, source, *copy);
  }

  /// Joints are invisible, but poses may be relative to one.
  void add_joint(const XMLElement& joint, const Source& source, XMLElement& out, Names& names) {
    const char* name = joint.Attribute("name");
    if (!source.has_frames || name == nullptr || !source.referred.contains(name)) return;
    XMLElement* copy = out.InsertNewChildElement("joint");
    copy->SetAttribute("name", names.take(name).c_str());
    copy->SetAttribute("type", "fixed");
    for (const char* end : {"parent", "child"})
      copy->InsertNewChildElement(end)->SetText(text_of(joint.FirstChildElement(end)).c_str());
    if (const XMLElement* pose = joint.FirstChildElement("pose")) add_pose(*pose, source, *copy);
  }

  /// Keeps only the ambient light.
  void add_scene(const XMLElement& scene, XMLElement& out) {
    const std::string ambient = text_of(scene.FirstChildElement("ambient"));
    if (ambient.empty() || out.FirstChildElement("scene") != nullptr) return;
    out.InsertNewChildElement("scene")->InsertNewChildElement("ambient")->SetText(ambient.c_str());
  }

  void add_pose(const XMLElement& pose, const Source& source, XMLElement& out) {
    const std::string text = text_of(&pose);
    std::istringstream numbers(text);
    std::string word;
    constexpr int kNumbers = 6;
    int count = 0;
    for (; numbers >> word; ++count) {
      char* end = nullptr;
      if (!std::isfinite(std::strtod(word.c_str(), &end)) || *end != '\0')
        fail(source, pose, fmt::format("pose: '{}' is not a pose", text));
    }
    if (count == 0) return;
    XMLElement* copy = out.InsertNewChildElement("pose");
    std::string whole = text;
    for (; count < kNumbers; ++count) whole += " 0";
    copy->SetText(whole.c_str());
    if (!source.has_frames) return;
    for (const char* name : {"relative_to", "degrees", "rotation_format"})
      if (const char* value = pose.Attribute(name); value != nullptr && *value != '\0')
        copy->SetAttribute(name, value);
  }

  fs::path world_;
  UniqueWarnings& collected_;
  Finder finder_;
  LookWriter looks_;
  XMLDocument out_;
  std::map<fs::path, std::unique_ptr<Source>> sources_;
  std::vector<fs::path> open_;
  std::size_t includes_ = 0, depth_ = 0, visuals_ = 0, visuals_before_ = 0;
};

}  // namespace

Expanded expand(const fs::path& world, UniqueWarnings& collected) {
  return Expander(world, collected).run();
}

std::string document_of(const std::string& scene, std::span<const std::string> elements) {
  return fmt::format("<sdf version='1.9'><world name='w'>{}{}</world></sdf>", scene,
                     fmt::join(elements, ""));
}

}  // namespace mh::gazebo
