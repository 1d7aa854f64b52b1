// SPDX-License-Identifier: Apache-2.0
#include "bench/cli/slam_report.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/results/rows.hpp"
#include "bench/systems/timed.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/files/export.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/files.hpp"
#include "slam/io/printable.hpp"
#include "slam/io/temporary_folder.hpp"

namespace mh::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux reports kB
}

constexpr auto kStages = static_cast<std::size_t>(Stage::kCount);

Json times_json(const SlamReport& report) {
  const auto entry = [](const std::vector<double>& ms) {
    const TimeSummary times = summarize(ms);
    return Json{{"frames", ms.size()}, {"median_ms", times.median_ms}, {"p95_ms", times.p95_ms}};
  };
  Json times = {{"frame", entry(report.frame_ms)}};
  for (std::size_t s = 0; s < kStages; ++s)
    times[std::string(name(static_cast<Stage>(s)))] =
        entry(report.clock.times_ms(static_cast<Stage>(s)));
  return times;
}

/// Returns the answers to the held-out frames; null if there were none.
const std::vector<QueryScore>* held_out_of(const RunResult& run) {
  if (run.points.empty() || run.points.front().held_out.empty()) return nullptr;
  return &run.points.front().held_out;
}

Json summary_json(const SlamReport& report) {
  const RunResult& run = report.run;
  Json json = {{"source", printable(report.source)},
               {"seed", run.spec.seed},
               {"frames", run.mapping.offered},
               {"tracked", report.log.tracked},
               {"completeness", report.completeness()},
               {"lost", report.lost()},
               {"skipped", run.mapping.skipped.count},
               {"relocalized", report.log.relocalized},
               {"map_resets", report.log.map_resets},
               {"keyframes", report.state.map.keyframe_count()},
               {"landmarks", report.state.map.landmark_count()},
               {"loops", report.log.loops},
               {"disparity_sigma_px", report.state.camera.disparity_sigma_px},
               {"trajectory_digest", hex(digest(run.estimate))},
               {"map_digest", hex(report.state.map.digest())}};
  if (report.evaluation) {
    const Evaluation& e = *report.evaluation;
    const bool known = e.ape_translation_m.count > 0;
    json["truth"] = {{"pairs", e.pairs},
                     {"ate_rmse_m", known ? Json(e.ape_translation_m.rmse) : Json()}};
  }
  if (const auto* held_out = held_out_of(run)) {
    const QuerySummary answers = summarize(*held_out);
    json["restarts"] = run.mapping.restarts;
    json["dropped"] = run.mapping.dropped.size();
    json["held_out"] = {{"queries", answers.queries}, {"success", answers.success}};
    if (answers.correct) {
      json["held_out"]["correct"] = *answers.correct;
      json["held_out"]["false_positive"] = *answers.false_positive;
    }
  }
  json["faults"] = run.mapping.skipped.reasons;
  json["times"] = times_json(report);
  json["peak_memory_mb"] = peak_memory_mb();
  return json;
}

}  // namespace

void write_slam_files(const std::filesystem::path& folder, const SlamReport& report,
                      const Settings& settings) {
  const std::array<std::string, kSlamFiles.size()> contents{format_tum(report.run.estimate),
                                                            format_kitti(report.run.estimate),
                                                            report.frames_csv,
                                                            landmarks_ply(report.state.map),
                                                            keyframes_ply(report.state.map),
                                                            keyframes_json(report.state.map),
                                                            format_settings(settings),
                                                            summary_json(report).dump(2) + "\n"};
  // First, all files are written to a temporary folder, so that a full disk leaves an earlier run's
  // files intact. Then the old summary is removed before the other files are replaced, and the new
  // summary is added last: a folder without a summary is incomplete.
  const TemporaryFolder fresh(folder);
  for (std::size_t i = 0; i < contents.size(); ++i)
    write_atomically(fresh.path() / kSlamFiles[i], contents[i]);
  fs::remove(folder / kSlamFiles.back());
  for (const char* name : kSlamFiles) fs::rename(fresh.path() / name, folder / name);
}

void print_slam_report(const SlamReport& report) {
  const RunResult& run = report.run;
  const FrameLog& log = report.log;
  const SkippedFrames& skipped = run.mapping.skipped;
  for (const std::string& reason : skipped.reasons) fmt::print("skipped: {}\n", reason);
  if (const std::size_t more = skipped.count - skipped.reasons.size(); more > 0)
    fmt::print("skipped: {} more\n", more);
  fmt::print("{} of {} tracked ({:.1f} %); {} lost, {} skipped, {} relocalized\n", log.tracked,
             counted(run.mapping.offered, "frame"), 100 * report.completeness(), report.lost(),
             skipped.count, log.relocalized);
  if (log.map_resets > 0)
    fmt::print("map reset {}: tracking was lost while the map was small\n",
               counted(log.map_resets, "time"));
  if (const auto* held_out = held_out_of(run)) {
    const QuerySummary answers = summarize(*held_out);
    fmt::print("{}, {}; held-out queries: {}, {:.1f} % answered",
               counted(run.mapping.restarts, "restart"),
               counted(run.mapping.dropped.size(), "frame") + " dropped",
               counted(held_out->size(), "frame"), 100 * answers.success);
    if (answers.correct)
      fmt::print(", {:.1f} % correct, {:.1f} % false", 100 * *answers.correct,
                 100 * *answers.false_positive);
    fmt::print("\n");
  }
  fmt::print("{}, {}, {} closed\n", counted(report.state.map.keyframe_count(), "keyframe"),
             counted(report.state.map.landmark_count(), "landmark"), counted(log.loops, "loop"));
  if (const Camera& camera = report.state.camera; !camera.disparity_sigma_is_given)
    fmt::print("depth trusted to {:.2f} px of disparity, as learned\n", camera.disparity_sigma_px);
  if (report.evaluation) {
    const Evaluation& e = *report.evaluation;
    if (e.ape_translation_m.count > 0)
      fmt::print("ATE {:.4f} m (RMSE over {}, aligned by SE(3) without scale)\n",
                 e.ape_translation_m.rmse, counted(e.pairs, "pose"));
    else
      fmt::print("ATE unknown: {} a true one at the same time, too few or too straight to align\n",
                 counted(e.pairs, "pose has", "poses have"));
  }
  fmt::print("\n{:<16}{:>8}{:>12}{:>12}\n", "time (ms)", "frames", "median", "95 % below");
  const auto row = [](std::string_view what, const std::vector<double>& ms) {
    if (ms.empty()) return;
    const TimeSummary times = summarize(ms);
    fmt::print("{:<16}{:>8}{:>12.2f}{:>12.2f}\n", what, ms.size(), times.median_ms, times.p95_ms);
  };
  row("frame", report.frame_ms);
  for (std::size_t s = 0; s < kStages; ++s)
    row(name(static_cast<Stage>(s)), report.clock.times_ms(static_cast<Stage>(s)));
  fmt::print("\npeak memory {:.0f} MB\n", peak_memory_mb());
}

}  // namespace mh::cli
