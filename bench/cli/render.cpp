// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>

#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/recorded/scannet_folder.hpp"
#include "bench/recorded/tum_folder.hpp"
#include "bench/world/world.hpp"
#include "sim/sensors/shutter.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh::cli {
namespace {

struct Options {
  std::string scene, tour, robot, level, out, renderer = "embree", format = "tum";
  std::size_t frames = SIZE_MAX, every = 1;
  std::uint64_t seed = 0;
};

/// Pictures of two tours in one folder would be taken for one sequence.
void refuse_older_sequence(const std::filesystem::path& folder) {
  const auto refuse = [&] {
    throw InputError(
        fmt::format("{}: holds a sequence already; name another folder", folder.string()));
  };
  for (const char* part : {"rgb", "rgb.txt"})
    if (std::filesystem::exists(folder / part)) refuse();
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".sens") refuse();
}

void run(const Options& options) {
  refuse_older_sequence(options.out);
  make_renderer(options.renderer, Scene{});  // a machine that lacks it says so at once
  make_output_folder(options.out);
  const Robot robot = load_robot(options.robot);
  const Tour tour = load_tour(options.tour);
  SensorConfig sensors;
  sensors.depth_noise_on = sensors.colour_noise_on = false;
  if (!options.level.empty()) sensors = load_sensor_config(options.level);
  Progress progress("render");
  progress.say(fmt::format("scene {}", options.scene));
  const Scene scene = load_lit_scene(options.scene, 2);
  const std::shared_ptr<const Renderer> renderer = make_scene_renderer(scene, options.renderer);
  const DrivenPath path = drive(scene, robot, tour);

  const std::size_t last = std::min(options.frames, path.camera.size());
  const RandomStream noise(options.seed);
  const Shutter shutter(renderer, robot.camera, path.camera, sensors);
  const std::size_t count = (last + options.every - 1) / options.every;
  const auto frame_at = [&](std::size_t index) {
    const std::size_t i = index * options.every;
    const TimedPose& pose = path.camera[i];
    Shutter::Exposed exposed = shutter.expose(i);
    RgbdFrame frame =
        sense(exposed.seen, shutter.camera(), sensors, noise.fork(i), pose.stamp_ns, exposed.gain);
    progress.share(static_cast<double>(i + 1) / static_cast<double>(last));
    return ExactFrame{std::move(frame), std::move(exposed.seen), pose.world_from_camera};
  };
  if (options.format == "scannet") {
    write_scannet_recording(options.out, shutter.camera(), count, frame_at);
    return;
  }
  TumWriter writer(options.out, shutter.camera());
  for (std::size_t i = 0; i < count; ++i) {
    const ExactFrame frame = frame_at(i);
    writer.add(frame.seen, frame.exact, frame.world_from_camera);
  }
  writer.finish();
}

}  // namespace

void add_render(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "render", "Writes what a robot sees along a tour, in TUM's or ScanNet's layout.");
  command->add_option("scene", options->scene, "Scene (YAML) or mesh file")->required();
  command->add_option("tour", options->tour, "Tour (YAML)")->required();
  command->add_option("--robot", options->robot, "Robot (YAML)")->required();
  command->add_option("--level", options->level, "Sensor level (YAML); without: no noise");
  command->add_option("--out", options->out, "Folder to write")->required();
  command
      ->add_option("--format", options->format,
                   "tum (default): folders and lists; scannet: .sens, label images")
      ->check(CLI::IsMember({"tum", "scannet"}));
  command->add_option("--frames", options->frames, "At most so many frames of the tour")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--every", options->every, "Every n-th frame only")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--renderer", options->renderer, "embree (default) or osmesa");
  command->add_option("--seed", options->seed, "Seed of the noise");
  command->footer(
      "Example:\n  modelhouse render scenes/model_house/house.yaml "
      "scenes/model_house/tours/query.yaml --robot robots/pepper/pepper.yaml "
      "--level sim/sensors/levels/pepper.yaml --out out/sequence --every 10");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
