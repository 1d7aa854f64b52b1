// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slam/io/setting.hpp"
#include "slam/io/words.hpp"

namespace mh {

/// How the bench communicates with an outside system.
enum class OutsideMode {
  kTrajectory,    ///< receives a recorded folder, writes a trajectory
  kConversation,  ///< receives frames one at a time over standard input, replies on standard output
};
constexpr Names<OutsideMode, 2> words(OutsideMode) {
  return {{{"trajectory", OutsideMode::kTrajectory}, {"conversation", OutsideMode::kConversation}}};
}
constexpr std::string_view name(OutsideMode mode) {
  return name_of(mode, words(mode));
}

/// A SLAM system that a suite names by its command line or its shared library
/// (docs/outside_systems.md).
struct OutsideProgram {
  std::string name = {};     ///< in tables and messages
  std::string command = {};  ///< for /bin/sh, with placeholders ({dataset}); empty for a library
  OutsideMode mode = OutsideMode::kTrajectory;
  std::filesystem::path folder = ".";  ///< the suite's: where the command runs
  double run_limit_s = 3600, reply_limit_s = 60, memory_limit_mb = 0, disk_limit_mb = 4096;
  /// Files that it reads in addition to those that the command names, relative to `folder`.
  std::vector<std::string> inputs = {};
  /// A shared library in place of a command, relative to `folder`: modelhouse-library-host runs it.
  std::string library = {};
  std::string settings = {};  ///< settings file of the library, relative to `folder`; empty: none
  /// Files and folders that it must not see; not read from the suite.
  std::vector<std::filesystem::path> hidden = {};
  std::string place = {};  ///< "suite.yaml:12", for messages; empty if not from a file
  bool is_library() const { return !library.empty(); }
  friend bool operator==(const OutsideProgram&, const OutsideProgram&) = default;
};

/// "outside program 'orb' (./orb {settings})", "outside library 'mine' (libmine.so)": for messages.
std::string described(const OutsideProgram& program);

/// Lists the limits of a program: visit(key, value, range, meaning, mode), where `mode` is the only
/// mode that the limit applies to, or absent if it applies to both.
template <MaybeConst<OutsideProgram> P, class Visit>
void limits(P& p, Visit&& visit) {
  const auto both = std::optional<OutsideMode>();
  visit("run_limit_s", p.run_limit_s, SettingRange{0.01, 1e7}, "wall time of the whole program",
        std::optional(OutsideMode::kTrajectory));
  visit("reply_limit_s", p.reply_limit_s, SettingRange{0.01, 1e7}, "wall time of one reply",
        std::optional(OutsideMode::kConversation));
  visit("memory_limit_mb", p.memory_limit_mb, SettingRange{0, 1e9},
        "resident memory of the program and everything it started, checked twice a second; 0: no "
        "limit",
        both);
  visit("disk_limit_mb", p.disk_limit_mb, SettingRange{0, 1e9},
        "how much it may write: exact for each file; the growth of its folder is checked as often "
        "as memory; 0: no limit",
        both);
}

/// Lists the members that describe a program to another process: all but `hidden` and `place`,
/// which only the process that starts the program uses.
template <MaybeConst<OutsideProgram> P, class Visit>
void fields(P& program, Visit& v) {
  auto& [name, command, mode, folder, run_limit_s, reply_limit_s, memory_limit_mb, disk_limit_mb,
         inputs, library, settings, hidden, place] = program;
  v("name", name);
  v("command", command);
  v("mode", mode);
  v("folder", folder);
  limits(program, [&](const char* key, auto& value, auto&&...) { v(key, value); });
  v("inputs", inputs);
  v("library", library);
  v("settings", settings);
}

/// Refuses an empty command, limits out of range, an unknown placeholder and a
/// trajectory command without {trajectory}. Known placeholders: {dataset} {associations} {settings}
/// {labels} {trajectory} {seed} in trajectory mode, {settings} {seed} in conversation mode;
/// `${NAME}` is left to the shell.
/// @throws InputError naming the value.
void validate(const OutsideProgram& program);

/// Quotes any value as a single word for the shell.
std::string shell_quoted(std::string_view value);

/// The command with its placeholders replaced by values quoted for the shell.
/// @pre validate() passed and every placeholder of the command has a value.
std::string expand_command(
    std::string_view command,
    const std::vector<std::pair<std::string_view, std::string>>& placeholders);
/// Like expand_command(), but replaces only one placeholder and leaves the others unchanged.
std::string fill_in(std::string_view command, std::string_view placeholder, std::string_view value);

}  // namespace mh
