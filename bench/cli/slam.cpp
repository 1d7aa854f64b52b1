// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <fmt/format.h>

#include "bench/cli/commands.hpp"
#include "bench/cli/progress.hpp"
#include "bench/metrics/trajectory_io.hpp"
#include "bench/recorded/tum_folder.hpp"
#include "bench/systems/ours.hpp"
#include "bench/systems/timed.hpp"
#include "slam/core/error.hpp"
#include "slam/core/files.hpp"

namespace mh::cli {
namespace {

struct Options {
  std::string source, settings, vocabulary, out;
  double gamma = SemanticConfig{}.gamma, xi = SemanticConfig{}.xi;
  bool plain = false;
  std::uint64_t seed = 0;
};

void run(const Options& options) {
  constexpr std::string_view kTum = "tum:";
  if (!options.source.starts_with(kTum))
    throw InputError(fmt::format("source '{}' must be tum:FOLDER", options.source));
  make_output_folder(options.out);
  const RecordedCamera camera = load_recorded_camera(options.settings);
  const auto vocabulary = std::make_shared<const Vocabulary>(Vocabulary::load(options.vocabulary));
  const std::vector<RecordedFrame> frames = load_tum_folder(options.source.substr(kTum.size()));

  SlamConfig config;
  config.semantics.gamma = options.gamma;
  config.semantics.xi = options.xi;
  if (options.plain) config.semantics = config.semantics.neutralised();
  TimedSystem system(make_our_system(camera.camera, config, vocabulary));
  Progress progress("slam");
  const RandomStream stream(options.seed);
  std::size_t tracked = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const StepReport report = system.track(read_frame(frames[i], camera), stream.fork(i));
    tracked += report.status == TrackStatus::kLost ? 0 : 1;
    progress.share(static_cast<double>(i + 1) / static_cast<double>(frames.size()));
  }
  write_tum(std::filesystem::path(options.out) / "estimate.tum", system.trajectory());
  const TimeSummary times = summarize(system.times().track_ms);
  fmt::print("{} of {} frames tracked; {:.1f} ms per frame (median; 95 % below {:.1f} ms)\n",
             tracked, frames.size(), times.median_ms, times.p95_ms);
}

}  // namespace

void add_slam(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("slam", "Runs SLAM on a recorded sequence.");
  command->add_option("source", options->source, "tum:FOLDER")->required();
  command->add_option("--settings", options->settings, "Calibration (YAML, ORB-SLAM's keys)")
      ->required();
  command->add_option("--vocabulary", options->vocabulary, "Vocabulary file")->required();
  command->add_option("--out", options->out, "Folder for estimate.tum")->required();
  command->add_option("--gamma", options->gamma, "Weight of a label, equation 1")
      ->check(CLI::Range(0.0, 1e6));
  command->add_option("--xi", options->xi, "Penalty of labels that differ, equation 2")
      ->check(CLI::Range(1.0, 1e6));
  command->add_flag("--plain", options->plain, "Without semantics");
  command->add_option("--seed", options->seed, "Seed of RANSAC");
  command->footer(
      "Example:\n  modelhouse slam tum:out/sequence --settings out/sequence/camera.yaml "
      "--vocabulary assets/vocabulary.mhvoc --out out/slam");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
