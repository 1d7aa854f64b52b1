// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/scene_option.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/lab/scan_views.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "bench/report/drawing/contact_sheet.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/generate/grammar.hpp"
#include "scenes/house/house.hpp"
#include "scenes/labeled.hpp"
#include "scenes/load.hpp"
#include "scenes/mesh_io/labels_file.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "scenes/scannet/scannet.hpp"
#include "sim/render/scan_look.hpp"
#include "sim/simulation/lit_scene.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/read_record.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;
constexpr int kThreads = 2;  // for baking light; does not change the result

struct SceneArguments {
  std::string scene, out, format;
  SceneFrameOption frame;
  std::vector<std::string> scenes;  ///< for `preview`
  bool scan_look = false;           ///< for `make`
  int each = 0;                     ///< for `preview`: scenes of each category
  int per_room = 2;                 ///< for `preview`: rows of one scene's sheet
  bool no_captions = false;
  std::uint64_t seed = 0;
  bool json = false, suggest_labels = false;
};

/// Loads a scene and reports on stderr what was repaired.
Scene load(const std::string& file, const SceneFrameOption& frame) {
  std::vector<std::string> warnings;
  Scene scene = load_scene(file, &warnings, frame.frame());
  print_warnings(warnings);
  return scene;
}

double slope_deg(const Floor& floor) {
  return std::acos(std::min(1.0, floor.up.z())) * 180 / std::numbers::pi;
}

/// Prints how much of the surface has a class, and which parts without a class are the largest.
void print_labeled(const LabeledSurface& surface) {
  constexpr std::size_t kTold = 5;
  fmt::print("  labeled   {:.1f} % of {:.1f} m2 of surface\n", 100 * surface.share(),
             surface.area_m2);
  for (std::size_t i = 0; i < std::min(kTold, surface.unlabeled.size()); ++i)
    fmt::print("             {:>8.1f} m2 without a class: {}\n", surface.unlabeled[i].area_m2,
               surface.unlabeled[i].pattern);
  if (surface.unlabeled.size() > kTold)
    fmt::print("             {} more: --suggest-labels\n", surface.unlabeled.size() - kTold);
}

void info(SceneArguments options) {
  resolve(options.scene, Shipped::kScene);
  const Scene scene = load(options.scene, options.frame);
  const LabeledSurface surface = survey_labels(scene);
  if (options.suggest_labels) {
    fmt::print("{}", suggested_labels(surface));
    return;
  }
  std::map<ClassId, int> objects;
  for (const Instance& instance : scene.instances) ++objects[instance.class_id];
  if (options.json) {
    nlohmann::ordered_json by_class;
    for (const auto& [id, count] : objects) by_class[std::string(classes()[id].name)] = count;
    nlohmann::ordered_json rooms = nlohmann::ordered_json::array();
    for (const Room& room : scene.rooms) rooms.push_back(room.name);
    const nlohmann::ordered_json json = {{"name", scene.name},
                                         {"floor_area_m2", scene.floor_area_m2()},
                                         {"floor_z_m", scene.floor.middle_m.z()},
                                         {"floor_slope_deg", slope_deg(scene.floor)},
                                         {"rooms", rooms},
                                         {"triangles", scene.triangles.size()},
                                         {"vertices", scene.positions_m.size()},
                                         {"materials", scene.materials.size()},
                                         {"objects", scene.instances.size()},
                                         {"classes", by_class},
                                         {"surface_m2", surface.area_m2},
                                         {"labeled_share", surface.share()},
                                         {"digest", hex(digest(scene))}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}\n  floor      {:.2f} m2 in {}\n", scene.name, scene.floor_area_m2(),
             counted(scene.rooms.size(), "room"));
  for (const Room& room : scene.rooms) fmt::print("             {}\n", room.name);
  if (!scene.floor.is_level_zero())
    fmt::print("             at z = {:.3f} m{}\n", scene.floor.middle_m.z(),
               slope_deg(scene.floor) > 0
                   ? fmt::format(", sloping by {:.1f} deg", slope_deg(scene.floor))
                   : "");
  fmt::print("  triangles  {}\n  vertices   {}\n  materials  {}\n  lights     {}\n",
             scene.triangles.size(), scene.positions_m.size(), scene.materials.size(),
             scene.lights.size());
  fmt::print("  objects    {} of {}\n", scene.instances.size(),
             counted(objects.size(), "class", "classes"));
  for (const auto& [id, count] : objects)
    fmt::print("             {:>4}  {}\n", count, classes()[id].name);
  print_labeled(surface);
  fmt::print("  digest     {}\n", hex(digest(scene)));
}

/// Keeps at most the first `count` views of each room.
void keep_of_each_room(std::vector<View>& views, int count) {
  std::map<std::string, int> kept;
  std::erase_if(views, [&](const View& view) { return ++kept[view.caption] > count; });
}

/// Bakes a scene's light and returns the scene's name with views of it. The scene is freed once
/// they are rendered.
std::pair<std::string, std::vector<View>> see(const std::string& name,
                                              const SceneArguments& options,
                                              const BakeWatch& baked) {
  const ReadScope reading;
  Scene scene = load(find_scene(name).string(), options.frame);
  require_not_read(options.out, reading.record());
  light_from_cache(scene, kThreads, usual_cache(), {}, baked);
  const auto renderer = make_scene_renderer(scene);
  return {scene.name, views_of(scene, *renderer)};
}

void preview(const SceneArguments& options) {
  if (fs::path(options.out).extension() != ".png" || fs::is_directory(options.out))
    throw InputError(fmt::format("{}: must name a file that ends in .png", options.out));
  require_writable(options.out, {options.scenes.begin(), options.scenes.end()});
  std::vector<std::string> names = options.scenes;
  for (const Category& category : categories())
    for (int i = 0; i < options.each; ++i)
      names.push_back(to_string({category.name, static_cast<std::uint64_t>(i)}));
  if (names.empty()) throw InputError("preview: name a scene, or give --each");
  std::vector<View> gallery;
  Progress progress("preview");
  for (const std::string& name : names) {
    const double before = static_cast<double>(gallery.size());
    const auto all = static_cast<double>(names.size());
    progress.share(before / all, name);
    auto [title, views] = see(
        name, options, [&](double share) { progress.share((before + 0.9 * share) / all, name); });
    if (names.size() == 1) {
      keep_of_each_room(views, options.per_room);
      write_image(options.out, draw_contact_sheet(title, views));
      progress.share(1);
      return;
    }
    gallery.push_back(std::move(views.front()));
    gallery.back().caption = name;
  }
  progress.share(1);
  constexpr int kColumns = 4;
  write_image(options.out, draw_gallery(gallery, kColumns, !options.no_captions));
}

/// Also checks the labels that are written next to a PLY, since they must not replace other files.
void require_mesh_writable(const fs::path& out, const std::vector<fs::path>& read) {
  require_writable(out, read);
  const fs::path labels = labels_path(out);
  if (out.extension() == ".ply" && fs::exists(labels) && !is_labels_file(labels))
    throw InputError(fmt::format("{}: already exists and would be overwritten: name another --out",
                                 labels.string()));
}

void require_ending(const SceneArguments& options, const std::vector<std::string>& endings) {
  const std::string ending = fs::path(options.out).extension().string();
  if (std::ranges::find(endings, ending) == endings.end())
    throw InputError(fmt::format("{}: must end in {}", options.out, fmt::join(endings, " or ")));
  require_mesh_writable(options.out, {});
}

/// Returns the scene as scanned by a person who walks through it with a depth camera.
Scene scanned(const Scene& scene) {
  constexpr std::size_t kViews = 90;
  const auto renderer = make_scene_renderer(scene);
  Camera camera;
  // Views in any direction, including up and down: a single walk would miss half of the floor.
  return scan_look(scene, *renderer, camera, scan_views(scene, 0, kViews));
}

/// Bakes the scene's light unless it is cached, and reports progress.
void light(Scene& scene) {
  Progress progress("light");
  light_from_cache(scene, kThreads, usual_cache(), {},
                   [&](double share) { progress.share(share); });
}

void write_mesh(Scene scene, const fs::path& out, bool scan = false) {
  light(scene);
  if (scan) {
    Progress("scan").say("90 views");
    scene = scanned(scene);
  }
  out.extension() == ".ply" ? save_scannet_ply(scene, out) : save_glb(scene, out);
}

void convert(SceneArguments options) {
  resolve(options.scene, Shipped::kScene);
  const std::string ending = fs::path(options.out).extension().string();
  std::string format = options.format;
  if (format.empty()) format = ending.empty() ? "scannet" : ending.substr(1);
  const bool folder = format == "scannet";
  if (!folder && (format != "ply" && format != "glb"))
    throw InputError(fmt::format(
        "{}: must end in .ply or .glb, or name a folder for a ScanNet scene", options.out));
  if (!folder && ending != "." + format)
    throw InputError(fmt::format("{}: must end in .{}", options.out, format));
  if (!folder) {
    require_mesh_writable(options.out, {options.scene});
    const ReadScope reading;
    Scene scene = load(options.scene, options.frame);
    require_not_read(options.out, reading.record());
    if (format == "ply") require_not_read(labels_path(options.out), reading.record());
    write_mesh(std::move(scene), options.out);
    return;
  }
  const std::vector<std::string> names = saved_scannet_names(options.out);
  const OutputFolder made(options.out, "scene convert", names);
  const ReadScope reading;
  Scene scene = load(options.scene, options.frame);
  for (const std::string& written : names)
    require_not_read(fs::path(options.out) / written, reading.record());
  light(scene);
  save_scannet(scene, options.out);
}

nlohmann::ordered_json facts_json(const GeneratedReference& reference, const GeneratedPlan& plan) {
  return {{"scene", to_string(reference)},
          {"room", plan.room},
          {"floor_area_m2", plan.floor_area_m2},
          {"objects", plan.objects},
          {"objects_per_10_m2", plan.objects_per_10_m2()},
          {"group", density_group_name(density_group(plan.objects_per_10_m2()))},
          {"free_floor", plan.free_share}};
}

void make(const SceneArguments& options) {
  const GeneratedReference reference{options.scene, options.seed};
  if (options.scan_look && options.out.empty())
    throw InputError("--scan-look writes a mesh: name its file with --out FILE.glb or FILE.ply");
  if (options.scan_look)
    require_ending(options, {".glb", ".ply"});
  else if (!options.out.empty())
    require_ending(options, {".yaml", ".glb", ".ply"});
  const GeneratedPlan plan = generate_plan(reference);
  if (options.json)
    fmt::print("{}\n", facts_json(reference, plan).dump(2));
  else
    fmt::print("{}: {}, {:.1f} m2, {}, {:.1f} per 10 m2, {:.0f} % of the floor free\n",
               to_string(reference), plan.room, plan.floor_area_m2, counted(plan.objects, "object"),
               plan.objects_per_10_m2(), 100 * plan.free_share);
  if (options.out.empty()) return;
  if (fs::path(options.out).extension() == ".yaml") {
    const std::string text = with_detail(plan);
    if (is_file(options.out) && read_file(options.out) != text)  // may have been edited by hand
      throw InputError(
          fmt::format("{}: already exists and differs: name another file", options.out));
    write_atomically(options.out, text);
    return;
  }
  write_mesh(build_house(with_detail(plan), plan.name), options.out, options.scan_look);
}

/// Lists every environment of every category, and counts those in each group of the paper's Figure
/// 3.
void list(const SceneArguments& options) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::array<int, kDensityGroups> total{};
  int count = 0, made = 0, wanted = 0;
  for (const Category& category : categories()) wanted += category.count;
  Progress progress("scene list");
  if (!options.json) {
    fmt::print("{:<18}{:>6}", "objects per 10 m2", "");
    for (int g = 0; g < kDensityGroups; ++g) fmt::print("{:>7}", density_group_name(g));
    fmt::print("   floor, m2\n");
  }
  for (const Category& category : categories()) {
    std::array<int, kDensityGroups> groups{};
    double least = 1e30, most = 0;
    for (int i = 0; i < category.count; ++i) {
      const GeneratedReference reference{category.name, static_cast<std::uint64_t>(i)};
      const GeneratedPlan plan = generate_plan(reference);
      ++groups[static_cast<std::size_t>(density_group(plan.objects_per_10_m2()))];
      least = std::min(least, plan.floor_area_m2);
      most = std::max(most, plan.floor_area_m2);
      if (options.json) all.push_back(facts_json(reference, plan));
      progress.share(static_cast<double>(++made) / wanted, category.name);
    }
    count += category.count;
    for (std::size_t g = 0; g < groups.size(); ++g) total[g] += groups[g];
    if (options.json) continue;
    progress.end();
    fmt::print("{:<18}{:>6}", category.name, category.count);
    for (const int n : groups) fmt::print("{:>7}", n);
    fmt::print("   {:.1f} to {:.1f}\n", least, most);
  }
  if (options.json) {
    fmt::print("{}\n", all.dump(2));
    return;
  }
  fmt::print("{:<18}{:>6}", "all", count);
  for (const int n : total) fmt::print("{:>7}", n);
  fmt::print("\n");
}

}  // namespace

void add_scene(CLI::App& app) {
  auto options = std::make_shared<SceneArguments>();
  CLI::App* command =
      app.add_subcommand("scene", "Inspects, generates, draws and converts scenes.");
  command->require_subcommand(1);
  command->footer("Example:\n  modelhouse scene info model_house");

  CLI::App* i = command->add_subcommand("info", "Prints area, triangles, objects and classes.");
  i->add_option("scene", options->scene, "Scene (YAML), mesh file, or the name of a shipped scene")
      ->required();
  options->frame.add_to(*i);
  i->add_flag("--json", options->json, "Prints JSON");
  i->add_flag(
      "--suggest-labels", options->suggest_labels,
      "Prints a labels.yaml to fill in: the names of everything without a class, largest first");
  i->footer("Example:\n  modelhouse scene info model_house --json");
  i->callback([options] { info(*options); });

  CLI::App* l = command->add_subcommand("list",
                                        "Lists the categories of generated scenes and how many "
                                        "scenes have which density of objects.");
  l->add_flag("--json", options->json, "Prints JSON: one entry per environment");
  l->footer("Example:\n  modelhouse scene list");
  l->callback([options] { list(*options); });

  CLI::App* m = command->add_subcommand("make", "Generates a furnished room of a category.");
  m->add_option("category", options->scene, "A category that 'scene list' prints")->required();
  m->add_option("--seed", options->seed, "A different seed gives a different room")
      ->check(seed_number());
  m->add_option("--out", options->out, "File to write: .yaml (a plan), .glb or .ply (a lit mesh)");
  m->add_flag("--scan-look", options->scan_look,
              "Makes the mesh look like a handheld scan: colors per vertex, holes, bumps");
  m->add_flag("--json", options->json, "Prints JSON");
  m->footer(
      "Example:\n  modelhouse scene make bathroom --seed 3 --out bathroom.yaml\n"
      "Wherever a scene file is expected, generated:bathroom:3 stands for the same room.");
  m->callback([options] { make(*options); });

  CLI::App* p = command->add_subcommand("preview",
                                        "Draws a contact sheet: color, depth and labels of one "
                                        "scene, or one view of each of several.");
  p->add_option("scenes", options->scenes,
                "Scenes: files, names of shipped ones, or generated:CATEGORY:SEED");
  options->frame.add_to(*p);
  p->add_option("--each", options->each, "This many generated scenes of every category")
      ->check(CLI::Range(1, 1000));
  p->add_option("--per-room", options->per_room,
                "For one scene: at most this many views of each room")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  p->add_flag("--no-captions", options->no_captions,
              "For several scenes: images alone, without their names below");
  p->add_option("--out", options->out, "Image to write (PNG)")->required();
  p->footer(
      "Example:\n  modelhouse scene preview model_house --out house.png\n"
      "  modelhouse scene preview --each 2 --out categories.png");
  p->callback([options] { preview(*options); });

  CLI::App* c = command->add_subcommand("convert", "Writes a scene as a mesh with baked light.");
  c->add_option("scene", options->scene,
                "Scene (YAML), mesh file, ScanNet folder, or the name of a shipped scene")
      ->required();
  options->frame.add_to(*c);
  c->add_option("--out", options->out,
                "Mesh to write: .ply (ScanNet-like) or .glb; or a folder, for a ScanNet scene")
      ->required();
  c->add_option(
       "--format", options->format,
       "ply, glb or scannet (default: from the extension of --out, or scannet if it has none)")
      ->check(one_of_words({"ply", "glb", "scannet"}));
  c->footer(
      "Examples:\n  modelhouse scene convert model_house --out house.glb\n"
      "  modelhouse scene convert house.glb --out out/scene0000_00 --format scannet");
  c->callback([options] { convert(*options); });
  add_scene_statistics(*command);
}

}  // namespace mh::cli
