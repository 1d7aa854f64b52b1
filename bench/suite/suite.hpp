// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/suite/environment.hpp"
#include "bench/suite/episodes_spec.hpp"
#include "bench/suite/gate_config.hpp"
#include "bench/suite/graded_spec.hpp"
#include "bench/suite/labels.hpp"
#include "bench/suite/level.hpp"
#include "bench/suite/parameters.hpp"
#include "bench/suite/protocol_config.hpp"
#include "bench/suite/stress_spec.hpp"
#include "bench/suite/system_spec.hpp"
#include "sim/sensors/sense.hpp"
#include "slam/config/shared.hpp"
#include "slam/io/setting.hpp"
#include "slam/io/words.hpp"

namespace mh {

/// A table of the paper that a suite reproduces.
enum class Published { kTable2 };
constexpr Names<Published, 1> words(Published) {
  return {{{"table2", Published::kTable2}}};
}

/// A robot's sensors, in addition to the camera, whose readings are given to the systems under
/// test.
enum class Sense { kOdometry, kImu, kLaser };
constexpr Names<Sense, 3> words(Sense) {
  return {{{"odometry", Sense::kOdometry}, {"imu", Sense::kImu}, {"laser", Sense::kLaser}}};
}

/// The share of a system's answers by which it is judged.
enum class Measure { kCorrect, kSuccess };
constexpr Names<Measure, 2> words(Measure) {
  return {{{"correct", Measure::kCorrect}, {"success", Measure::kSuccess}}};
}

/// Two systems of a suite, by index.
struct SystemPair {
  std::size_t first = 0, second = 0;
  friend bool operator==(const SystemPair&, const SystemPair&) = default;
};

/// "correct", "success"
constexpr std::string_view name(Measure measure) {
  return name_of(measure, words(measure));
}

/// A benchmark as data: the grid environments x systems x labels x levels x parameters x trials.
struct Suite {
  std::string name;
  std::filesystem::path file;
  std::string text;  ///< of the file, as it was read
  std::vector<Environment> environments;
  std::filesystem::path vocabulary;  ///< empty if no system needs it
  /// Each with every combination of the doses of `parameters`. If only some environments are
  /// recordings, kRecordedLevel is last.
  std::vector<Level> levels;
  std::vector<SystemSpec> systems;
  std::vector<Labels> labels;
  int trials = 1;
  std::uint64_t seed = 0;
  SharedSlamConfig slam;
  Sweep sweep;
  ProtocolConfig protocol;
  std::vector<Sense> senses;             ///< given while mapping, in addition to the camera
  std::optional<GradedSpec> graded;      ///< queries asked in every environment
  std::optional<EpisodesSpec> episodes;  ///< run in every environment: a robot drives by its map
  std::optional<StressSpec> stress;      ///< dials for `modelhouse stress`; `bench` ignores them
  /// Pairs of systems to compare; differences are first minus second. Default: `semantic` and
  /// `plain`, if the suite has both.
  std::vector<SystemPair> compare;
  Measure measure = Measure::kCorrect;
  std::optional<double> non_inferiority_margin;
  std::optional<Published> published;
  /// ATE (RMSE, m) that others published, by system, then environment. Shown next to the measured
  /// ATE.
  std::map<std::string, std::map<std::string, double>> published_ate_m;
  GateConfig gate;                         ///< what `modelhouse check` tolerates
  std::optional<std::size_t> max_frames;   ///< truncates the tours: for a quick look
  bool scene_replaced = false;             ///< SuiteOverrides::scene was set
  std::map<std::string, std::string> set;  ///< as in SuiteOverrides
  FoundRecordings found;                   ///< recordings that the suite's patterns matched
  std::vector<std::string> notes;          ///< a line about each thing left out
};

/// Lists the settings of a suite that are single values.
template <MaybeConst<Suite> S, class Visit>
void fields(S& suite, Visit& v) {
  v("trials", suite.trials, {1, 1000}, "repeats; trial t uses seed + t");
  v("seed", suite.seed, setting::kSeed, "seed of the first trial");
  v("measure", suite.measure, {},
    "the share of a system's answers that decides which system is better; the other is shown, too");
  v("non_inferiority_margin", suite.non_inferiority_margin, setting::kShare,
    "fixed in advance: a system is not worse if the interval of its share minus the other's lies "
    "above the negative of this");
  v("published", suite.published, {}, "figures of the paper to show below the measured ones");
}

/// What the command line may override in a suite.
struct SuiteOverrides {
  std::optional<std::filesystem::path> scene = {};
  SceneFrame frame = {};  ///< of that scene or, if none is given, of the suite's only scene
  std::optional<int> trials = {};
  std::optional<std::size_t> max_frames = {};
  /// Values that replace `${name}` in the suite's text.
  std::map<std::string, std::string> set = {};
  /// A sweep in place of the section `parameters`: settings and their values, "500,1000".
  std::map<std::string, std::string> vary = {};
  /// For a suite read back from a results file: what its patterns found, so as not to search again.
  FoundRecordings found = {};
};

/// Reads a suite (YAML); its paths are relative to its own folder and must exist.
/// @throws InputError naming file, line, field and value.
Suite load_suite(const std::filesystem::path& file, const SuiteOverrides& overrides = {});

/// Parses the text of a suite. The file itself need not exist anymore; if `files_must_exist` is
/// false, the files that it names need not exist either.
Suite parse_suite(const std::string& content, const std::filesystem::path& file,
                  const SuiteOverrides& overrides = {}, bool files_must_exist = true);

/// Whether runs of an environment may use these labels: a recording has recorded labels, a scene
/// has simulated ones; both may run without labels or with those of a real detector.
bool fits(const Environment& environment, const Labels& labels);
/// Whether an environment is run at this level.
bool fits(const Environment& environment, const Level& level);

}  // namespace mh
