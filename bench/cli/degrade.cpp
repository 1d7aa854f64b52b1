// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/cli/sequence_source.hpp"
#include "bench/cli/set_option.hpp"
#include "bench/run/signal_watch.hpp"
#include "bench/suite/level.hpp"
#include "bench/suite/shipped.hpp"
#include "scenes/recordings/file_checksums.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/tum_folder.hpp"
#include "sim/simulation/faulty_sequence.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/number_in.hpp"

namespace mh::cli {
namespace {

struct DegradeArguments {
  SourceOptions source;
  std::string level = kRecordedLevel, out;
  std::vector<std::string> doses;
};

/// The level with the doses of the command line.
SensorConfig level_of(DegradeArguments& options) {
  if (options.level != kRecordedLevel) resolve(options.level, Shipped::kLevel);
  Level level{.file = options.level, .of_recordings = true};
  for (const auto& [dial, value] : named_values("--dose", options.doses)) {
    const std::optional<double> dose = number_in(value);
    if (!dose) throw InputError(fmt::format("--dose {}={}: is no number", dial, value));
    level.doses.push_back({dial, *dose});
  }
  return sensors_at(level);
}

/// @throws InputError if the folder holds a recording, so that nothing is overwritten
void refuse_older(const DegradeArguments& options) {
  const std::filesystem::path out = options.out;
  for (const char* part : {"rgb.txt", "associations.txt", "groundtruth.txt", "level.yaml"})
    if (std::filesystem::exists(out / part))
      throw InputError(fmt::format("{}: already holds a recording ({}); name another folder",
                                   out.string(), part));
}

void run(DegradeArguments options) {
  const SensorConfig level = level_of(options);
  if (effective(level) == effective(exact_sensors()))
    throw InputError("changes nothing: name a --level, or a --dose of one of its dials");
  options.source.check();
  if (options.source.is_scene())
    throw InputError("degrades recordings; for a scene, use `render --level`");
  refuse_older(options);
  Source source = open_source(options.source);
  const std::size_t recorded = source.frames->size();
  const std::shared_ptr<const Sequence> frames = degraded(std::move(source.frames), level);
  const std::filesystem::path out = options.out;
  const OutputFolder folder(
      out, "degrade",
      {"rgb", "rgb.txt", "depth", "depth.txt", "label", "label.txt", "associations.txt",
       "groundtruth.txt", "camera.yaml", "camera_info.yaml", "level.yaml", FileChecksums::kName});
  for (const char* images : {"rgb", "depth", "label"})  // of an interrupted run
    std::filesystem::remove_all(out / images);
  Progress progress("degrade");
  const SignalWatch watch;
  TumWriter writer(out, frames->camera());
  std::size_t skipped = 0;
  for (std::size_t i = 0; i < frames->size(); ++i) {
    if (watch.signal() != 0) throw Interrupted{watch.signal(), false};
    try {
      writer.add(frames->frame(i, RandomStream(options.source.seed)));
    } catch (const InputError& error) {
      progress.say(fmt::format("warning: skipped: {}", error.what()));
      ++skipped;
    }
    progress.share(static_cast<double>(i + 1) / static_cast<double>(frames->size()));
  }
  writer.finish();
  if (const Trajectory* truth = frames->truth()) write_tum(out / "groundtruth.txt", *truth);
  write_atomically(out / "level.yaml", format_sensor_config(level));
  progress.end();
  fmt::print("{}: {} of {} frames\n", out.string(), frames->size() - skipped, recorded);
}

}  // namespace

void add_degrade(CLI::App& app) {
  auto options = std::make_shared<DegradeArguments>();
  CLI::App* command = app.add_subcommand(
      "degrade", "Adds a level's faults to a recording and writes it in TUM's layout.");
  SourceOptions& source = options->source;
  command
      ->add_option("recording", source.source,
                   sequence_forms() + ", or a path whose layout is recognized")
      ->required();
  command->add_option("--level", options->level,
                      "Level whose faults are added: a file (YAML), or the name of a shipped one");
  command
      ->add_option("--dose", options->doses,
                   "DIAL=VALUE: changes a dial of the level, such as lens_blur.sigma_px=2; several "
                   "are possible")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "Folder to write")->required();
  command->add_option("--settings", source.settings,
                      "Settings (YAML) with the calibration (default: the folder's camera.yaml)");
  command->add_option("--classes", source.classes,
                      "What the labels of the recording mean (YAML), if they are not our classes");
  command->add_option("--topics", source.topics,
                      "Topics of a bag or MCAP file, if several could be meant");
  command->add_option("--seed", source.seed, "Seed of the noise")->check(seed_number());
  command->footer(
      "Example:\n  modelhouse degrade tum:rgbd_dataset_freiburg1_desk --dose light.share=0.1 "
      "--out dark_desk");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
