// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/commands.hpp"
#include "bench/pictures/canvas.hpp"
#include "bench/pictures/contact_sheet.hpp"
#include "bench/protocol/digest.hpp"
#include "bench/world/world.hpp"
#include "scenes/load.hpp"
#include "scenes/mesh_io/mesh_io.hpp"
#include "scenes/scannet/scannet.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;
constexpr int kThreads = 2;  // for baking light; changes no bit

struct Options {
  std::string scene, out, format;
  bool json = false;
};

/// Loads and says on stderr what had to be mended.
Scene load(const std::string& file) {
  std::vector<std::string> warnings;
  Scene scene = load_scene(file, &warnings);
  for (const std::string& warning : warnings)
    fmt::print(stderr, "modelhouse: warning: {}\n", warning);
  return scene;
}

void info(const Options& options) {
  const Scene scene = load(options.scene);
  std::map<ClassId, int> objects;
  for (const Instance& instance : scene.instances) ++objects[instance.class_id];
  if (options.json) {
    nlohmann::ordered_json by_class;
    for (const auto& [id, count] : objects) by_class[std::string(classes()[id].name)] = count;
    nlohmann::ordered_json rooms = nlohmann::ordered_json::array();
    for (const Room& room : scene.rooms) rooms.push_back(room.name);
    const nlohmann::ordered_json json = {{"name", scene.name},
                                         {"floor_area_m2", scene.floor_area_m2()},
                                         {"rooms", rooms},
                                         {"triangles", scene.triangles.size()},
                                         {"vertices", scene.positions_m.size()},
                                         {"materials", scene.materials.size()},
                                         {"objects", scene.instances.size()},
                                         {"classes", by_class},
                                         {"digest", hex(digest(scene))}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}\n  floor      {:.2f} m2 in {} rooms\n", scene.name, scene.floor_area_m2(),
             scene.rooms.size());
  for (const Room& room : scene.rooms) fmt::print("             {}\n", room.name);
  fmt::print("  triangles  {}\n  vertices   {}\n  materials  {}\n  lights     {}\n",
             scene.triangles.size(), scene.positions_m.size(), scene.materials.size(),
             scene.lights.size());
  fmt::print("  objects    {} of {} classes\n", scene.instances.size(), objects.size());
  for (const auto& [id, count] : objects)
    fmt::print("             {:>4}  {}\n", count, classes()[id].name);
  fmt::print("  digest     {}\n", hex(digest(scene)));
}

/// Finds out before the work whether a file can be written there.
void need_folder_of(const fs::path& file) {
  make_output_folder(file.has_parent_path() ? file.parent_path() : fs::path("."));
}

void preview(const Options& options) {
  if (fs::path(options.out).extension() != ".png" || fs::is_directory(options.out))
    throw InputError(fmt::format("{}: must name a file that ends in .png", options.out));
  need_folder_of(options.out);
  Scene scene = load(options.scene);
  light_scene(scene, kThreads);
  const auto renderer = make_scene_renderer(scene);
  write_picture(options.out, draw_contact_sheet(scene.name, views_of(scene, *renderer)));
}

void convert(const Options& options) {
  const std::string ending = fs::path(options.out).extension().string();
  std::string format = options.format;
  if (format.empty()) format = ending.empty() ? "scannet" : ending.substr(1);
  const bool folder = format == "scannet";
  if (!folder && (format != "ply" && format != "glb"))
    throw InputError(fmt::format(
        "{}: must end in .ply or .glb, or name a folder for a ScanNet scene", options.out));
  if (!folder && ending != "." + format)
    throw InputError(fmt::format("{}: must end in .{}", options.out, format));
  folder ? make_output_folder(options.out) : need_folder_of(options.out);
  Scene scene = load(options.scene);
  light_scene(scene, kThreads);
  if (folder)
    save_scannet(scene, options.out);
  else
    format == "ply" ? save_scannet_ply(scene, options.out) : save_glb(scene, options.out);
}

}  // namespace

void add_scene(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("scene", "Looks at scenes and converts them.");
  command->require_subcommand(1);
  command->footer("Example:\n  modelhouse scene info scenes/model_house/house.yaml");

  CLI::App* i = command->add_subcommand("info", "Prints area, triangles, objects and classes.");
  i->add_option("scene", options->scene, "Scene (YAML) or mesh file")->required();
  i->add_flag("--json", options->json, "Prints JSON");
  i->footer("Example:\n  modelhouse scene info scenes/model_house/house.yaml --json");
  i->callback([options] { info(*options); });

  CLI::App* p = command->add_subcommand("preview", "Draws a contact sheet: colour, depth, labels.");
  p->add_option("scene", options->scene, "Scene (YAML) or mesh file")->required();
  p->add_option("--out", options->out, "Picture to write (PNG)")->required();
  p->footer("Example:\n  modelhouse scene preview scenes/model_house/house.yaml --out house.png");
  p->callback([options] { preview(*options); });

  CLI::App* c = command->add_subcommand("convert", "Writes a scene as a mesh, light baked in.");
  c->add_option("scene", options->scene, "Scene (YAML), mesh file or ScanNet folder")->required();
  c->add_option(
       "--out", options->out,
       "Mesh to write: .ply (ScanNet-like) or .glb; or a folder, to become a ScanNet scene")
      ->required();
  c->add_option("--format", options->format,
                "ply, glb or scannet; default: by the ending of --out, a folder without one")
      ->check(CLI::IsMember({"ply", "glb", "scannet"}));
  c->footer(
      "Examples:\n  modelhouse scene convert scenes/model_house/house.yaml --out house.glb\n"
      "  modelhouse scene convert house.glb --out out/scene0000_00 --format scannet");
  c->callback([options] { convert(*options); });
}

}  // namespace mh::cli
