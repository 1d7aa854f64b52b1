// SPDX-License-Identifier: Apache-2.0
#include "bench/results/write.hpp"

#include <fmt/format.h>

#include "bench/metrics/trajectory_io.hpp"
#include "bench/pictures/canvas.hpp"
#include "bench/pictures/contact_sheet.hpp"
#include "bench/pictures/sweep.hpp"
#include "bench/pictures/topdown.hpp"
#include "bench/results/json.hpp"
#include "bench/results/table.hpp"
#include "slam/core/files.hpp"

namespace mh {
namespace fs = std::filesystem;

void write_run(const fs::path& folder, const World& world, const RunResult& run) {
  make_output_folder(folder);
  write_tum(folder / "truth.tum", world.mapping.camera);
  write_tum(folder / "estimate.tum", run.estimate);
  run.volume->save_bt(folder / "map.bt");
  save_map_server(run.grid, folder / "map");
  write_picture(folder / "topdown.png", draw_topdown(world, run, QuerySet::kHeldOut));
  if (world.second)
    write_picture(folder / "topdown_second_tour.png",
                  draw_topdown(world, run, QuerySet::kSecondTour));
}

void write_views(const fs::path& file, const World& world) {
  write_picture(file,
                draw_contact_sheet(
                    fmt::format("{}, along the mapping tour", world.scene->name),
                    views_along(world.mapping.camera, *world.renderer, world.robot.camera, 6)));
}

std::string write_results(const fs::path& folder, const Suite& suite,
                          std::span<const RunResult> runs, std::span<const FailedRun> failed,
                          std::span<const std::string> missing) {
  const std::string table = results_table(suite, runs, failed, missing);
  write_atomically(folder / "times.json", times_json(runs).dump(2) + "\n");
  write_atomically(folder / "reproduction.json", reproduction_json(suite, runs).dump(2) + "\n");
  write_atomically(folder / "times.txt", times_table(suite, runs));
  if (parameter_points(suite).size() > 1) {
    const std::vector<Row> rows = make_rows(suite, runs);
    for (const SweepResult& result : sweep_results(suite, rows))
      write_picture(folder / sweep_picture_name(suite, result), draw_sweep(suite, rows, result));
  }
  write_atomically(folder / "table.txt", table);
  write_atomically(folder / "results.json",
                   results_json(suite, runs, failed, missing).dump(2) + "\n");
  return table;
}

}  // namespace mh
