// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/results/gate/figures.hpp"

namespace mh {

inline constexpr std::string_view kBaselineFormat = "modelhouse-baseline-1";

/// The committed figures that later runs are compared with.
struct Baseline {
  std::string suite;         ///< its name
  std::string suite_digest;  ///< digest of its runs' scenes, tours, systems, seeds, protocol
  /// Program and machine that produced the figures. If both are the same in a later run, its
  /// results must be equal to the bit.
  nlohmann::ordered_json origin;
  /// Settings that a change may alter along with the program (see gate_settings). Null in a
  /// baseline written by an older program.
  nlohmann::ordered_json settings = {};
  std::vector<RunFigures> runs = {};
};

/// "slam/xi: 1.5 -> 3.0" for each setting that differs; empty for a baseline without settings.
std::vector<std::string> changed_settings(const Baseline& before, const Baseline& now);

/// One line per run, so that a change in one run changes one line.
std::string to_text(const Baseline& baseline);
void save_baseline(const Baseline& baseline, const std::filesystem::path& file);

/// Whether a file's text is a baseline, of any version.
bool is_baseline(const std::string& text);

/// @throws InputError naming the file if it is missing, not a baseline, damaged, or of a newer
/// format.
Baseline load_baseline(const std::filesystem::path& file);

/// @throws InputError if the baseline was made from a suite with a different name, or with the same
/// name but different scenes, tours, systems, seeds or protocol.
void check_suite(const Baseline& baseline, const std::filesystem::path& file,
                 const std::string& suite, const std::string& suite_digest);

}  // namespace mh
