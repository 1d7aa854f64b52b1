// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/check/figures.hpp"

namespace mh {

inline constexpr std::string_view kBaselineFormat = "modelhouse-baseline-1";

/// Figures that were committed as what is expected.
struct Baseline {
  std::string suite;         ///< its name
  std::string suite_digest;  ///< of what its runs are: scenes, tours, systems, seeds, protocol
  /// Program and machine that made the figures: where all of it is equal, so must be the bits.
  nlohmann::ordered_json origin;
  /// What a change may change and a program is compared under (see gate_settings). Null in a
  /// baseline of an older program.
  nlohmann::ordered_json settings = {};
  std::vector<RunFigures> runs = {};
};

/// "slam/xi: 1.5 -> 3.0" for each setting that differs; a baseline without settings tells of none.
std::vector<std::string> changed_settings(const Baseline& before, const Baseline& now);

/// One line per run, so that a change of one run is a change of one line.
std::string to_text(const Baseline& baseline);
void save_baseline(const Baseline& baseline, const std::filesystem::path& file);

/// @throws InputError naming the file if it is missing, no baseline, of a newer format or damaged.
Baseline load_baseline(const std::filesystem::path& file);

/// @throws InputError if the baseline was made from another suite, or from other scenes, tours,
/// systems, seeds or protocol under its name.
void check_suite(const Baseline& baseline, const std::filesystem::path& file,
                 const std::string& suite, const std::string& suite_digest);

}  // namespace mh
