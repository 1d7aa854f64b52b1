// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/plan/environment.hpp"
#include "bench/plan/gate_config.hpp"
#include "bench/plan/parameters.hpp"
#include "bench/plan/system_spec.hpp"
#include "bench/protocol/config.hpp"
#include "sim/sensors/sensors.hpp"
#include "slam/config/slam.hpp"

namespace mh {

std::string_view name(LabelMode labels);
/// "exact labels", "labels from boxes", "no labels"
std::string with_labels(LabelMode labels);

/// A table of the paper that a suite is made after.
enum class Published { kTable2 };

/// Two systems of a suite, by index.
struct SystemPair {
  std::size_t first = 0, second = 0;
  friend bool operator==(const SystemPair&, const SystemPair&) = default;
};

/// A benchmark as data: the grid environments x systems x labels x levels x parameters x trials.
struct Suite {
  std::string name;
  std::filesystem::path file;
  std::vector<Environment> environments;
  std::filesystem::path vocabulary;           ///< empty where none of the systems needs it
  std::vector<std::filesystem::path> levels;  ///< sensor settings; a level is named by its file
  std::vector<SystemSpec> systems;
  std::vector<LabelMode> labels;
  int trials = 1;
  std::uint64_t seed = 0;  ///< trial t uses seed + t
  SlamConfig slam;
  Sweep sweep;
  ProtocolConfig protocol;
  /// Which systems are set against which: first minus second. A suite that says nothing compares
  /// `semantic` with `plain`, where it has both.
  std::vector<SystemPair> compare;
  /// The first of a pair counts as not inferior where the interval of its success minus the
  /// second's stays above -margin. Stated in the suite, before anything is measured.
  std::optional<double> non_inferiority_margin;
  std::optional<Published> published;     ///< whose figures stand beside those measured
  GateConfig gate;                        ///< what `modelhouse check` tolerates
  std::optional<std::size_t> max_frames;  ///< cuts the tours: for a quick look
  bool scene_replaced = false;            ///< by SuiteOverrides::scene
};

/// What the command line may put in the place of a suite's own settings.
struct SuiteOverrides {
  std::optional<std::filesystem::path> scene = {};
  SceneFrame frame = {};  ///< of that scene, else of the suite's only one
  std::optional<int> trials = {};
  std::optional<std::size_t> max_frames = {};
};

/// Reads a suite (YAML); its paths are relative to its own folder and must exist.
/// @throws InputError naming file, line, field and value.
Suite load_suite(const std::filesystem::path& file, const SuiteOverrides& overrides = {});

/// The same from the text of a suite whose file need not be there any more, nor, if so asked, the
/// files that it names.
Suite parse_suite(const std::string& content, const std::filesystem::path& file,
                  const SuiteOverrides& overrides = {}, bool files_must_exist = true);

std::string level_name(const std::filesystem::path& level);

}  // namespace mh
