// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/drawing/false_colors.hpp"
#include "robots/model/robot_keys.hpp"
#include "scenes/furniture/furniture.hpp"
#include "scenes/materials/materials.hpp"
#include "slam/core/labels.hpp"

namespace mh::cli {
namespace {

/// States where a page comes from, so that nobody edits it by hand.
std::string heading(const char* title, const char* what) {
  return fmt::format(
      "# {}\n\nMade by `modelhouse reference {}`; a test holds this page to the code.\n\n", title,
      what);
}

const char* place_of(Mount mount) {
  switch (mount) {
    case Mount::kFloor:
      return "floor";
    case Mount::kWall:
      return "wall";
    case Mount::kCeiling:
      return "ceiling";
    case Mount::kOnPiece:
      return "on another piece";
  }
  return "";
}

std::string furniture() {
  std::string text = heading("Kinds of furniture", "furniture");
  text +=
      "What `kind` of an item in a house may be ([formats.md](../formats.md)). The usual size is\n"
      "width x depth x height; `size_m` changes it. Roles are what `materials` of an item may "
      "name.\n\n"
      "| kind | class | stands on | usual size, m | roles of materials |\n|---|---|---|---|---|\n";
  for (const FurnitureKind& kind : furniture_kinds())
    text += fmt::format("| `{}` | {} | {} | {:g} x {:g} x {:g} | {} |\n", kind.name,
                        kind.class_name, place_of(kind.mount), kind.size_m.x(), kind.size_m.y(),
                        kind.size_m.z(), kind.roles.empty() ? "-" : kind.roles);
  return text;
}

std::string materials() {
  std::string text = heading("Kinds of materials", "materials");
  text +=
      "What `kind` of a material may be ([formats.md](../formats.md)). A picture fills its "
      "surface\n"
      "once; everything else repeats without a seam.\n\n| kind | fills its surface |\n|---|---|\n";
  for (const std::string_view kind : material_kinds())
    text += fmt::format("| `{}` | {} |\n", kind, is_picture(kind) ? "once" : "by repeating");
  return text;
}

std::string class_table() {
  std::string text = heading("Classes", "classes");
  text +=
      "What a label may be: the 40 classes of NYU40, *void* (nobody knows), *background* (a "
      "detector\n"
      "looked and found nothing), and classes of COCO that NYU40 lumps together. Colors are those "
      "of\n"
      "pictures of labels.\n\n| id | class | in NYU40 files | in COCO's 80 | color "
      "|\n|---|---|---|---|---|\n";
  for (const ClassInfo& info : classes()) {
    const Rgb8 color = class_color(info.id);
    text += fmt::format("| {} | {} | {} | {} | `#{:02x}{:02x}{:02x}` |\n", info.id, info.name,
                        info.nyu40, info.coco80 < 0 ? "-" : std::to_string(info.coco80), color.r,
                        color.g, color.b);
  }
  return text;
}

std::string robot() {
  std::string text = heading("Keys of a robot's file", "robot");
  text +=
      "`robots/pepper/pepper.yaml` is an example. NAME stands for any name; ranges are "
      "inclusive.\n";
  std::string_view mapping = "none";
  for (const RobotKey& key : robot_keys()) {
    if (key.mapping != mapping) {
      mapping = key.mapping;
      text += fmt::format("\n## {}\n\n| key | value | meaning |\n|---|---|---|\n",
                          mapping.empty() ? "At the top" : mapping);
    }
    text += fmt::format("| `{}`{} | {} | {} |\n", key.key, key.required ? "" : " (optional)",
                        key.value, key.meaning);
  }
  return text;
}

}  // namespace

void add_reference(CLI::App& app) {
  auto what = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "reference", "Lists kinds of furniture, materials, classes or robot keys.");
  command->add_option("what", *what, "Which list")
      ->required()
      ->check(one_of_words({"furniture", "materials", "classes", "robot"}));
  command->footer("Example:\n  modelhouse reference furniture");
  command->callback([what] {
    fmt::print("{}", *what == "furniture"   ? furniture()
                     : *what == "materials" ? materials()
                     : *what == "classes"   ? class_table()
                                            : robot());
  });
}

}  // namespace mh::cli
