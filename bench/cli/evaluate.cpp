// SPDX-License-Identifier: Apache-2.0
#include "bench/metrics/evaluate.hpp"

#include <map>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/commands.hpp"
#include "bench/metrics/trajectory_io.hpp"
#include "slam/core/error.hpp"

namespace mh::cli {
namespace {

struct Options {
  std::string truth, estimate;
  std::string align = "se3";
  bool json = false;
};

const std::map<std::string, Alignment> kAlignments = {{"se3", Alignment::kSe3},
                                                      {"sim3", Alignment::kSim3},
                                                      {"origin", Alignment::kOrigin},
                                                      {"none", Alignment::kNone}};

std::string delta_name(const RpeDelta& delta) {
  return delta.unit == DeltaUnit::kFrames    ? fmt::format("{} frame(s)", delta.value)
         : delta.unit == DeltaUnit::kSeconds ? fmt::format("{} s", delta.value)
                                             : fmt::format("{} m", delta.value);
}

nlohmann::ordered_json to_json(const ErrorStatistics& s) {
  if (s.count == 0) return nullptr;  // unknown, not 0
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"sse", s.sse},       {"count", s.count}};
}

nlohmann::ordered_json to_json(const Evaluation& e, const std::string& align) {
  nlohmann::ordered_json rpe = nlohmann::ordered_json::array();
  for (const RelativeScore& r : e.rpe)
    rpe.push_back({{"delta", delta_name(r.delta)},
                   {"translation_m", to_json(r.translation_m)},
                   {"rotation_deg", to_json(r.rotation_deg)}});
  return {{"align", align},
          {"truth_poses", e.truth_poses},
          {"estimate_poses", e.estimate_poses},
          {"pairs", e.pairs},
          {"scale", e.truth_from_estimate ? nlohmann::ordered_json(e.truth_from_estimate->scale)
                                          : nlohmann::ordered_json()},
          {"ape_translation_m", to_json(e.ape_translation_m)},
          {"ape_rotation_deg", to_json(e.ape_rotation_deg)},
          {"ape_unaligned_m", to_json(e.ape_unaligned_m)},
          {"rpe", rpe}};
}

void print_row(const std::string& what, const ErrorStatistics& s) {
  if (s.count == 0) {
    fmt::print("{:<30}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>9}\n", what, "-", "-", "-", "-", "-",
               "-", 0);
    return;
  }
  fmt::print("{:<30}{:>10.5f}{:>10.5f}{:>10.5f}{:>10.5f}{:>10.5f}{:>10.5f}{:>9}\n", what, s.rmse,
             s.mean, s.median, s.std, s.min, s.max, s.count);
}

void run(const Options& options) {
  const Trajectory truth = read_tum(options.truth);
  const Trajectory estimate = read_tum(options.estimate);
  const Evaluation e = evaluate(truth, estimate, {.alignment = kAlignments.at(options.align)});
  if (e.pairs == 0)
    throw InputError(
        fmt::format("{}: no pose is within 0.01 s of one in {}", options.estimate, options.truth));
  if (options.json) {
    fmt::print("{}\n", to_json(e, options.align).dump(2));
    return;
  }
  fmt::print("{} pairs of {} true and {} estimated poses, aligned by {}\n", e.pairs, e.truth_poses,
             e.estimate_poses, options.align);
  if (!e.truth_from_estimate)
    fmt::print("the alignment is undetermined: too few poses, or all on a line\n");
  fmt::print("{:<30}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>9}\n", "", "rmse", "mean", "median",
             "std", "min", "max", "count");
  print_row("absolute, position (m)", e.ape_translation_m);
  print_row("absolute, rotation (deg)", e.ape_rotation_deg);
  print_row("absolute, unaligned (m)", e.ape_unaligned_m);
  for (const RelativeScore& r : e.rpe) {
    print_row("relative, " + delta_name(r.delta) + " (m)", r.translation_m);
    print_row("relative, " + delta_name(r.delta) + " (deg)", r.rotation_deg);
  }
}

}  // namespace

void add_evaluate(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "Scores an estimated trajectory against the true one (both TUM text).");
  command->add_option("truth", options->truth, "True trajectory")->required();
  command->add_option("estimate", options->estimate, "Estimated trajectory")->required();
  command->add_option("--align", options->align, "se3 (default), sim3, origin or none")
      ->check(CLI::IsMember(kAlignments));
  command->add_flag("--json", options->json, "Prints JSON");
  command->footer("Example:\n  modelhouse evaluate groundtruth.txt estimate.tum --align se3");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
