// SPDX-License-Identifier: Apache-2.0
#include "bench/report/write.hpp"

#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "bench/report/drawing/contact_sheet.hpp"
#include "bench/report/graded_report.hpp"
#include "bench/report/results_json.hpp"
#include "bench/report/results_table.hpp"
#include "bench/report/sweep_chart.hpp"
#include "bench/report/topdown.hpp"
#include "bench/suite/code_version.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/suite/run_key.hpp"
#include "scenes/recordings/images/png.hpp"
#include "scenes/recordings/images/write_image.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/occupancy/objects.hpp"

namespace mh {
namespace fs = std::filesystem;

namespace {

/// Keyword of the text in an image file that states what the image was made from.
constexpr const char* kMadeOf = "modelhouse";

void write_marked(const fs::path& file, const cv::Mat& image, const std::string& made_of) {
  write_atomically(file, with_text(encode_png(image), kMadeOf, made_of));
}

/// Name of the file that states what a run was made from. Only runs without images have it.
constexpr const char* kRunKey = "run.key";

std::string mark_of(const fs::path& image) {
  return fs::is_regular_file(image) ? text_in(read_file(image), kMadeOf) : std::string();
}

/// Everything that determines a contact sheet. All levels share one sheet, though they may drop
/// different frames.
std::string identity_of_views(const World& world, const RunSpec& spec) {
  std::string text = fmt::format("{} {} {} ", code_of_run(), json_of(spec.environment.frame).dump(),
                                 spec.max_frames ? std::to_string(*spec.max_frames) : "all");
  for (const InputDigest& input : world.inputs)
    for (const char* seen : {"scene", "robot", "mapping_tour", "kidnapped_tour"})
      if (input.name == seen) text += fmt::format("{} {} ", seen, hex(input.digest));
  return text_key(text);
}

constexpr std::string_view kChart = "chart";  ///< what charts are marked as

/// Draws a chart. Without gnuplot, prints a warning: the results then lack charts, but pages show
/// the same data.
void draw_chart(const fs::path& file, const PlotPage& page) {
  try {
    write_plots(file, page);
    write_atomically(file, with_text(read_file(file), kMadeOf, std::string(kChart)));
  } catch (const MachineError& error) {
    fmt::print(stderr, "bench: warning: {}\n", error.what());
  }
}

/// Removes the charts of an earlier suite in this folder.
void remove_other_charts(const fs::path& folder, const std::set<std::string>& kept) {
  std::error_code error;
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if ((name.starts_with("graded-") || name.starts_with("sweep-")) && name.ends_with(".png") &&
        !kept.contains(name) && mark_of(entry.path()) == kChart)
      old.push_back(entry.path());
  }
  for (const fs::path& file : old) fs::remove(file, error);
}

}  // namespace

void remove_run(const fs::path& folder) {
  std::error_code error;
  for (const char* file : {"topdown.png", "topdown_second_tour.png", "truth.tum", "estimate.tum",
                           "map.bt", "map.ot", "map.pgm", "map.yaml", "objects.json", kRunKey})
    fs::remove(folder / file, error);
}

bool shows_another_run(const fs::path& folder, const std::string& key) {
  if (!fs::exists(folder / "estimate.tum")) return false;
  if (fs::is_regular_file(folder / kRunKey)) return read_file(folder / kRunKey) != key;
  return mark_of(folder / "topdown.png") != key;
}

void write_run(const fs::path& folder, const World& world, const RunResult& run,
               const std::string& key) {
  make_output_folder(folder);
  if (!run.truth.empty()) write_tum(folder / "truth.tum", run.truth);
  write_tum(folder / "estimate.tum", run.estimate);
  run.volume->save_bt(folder / "map.bt");
  run.volume->save_ot(folder / "map.ot");
  write_atomically(folder / "objects.json",
                   objects_json(find_objects(*run.volume), run.volume->resolution_m()));
  if (!world.simulated) {
    write_atomically(folder / kRunKey, key);  // last: it marks the files as complete
    return;
  }
  save_map_server(run.grid, folder / "map");
  if (world.query_tour)
    write_image(folder / "topdown_second_tour.png",
                draw_topdown(world, run, QuerySet::kSecondTour));
  // Last: it marks the files as complete.
  write_marked(folder / "topdown.png", draw_topdown(world, run, QuerySet::kHeldOut), key);
}

void write_views(const fs::path& file, const World& world, const RunSpec& spec) {
  const std::string identity = identity_of_views(world, spec);
  if (mark_of(file) == identity) return;
  write_marked(
      file,
      draw_contact_sheet(fmt::format("{}, along the mapping tour", world.simulated->scene->name),
                         views_along(world.simulated->mapping.camera, *world.simulated->renderer,
                                     world.simulated->robot.camera, 6)),
      identity);
}

void write_results(const fs::path& folder, const Suite& suite, std::span<const RunResult> runs,
                   std::span<const FailedRun> failed, std::span<const std::string> missing) {
  write_atomically(folder / "times.json", times_json(runs).dump(2) + "\n");
  write_atomically(folder / "reproduction.json", reproduction_json(suite, runs).dump(2) + "\n");
  write_atomically(folder / "times.txt", times_table(suite, runs));
  const std::vector<Row> rows = make_rows(suite, runs);
  std::set<std::string> charts;
  const auto draw = [&](const std::string& name, const PlotPage& page) {
    charts.insert(name);
    draw_chart(folder / name, page);
  };
  for (const GradedChart& chart : graded_charts(suite, rows)) draw(chart.file, chart.page);
  if (parameter_points(suite).size() > 1)
    for (const SweepResult& result : sweep_results(suite, rows))
      draw(
          sweep_image_name(suite.systems[result.system], result.labels, suite.levels[result.level]),
          sweep_chart(suite, rows, result));
  remove_other_charts(folder, charts);
  write_atomically(folder / "table.txt", results_table(suite, runs, failed, missing));
  write_atomically(folder / "results.json",
                   results_json(suite, runs, failed, missing).dump(2) + "\n");
}

}  // namespace mh
