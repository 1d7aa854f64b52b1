// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/protocol/metrics/evaluate.hpp"
#include "bench/protocol/run_result.hpp"
#include "bench/run/frame_log.hpp"
#include "bench/systems/stage_clock.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/pipeline/slam.hpp"

namespace mh::cli {

/// The final report of a run on one sequence.
struct SlamReport {
  const SlamState& state;
  const RunResult& run;
  const FrameLog& log;
  const StageClock& clock;
  std::vector<double> frame_ms;          ///< of each processed frame, excluding the time to read it
  std::optional<Evaluation> evaluation;  ///< absent if the truth is unknown
  std::string frames_csv, source;

  int lost() const {
    return static_cast<int>(run.mapping.offered - run.mapping.skipped.count) - log.tracked;
  }
  double completeness() const { return log.tracked / static_cast<double>(run.mapping.offered); }
};

/// The files that write_slam_files() writes. The last one exists only if all others do.
inline constexpr std::array<const char*, 8> kSlamFiles{
    "estimate.tum",  "estimate.kitti", "frames.csv",    "landmarks.ply",
    "keyframes.ply", "keyframes.json", "settings.yaml", "summary.json"};

/// @throws DiskFullError, in which case the files of an earlier run are still in the folder
void write_slam_files(const std::filesystem::path& folder, const SlamReport& report,
                      const Settings& settings);
void print_slam_report(const SlamReport& report);

}  // namespace mh::cli
