// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/suite/environment.hpp"
#include "bench/suite/outside_program.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

enum class SystemKind { kSemantic, kPlain, kOutside };
constexpr Names<SystemKind, 3> words(SystemKind) {
  return {{{"semantic", SystemKind::kSemantic},
           {"plain", SystemKind::kPlain},
           {"outside", SystemKind::kOutside}}};
}
constexpr std::string_view name(SystemKind kind) {
  return name_of(kind, words(kind));
}

/// A system under test, as a suite names it.
struct SystemSpec {
  SystemKind kind = SystemKind::kSemantic;
  std::string name = "semantic";
  std::optional<OutsideProgram> outside = {};  ///< set for an outside system only
  /// Its own settings, by full name (slam/config/by_name.hpp), in place of the suite's. Only our
  /// systems under another name have any.
  std::vector<std::pair<std::string, YamlReader>> settings = {};

  /// Whether equal runs give equal bits. If false, the gate judges the system by the spread over
  /// its runs.
  bool repeatable = true;

  // The system's capabilities: other code checks these, not `kind`.
  bool is_outside() const { return kind == SystemKind::kOutside; }
  bool sees_labels() const { return kind != SystemKind::kPlain; }
  /// Whether it has the settings of SlamConfig. Such a system needs a vocabulary, and reports
  /// candidates, matches and how far a relocalization got; for an outside system, all of these
  /// reports are optional.
  bool takes_settings() const {
    return kind == SystemKind::kSemantic || kind == SystemKind::kPlain;
  }
  /// Whether it answers queries: all systems do, except programs that return a trajectory.
  bool is_asked() const { return !is_outside() || outside->mode != OutsideMode::kTrajectory; }
  /// Whether its finished map is kept for later runs: it then implements System::save() and
  /// restore().
  bool saves_map() const { return takes_settings(); }
  /// Whether labels affect its matching (equation 2).
  bool weighs_labels() const { return takes_settings() && sees_labels(); }
};

/// Lists the members that are part of a run's description. The system's own settings are left out,
/// since they are already among the run's, and so is `repeatable`, which matters only to the gate.
template <MaybeConst<SystemSpec> S, class Visit>
void fields(S& system, Visit& v) {
  auto& [kind, name, outside, settings, repeatable] = system;
  v("kind", kind);
  v("name", name);
  v("outside", outside);
}

/// Reads `semantic`, `plain`, or one of these under another name with its own settings, {name,
/// system: plain, slam: {...}}, or a mapping {name, command, protocol: trajectory | conversation}
/// with `run_limit_s`, `reply_limit_s`, `memory_limit_mb`, `disk_limit_mb` to override defaults,
/// `repeatable: false`, and `inputs`, a list of files. The command runs in the suite's folder. For
/// a shared library, the mapping is {name, library}, with `settings` (a file) and the other keys
/// above.
/// @returns that system; for a command with `vary: {n: [500, 1000]}`, one for each combination of
/// values, which replace {n} in the command and appear in the names: "orb_n_500", "orb_n_1000"
/// @throws InputError naming file, line, field and value; also for an input that must exist but
/// does not.
std::vector<SystemSpec> read_systems(YamlReader node, const SuitePaths& paths);

}  // namespace mh
