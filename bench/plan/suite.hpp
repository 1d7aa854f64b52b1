// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
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
#include "slam/config/shared.hpp"

namespace mh {

std::string_view name(LabelMode labels);
/// "exact labels", "labels from boxes", "no labels"
std::string with_labels(LabelMode labels);

/// A table of the paper that a suite reproduces.
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
  std::filesystem::path vocabulary;  ///< empty if no system needs it
  /// Sensor settings, named by their files; kRecordedLevel comes last if there are recordings.
  std::vector<std::filesystem::path> levels;
  std::vector<SystemSpec> systems;
  std::vector<LabelMode> labels;
  int trials = 1;
  std::uint64_t seed = 0;  ///< trial t uses seed + t
  SharedSlamConfig slam;
  Sweep sweep;
  ProtocolConfig protocol;
  /// Which systems are compared: first minus second. Default: `semantic` with `plain`, if the suite
  /// has both.
  std::vector<SystemPair> compare;
  /// The first of a pair is not inferior if the interval of its success minus the second's stays
  /// above -margin. Stated in the suite, before any measurement.
  std::optional<double> non_inferiority_margin;
  std::optional<Published> published;      ///< whose figures are shown next to the measured ones
  GateConfig gate;                         ///< what `modelhouse check` tolerates
  std::optional<std::size_t> max_frames;   ///< truncates the tours: for a quick look
  bool scene_replaced = false;             ///< by SuiteOverrides::scene
  std::map<std::string, std::string> set;  ///< as SuiteOverrides
  FoundRecordings found;                   ///< what its recording patterns found
  std::vector<std::string> left_out;       ///< recordings that patterns found, one line each
};

/// What the command line may override in a suite.
struct SuiteOverrides {
  std::optional<std::filesystem::path> scene = {};
  SceneFrame frame = {};  ///< of that scene, otherwise of the suite's only scene
  std::optional<int> trials = {};
  std::optional<std::size_t> max_frames = {};
  /// Values that replace `${name}` in the suite's text.
  std::map<std::string, std::string> set = {};
  /// For a suite that is read from its results: patterns are not searched for again.
  FoundRecordings found = {};
};

/// Reads a suite (YAML); its paths are relative to its own folder and must exist.
/// @throws InputError naming file, line, field and value.
Suite load_suite(const std::filesystem::path& file, const SuiteOverrides& overrides = {});

/// Parses the text of a suite whose file need not exist any more, nor, on request, the files that
/// it names.
Suite parse_suite(const std::string& content, const std::filesystem::path& file,
                  const SuiteOverrides& overrides = {}, bool files_must_exist = true);

/// The level of recordings, which contain their own noise; no file has this name.
inline constexpr const char* kRecordedLevel = "recorded";

/// Whether runs of an environment may have these labels: recorded ones for a recording, drawn ones
/// for a scene. Any may have none.
bool fits(const Environment& environment, LabelMode labels);
/// Whether runs of an environment are made at this level: a recording's only at kRecordedLevel.
bool fits(const Environment& environment, const std::filesystem::path& level);

std::string level_name(const std::filesystem::path& level);

}  // namespace mh
