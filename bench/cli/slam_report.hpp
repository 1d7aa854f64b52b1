// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/metrics/evaluate.hpp"
#include "bench/run/run_slam.hpp"
#include "bench/systems/stage_clock.hpp"
#include "slam/pipeline/settings.hpp"

namespace mh::cli {

/// A SLAM run as it is told at its end.
struct SlamReport {
  const SlamState& state;
  const SlamRun& run;
  const StageClock& clock;
  std::vector<double> frame_ms;          ///< of each frame that was processed, reading apart
  std::optional<Evaluation> evaluation;  ///< where the truth is known
  std::string source;
  std::uint64_t seed = 0;
};

/// What write_slam_files() writes; the last one is there only if all are.
inline constexpr std::array<const char*, 8> kSlamFiles{
    "estimate.tum",  "estimate.kitti", "frames.csv",    "landmarks.ply",
    "keyframes.ply", "keyframes.json", "settings.yaml", "summary.json"};

/// @throws DiskFullError; what an earlier run wrote into the folder is still there then
void write_slam_files(const std::filesystem::path& folder, const SlamReport& report,
                      const Settings& settings);
void print_slam_report(const SlamReport& report);

}  // namespace mh::cli
