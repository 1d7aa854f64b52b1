// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/metrics/evaluate.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/cli/arguments.hpp"
#include "bench/cli/commands.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"

namespace mh::cli {
namespace {

struct EvaluateArguments {
  std::string truth, estimate;
  std::string align = "se3";
  std::string format = "tum";
  std::vector<std::string> deltas = {"1f", "1s"};
  bool all_pairs = false;
  double max_difference_s = 0.01;
  std::string offset = "0";
  double rate_hz = 10;
  bool json = false;
};

const std::map<std::string, Alignment> kAlignments = {{"se3", Alignment::kSe3},
                                                      {"sim3", Alignment::kSim3},
                                                      {"origin", Alignment::kOrigin},
                                                      {"none", Alignment::kNone}};

/// Parses "30f", "0.2m" or "1s". @throws InputError naming the text.
RpeDelta parse_delta(const std::string& text, bool all_pairs) {
  const auto fail = [&] {
    throw InputError(fmt::format("--delta: '{}' is not a distance such as 30f, 0.2m or 1s", text));
  };
  RpeDelta delta{.all_pairs = all_pairs};
  std::size_t end = 0;
  try {
    delta.value = std::stod(text, &end);
  } catch (const std::exception&) {
    fail();
  }
  const std::string unit = text.substr(end);
  if (unit == "f")
    delta.unit = DeltaUnit::kFrames;
  else if (unit == "m")
    delta.unit = DeltaUnit::kMeters;
  else if (unit == "s")
    delta.unit = DeltaUnit::kSeconds;
  else
    fail();
  if (!(delta.value > 0) || !std::isfinite(delta.value) ||
      (delta.unit == DeltaUnit::kFrames && delta.value != std::floor(delta.value)))
    fail();
  return delta;
}

std::string delta_name(const RpeDelta& delta) {
  return delta.unit == DeltaUnit::kFrames    ? counted(std::lround(delta.value), "frame")
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
                   {"all_pairs", r.delta.all_pairs || r.delta.unit != DeltaUnit::kFrames},
                   {"translation_m", to_json(r.translation_m)},
                   {"rotation_deg", to_json(r.rotation_deg)}});
  return {{"align", align},
          {"truth_path_m", e.truth_path_m},
          {"estimate_path_m", e.estimate_path_m},
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

/// Formats an error. If a trajectory diverged, its error may be millions of meters.
std::string cell(double error) {
  return error < 1000 ? fmt::format("{:>10.5f}", error) : fmt::format("{:>10.2e}", error);
}

void print_row(const std::string& what, const ErrorStatistics& s) {
  fmt::print("{:<30}", what);
  for (const double error : {s.rmse, s.mean, s.median, s.std, s.min, s.max})
    fmt::print("{:>10}", s.count == 0 ? "-" : cell(error));
  fmt::print("{:>9}\n", s.count);
}

constexpr Stamp kEarliest_ns = -10'000'000'000'000'000, kLatest_ns = 9'200'000'000'000'000'000;

/// Parses seconds exactly, with an optional minus sign. @throws InputError naming the text
Stamp parse_offset(const std::string& text) {
  const bool negative = text.starts_with('-');
  try {
    const Stamp offset_ns = parse_stamp(text.substr(negative ? 1 : 0));
    return negative ? -offset_ns : offset_ns;
  } catch (const InputError&) {
    throw InputError(
        fmt::format("--offset: '{}' is not a time in seconds from -9.2e9 to 9.2e9", text));
  }
}

/// Loads both files in one format. KITTI's lines have no stamps: lines with the same number belong
/// together.
std::pair<Trajectory, Trajectory> load(const EvaluateArguments& options) {
  const Stamp offset_ns = parse_offset(options.offset);
  if (options.format == "tum") {
    std::vector<std::string> notes;
    std::pair<Trajectory, Trajectory> both{read_trajectory(options.truth, &notes),
                                           read_trajectory(options.estimate, &notes)};
    for (const std::string& note : notes) fmt::print(stderr, "evaluate: warning: {}\n", note);
    for (TimedPose& pose : both.second) {
      // Within these limits, differences between stamps fit into a Stamp.
      if (offset_ns > kLatest_ns - pose.stamp_ns || offset_ns < kEarliest_ns - pose.stamp_ns)
        throw InputError("--offset: gives stamps that are not from -1e7 to 9.2e9 s");
      pose.stamp_ns += offset_ns;
    }
    return both;
  }
  if (offset_ns != 0) throw InputError("--offset: KITTI's poses have no stamps to add it to");
  const auto period_ns = static_cast<Stamp>(std::llround(1e9 / options.rate_hz));
  std::pair<Trajectory, Trajectory> both{read_kitti(options.truth, period_ns),
                                         read_kitti(options.estimate, period_ns)};
  if (both.first.size() != both.second.size())
    throw InputError(fmt::format("{}: {}, {} has {}: KITTI's lines must correspond",
                                 options.estimate, counted(both.second.size(), "pose"),
                                 options.truth, both.first.size()));
  return both;
}

/// "1305031100.001 to 1305031109.961 s".
std::string span(const Trajectory& trajectory) {
  return fmt::format("{:.3f} to {:.3f} s", 1e-9 * static_cast<double>(trajectory.front().stamp_ns),
                     1e-9 * static_cast<double>(trajectory.back().stamp_ns));
}

void run(const EvaluateArguments& options) {
  EvaluationOptions how{.alignment = kAlignments.at(options.align), .rpe_deltas = {}};
  how.max_difference_ns = options.format == "tum"
                              ? static_cast<Stamp>(std::llround(1e9 * options.max_difference_s))
                              : 0;
  for (const std::string& delta : options.deltas)
    how.rpe_deltas.push_back(parse_delta(delta, options.all_pairs));
  const auto [truth, estimate] = load(options);
  const Evaluation e = evaluate(truth, estimate, how);
  if (e.pairs == 0)
    throw InputError(fmt::format(
        "{}: no pose is within {:g} s of one in {}: its stamps are from {}, "
        "those of the truth from {} (--offset adds to its stamps)",
        options.estimate, options.max_difference_s, options.truth, span(estimate), span(truth)));
  if (options.json) {
    fmt::print("{}\n", to_json(e, options.align).dump(2));
    return;
  }
  fmt::print("{} of {} true and {}, aligned by {}\n", counted(e.pairs, "pair"), e.truth_poses,
             counted(e.estimate_poses, "estimated pose"), options.align);
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
  auto options = std::make_shared<EvaluateArguments>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Scores an estimated trajectory against the true one.");
  command->add_option("truth", options->truth, "True trajectory")->required();
  command->add_option("estimate", options->estimate, "Estimated trajectory")->required();
  command->add_option("--align", options->align, "How the estimate is aligned with the truth")
      ->check(one_of_words({"se3", "sim3", "origin", "none"}));
  command
      ->add_option("--format", options->format,
                   "Format of both files; tum also accepts EuRoC's CSV")
      ->check(one_of_words({"tum", "kitti"}));
  command
      ->add_option("--delta", options->deltas,
                   "Step of the relative error: 30f (frames), 0.2m or 1s; one or more")
      ->expected(1, 100);
  command->add_flag("--all-pairs", options->all_pairs,
                    "Steps in frames start at every pose (those in meters and seconds always do)");
  command
      ->add_option("--max-difference", options->max_difference_s,
                   "Largest difference in time between paired poses, s")
      ->check(number_between(0.0, 1e6));
  command
      ->add_option("--offset", options->offset,
                   "Added to the estimate's stamps, s; may be negative")
      ->default_str("0");
  command->add_option("--rate", options->rate_hz, "Poses per second of KITTI files")
      ->check(number_between(1e-3, 1e6));
  command->add_flag("--json", options->json, "Prints JSON");
  command->footer(
      "Examples:\n  modelhouse evaluate groundtruth.txt estimate.tum --align se3\n"
      "  modelhouse evaluate 00_truth.txt 00.txt --format kitti --delta 100m --json");
  command->callback([options] { run(*options); });
}

}  // namespace mh::cli
