// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/pictures/canvas.hpp"
#include "bench/sensors/figures.hpp"
#include "bench/sensors/sheets.hpp"
#include "bench/world/world.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string scene, out;
};

void plot(const Options& options) {
  const OutputFolder folder(options.out, "sensors plot", {"figures.png"});
  const fs::path file = fs::path(options.out) / "figures.png";
  std::vector<Plot> plots = depth_figures();
  for (const auto& more : {light_figures(), label_figures()})
    plots.insert(plots.end(), more.begin(), more.end());
  write_picture(file, draw_plots("Sensor models: published (lines) and measured (dots)", plots));
  fmt::print("{}\n", file.string());
}

void sheet(const Options& options) {
  const OutputFolder folder(options.out, "sensors sheet",
                            {"colour.png", "depth.png", "frames.png", "labels.png"});
  const Scene scene = load_lit_scene(options.scene, 2);
  const SensorSheets sheets = draw_sensor_sheets(scene, make_scene_renderer(scene));
  for (const auto& [name, picture] :
       {std::pair("colour.png", sheets.colour), std::pair("depth.png", sheets.depth),
        std::pair("frames.png", sheets.frames), std::pair("labels.png", sheets.labels)}) {
    const fs::path file = fs::path(options.out) / name;
    write_picture(file, picture);
    fmt::print("{}\n", file.string());
  }
}

}  // namespace

void add_sensors(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("sensors", "Shows what the sensor models do.");
  command->require_subcommand(1);
  command->footer("Example:\n  modelhouse sensors plot --out out/sensors");

  CLI::App* p = command->add_subcommand(
      "plot", "Plots the figure of each model's source beside what is measured of the model.");
  p->add_option("--out", options->out, "Folder to write")->required();
  p->footer("Example:\n  modelhouse sensors plot --out out/sensors");
  p->callback([options] { plot(*options); });

  CLI::App* s = command->add_subcommand(
      "sheet", "Draws contact sheets of each factor: off, mild, strong; the same view each time.");
  s->add_option("scene", options->scene, "Scene (YAML) or mesh file")->required();
  s->add_option("--out", options->out, "Folder to write")->required();
  s->footer("Example:\n  modelhouse sensors sheet scenes/model_house/house.yaml --out out/sensors");
  s->callback([options] { sheet(*options); });
}

}  // namespace mh::cli
