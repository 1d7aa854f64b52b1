// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/usual_cache.hpp"
#include "bench/lab/figures.hpp"
#include "bench/lab/sheets.hpp"
#include "bench/protocol/world/cached_light.hpp"
#include "scenes/load.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "sim/sensors/config.hpp"
#include "sim/sensors/difficulty.hpp"
#include "sim/simulation/lit_scene.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct SensorsArguments {
  std::string scene, out, level;
  std::optional<double> difficulty;
};

void print_settings(SensorsArguments options) {
  SensorConfig config;
  if (!options.level.empty()) {
    resolve(options.level, Shipped::kLevel);
    config = load_sensor_config(options.level);
  }
  if (options.difficulty) config = at_difficulty(config, *options.difficulty);
  fmt::print("{}", format_sensor_config(config, true));
}

void plot(const SensorsArguments& options) {
  const OutputFolder folder(options.out, "sensors plot", {"figures.png"});
  const fs::path file = fs::path(options.out) / "figures.png";
  Progress progress("sensors plot");
  std::vector<Plot> plots;
  const std::array<std::pair<const char*, std::vector<Plot> (*)()>, 3> groups = {
      {{"depth", depth_figures}, {"light", light_figures}, {"labels", label_figures}}};
  for (std::size_t i = 0; i < groups.size(); ++i) {
    progress.share(static_cast<double>(i) / groups.size(), groups[i].first);
    for (Plot& plot : groups[i].second()) plots.push_back(std::move(plot));
  }
  progress.share(1);
  progress.end();
  write_plots(file, {"Sensor models: published (lines) and measured (dots)", plots});
  fmt::print("{}\n", file.string());
}

void sheet(SensorsArguments options) {
  resolve(options.scene, Shipped::kScene);
  const OutputFolder folder(options.out, "sensors sheet",
                            {"color.png", "depth.png", "frames.png", "labels.png"});
  Progress light("light");
  Scene scene = load_scene(options.scene);
  light_from_cache(scene, 2, usual_cache(), {}, [&](double share) { light.share(share); });
  light.end();
  const SensorSheets sheets = draw_sensor_sheets(scene, make_scene_renderer(scene));
  for (const auto& [name, image] :
       {std::pair("color.png", sheets.color), std::pair("depth.png", sheets.depth),
        std::pair("frames.png", sheets.frames), std::pair("labels.png", sheets.labels)}) {
    const fs::path file = fs::path(options.out) / name;
    write_image(file, image);
    fmt::print("{}\n", file.string());
  }
}

}  // namespace

void add_sensors(CLI::App& app) {
  auto options = std::make_shared<SensorsArguments>();
  CLI::App* command = app.add_subcommand("sensors", "Shows what the sensor models do.");
  command->require_subcommand(1);
  CLI::Option* level =
      command->add_option("--level", options->level,
                          "For --print-settings: level (YAML), or the name of a shipped one");
  CLI::Option* difficulty = command->add_option(
      "--difficulty", options->difficulty,
      "For --print-settings: makes the level harder, 0 (as it is) to 1 (docs/sensors.md)");
  CLI::Option* print = command->add_flag_callback(
      "--print-settings",
      [options] {
        print_settings(*options);
        throw CLI::Success();
      },
      "Prints every key of a sensor level with its value, meaning and range");
  level->needs(print);
  difficulty->needs(level);
  command->footer(
      "Examples:\n  modelhouse sensors plot --out out/sensors\n"
      "  modelhouse sensors --print-settings --level handheld\n"
      "  modelhouse sensors --print-settings --level handheld --difficulty 0.5 > harder.yaml");

  CLI::App* p = command->add_subcommand(
      "plot", "Plots what each model's source published next to what is measured of the model.");
  p->add_option("--out", options->out, "Folder to write")->required();
  p->footer("Example:\n  modelhouse sensors plot --out out/sensors");
  p->callback([options] { plot(*options); });

  CLI::App* s = command->add_subcommand(
      "sheet", "Draws contact sheets of each factor: off, mild, strong; the same view each time.");
  s->add_option("scene", options->scene, "Scene (YAML), mesh file, or the name of a shipped scene")
      ->required();
  s->add_option("--out", options->out, "Folder to write")->required();
  s->footer("Example:\n  modelhouse sensors sheet model_house --out out/sensors");
  s->callback([options] { sheet(*options); });
}

}  // namespace mh::cli
