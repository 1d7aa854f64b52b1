// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/report/drawing/false_colors.hpp"
#include "bench/suite/protocol_config.hpp"
#include "bench/suite/suite.hpp"
#include "robots/model/robot_keys.hpp"
#include "scenes/furniture/furniture.hpp"
#include "scenes/materials/materials.hpp"
#include "sim/sensors/config.hpp"
#include "slam/config/slam.hpp"
#include "slam/core/labels.hpp"
#include "slam/detect/settings.hpp"
#include "slam/io/settings_io.hpp"

namespace mh::cli {
namespace {

/// A heading and a note on how the page is generated, so that nobody edits it by hand.
std::string heading(const char* title, const char* what) {
  return fmt::format(
      "# {}\n\nMade by `modelhouse reference {}`; a test checks this page against the code.\n\n",
      title, what);
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
      "Values of `kind` for an item in a house ([formats.md](../formats.md)). The usual size is\n"
      "width x depth x height; `size_m` changes it. `materials` of an item may name the roles.\n\n"
      "| kind | class | stands on | usual size, m | roles of materials |\n"
      "|---|---|---|---|---|\n";
  for (const FurnitureKind& kind : furniture_kinds())
    text += fmt::format("| `{}` | {} | {} | {:g} x {:g} x {:g} | {} |\n", kind.name,
                        kind.class_name, place_of(kind.mount), kind.size_m.x(), kind.size_m.y(),
                        kind.size_m.z(), kind.roles.empty() ? "-" : kind.roles);
  return text;
}

std::string materials() {
  std::string text = heading("Kinds of materials", "materials");
  text +=
      "Values of `kind` for a material ([formats.md](../formats.md)). An image fills its surface\n"
      "once; everything else repeats without a seam.\n\n"
      "| kind | fills its surface |\n"
      "|---|---|\n";
  for (const std::string_view kind : material_kinds())
    text += fmt::format("| `{}` | {} |\n", kind, is_image(kind) ? "once" : "by repeating");
  return text;
}

std::string class_table() {
  std::string text = heading("Classes", "classes");
  text +=
      "Values of a label: the 40 classes of NYU40, *void* (unknown), *background* (a detector "
      "looked\n"
      "and found nothing), and classes of COCO that NYU40 lumps together. Colors are those of "
      "label\n"
      "images.\n\n"
      "| id | class | in NYU40 files | in COCO's 80 | color |\n"
      "|---|---|---|---|---|\n";
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

/// A table for each section of settings, made from the lists of their fields.
class SettingsTables {
 public:
  void section(const char* name) {
    text_ +=
        fmt::format("\n## {}\n\n| key | default | range | meaning |\n|---|---|---|---|\n", name);
  }
  template <class T>
  void operator()(const char* key, const T& value, const SettingRange& range, const char* meaning) {
    text_ += fmt::format("| `{}` | {} | {} | {} |\n", key,
                         range.required ? "must be given" : SettingsWriter::word_of(value),
                         values<T>(range), meaning);
  }
  const std::string& text() const { return text_; }

 private:
  template <class T>
  static std::string values(const SettingRange& range) {
    if constexpr (kIsOptional<T>) {
      return values<typename T::value_type>(range);
    } else if constexpr (kIsVector<T>) {
      return "list of " + values<typename T::value_type>(range);
    } else if constexpr (std::is_same_v<T, std::string>) {
      return "words";
    } else if constexpr (std::is_same_v<T, bool>) {
      return "true, false";
    } else if constexpr (std::is_enum_v<T>) {
      std::vector<std::string_view> list;
      for (const auto& [word, value] : words(T{})) list.push_back(word);
      return fmt::format("{}", fmt::join(list, ", "));
    } else {
      return interval(range) + (std::is_integral_v<T> ? ", whole" : "");
    }
  }

  std::string text_;
};

/// Sets `enabled` in every section, since a level that has a section enables it.
struct SwitchOn {
  void section(const char*) const {}
  template <class T>
  void operator()(std::string_view key, T& value, const SettingRange&, const char*) const {
    if constexpr (std::is_same_v<T, bool>) value = value || key == "enabled";
  }
};

std::string slam_settings() {
  const SlamConfig config;
  SettingsTables tables;
  for_each_setting(config, tables);
  return heading("Settings of SLAM", "slam") +
         "Sections of a settings file and of `slam` in a suite ([slam.md](../slam.md#settings)).\n"
         "`modelhouse slam --print-settings` prints such a file.\n" +
         tables.text();
}

std::string sensors() {
  SensorConfig config;
  for_each_setting(config, SwitchOn{});
  SettingsTables tables;
  for_each_setting(std::as_const(config), tables);
  return heading("Keys of a sensor level", "sensors") +
         "Every level must contain `depth_noise` and `color_noise`; the other sections are off "
         "unless\n"
         "they are present. Defaults apply to a section that is present. "
         "[sensors.md](../sensors.md)\n"
         "explains each fault and where its numbers come from. `modelhouse sensors "
         "--print-settings\n"
         "[--level LEVEL]` prints a level with every key.\n" +
         tables.text();
}

std::string protocol() {
  SettingsTables tables;
  tables.section("protocol");
  const ProtocolConfig config;
  fields(config, tables);
  return heading("Settings of the protocol", "protocol") +
         "The section `protocol` of a suite; [protocol.md](../protocol.md) explains the terms.\n"
         "`modelhouse bench --print-settings` prints it.\n" +
         tables.text();
}

/// A table of the sources that a record in a suite can name.
template <class Record>
std::string source_table(const char* title, const Record& record) {
  std::string text = fmt::format("\n## {}\n\n| key | value | meaning |\n|---|---|---|\n", title);
  sources(record, [&](const WorldSource& source, const auto&) {
    text += fmt::format("| `{}` | {} | {} |\n", source.key, forms(source.kind), source.meaning);
  });
  return text;
}

std::string suite() {
  const Suite suite;
  const GradedSpec graded;
  const EpisodesSpec episodes;
  const OutsideProgram program;
  SettingsTables top, rest;
  top.section("At the top");
  fields(suite, top);
  rest.section("systems: limits of an outside system");
  limits(program, [&](const char* key, double value, const SettingRange& range, const char* meaning,
                      std::optional<OutsideMode> only) {
    const std::string where = only ? fmt::format("protocol `{}`: ", name(*only)) : "";
    rest(key, value, range, (where + meaning).c_str());
  });
  rest.section("graded");
  fields(graded, rest);
  rest.section("episodes");
  episode_settings(episodes, rest);
  rest.section("stress");
  const StressSpec stress;
  fields(stress, rest);
  rest.section("stress.dials: each");
  const StressDial dial;
  fields(dial, rest);
  return heading("Keys of a suite", "suite") +
         "Keys with a single value or file; for lists and mappings, see "
         "[formats.md](../formats.md#suite-benchsuitesyaml).\n" +
         top.text() + source_table("environments: a scene", Environment{}) + rest.text() +
         source_table("episodes.variants", EpisodeVariant{});
}

std::string detector() {
  SettingsTables tables;
  tables.section("At the top");
  const DetectorSettings settings;
  fields(settings, tables);
  return heading("Settings of a detector", "detector") +
         "Keys of a file for `--detector-settings` and of a mapping in `labels` of a suite\n"
         "([detector.md](../detector.md)), in addition to `network`, `config`, `classes` and "
         "`boxes`.\n" +
         tables.text();
}

struct Page {
  const char* name;
  std::string (*text)();
};
constexpr std::array<Page, 9> kPages{{{"furniture", furniture},
                                      {"materials", materials},
                                      {"classes", class_table},
                                      {"robot", robot},
                                      {"slam", slam_settings},
                                      {"sensors", sensors},
                                      {"protocol", protocol},
                                      {"suite", suite},
                                      {"detector", detector}}};

}  // namespace

void add_reference(CLI::App& app) {
  auto what = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "reference",
      "Lists kinds of furniture, materials or classes, or the keys of a kind of file.");
  std::vector<std::string> names;
  for (const Page& page : kPages) names.emplace_back(page.name);
  command->add_option("what", *what, "Which list")->required()->check(one_of_words(names));
  command->footer("Example:\n  modelhouse reference furniture");
  command->callback([what] {
    for (const Page& page : kPages)
      if (*what == page.name) fmt::print("{}", page.text());
  });
}

}  // namespace mh::cli
