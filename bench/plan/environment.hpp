// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/plan/shipped.hpp"
#include "scenes/scene_frame.hpp"
#include "slam/core/yaml.hpp"

namespace mh {

/// A place to be mapped and asked about, as data: a scene and how it is crossed, or a recording of
/// one. `scene` and the tours are files, or made by code: "generated:KIND:SEED" (see is_generated).
/// In a suite a tour may also be `auto[:SEED]` or `handheld[:SEED[:FRAMES]]`
/// (sim/world/travel.hpp); the mapping tour is `auto` where none is given.
struct Environment {
  std::string name;      ///< unique in its suite, fit for a folder
  std::string category;  ///< over which means are taken: "bathroom"
  std::filesystem::path scene, robot, mapping_tour;
  SceneFrame frame = {};                            ///< of the scenes' files
  std::optional<std::filesystem::path> query_tour;  ///< the second tour; none: held-out frames only
  // What a scenario changes.
  std::optional<std::filesystem::path> query_scene = {};  ///< of the second tour; none: the scene
  /// From one frame to the next the robot is put to the start of this tour, and maps on.
  std::optional<std::filesystem::path> kidnapped_tour = {};
  std::optional<std::filesystem::path> sensors = {};     ///< settings in the place of the level's
  std::optional<std::filesystem::path> pedestrian = {};  ///< while the robot maps
  /// A recording ("tum:FOLDER", scenes/recorded/open_sequence.hpp) in the place of all of the above
  /// but name and category; empty: a scene.
  std::string sequence = {};
  std::optional<std::string> queries = {};  ///< another in its frame of reference: the second tour
  std::optional<std::filesystem::path> settings = {};  ///< calibration of both
  std::optional<std::filesystem::path> classes = {};   ///< what the labels of both mean
  bool is_recorded() const { return !sequence.empty(); }
};

/// A recording that a pattern of a suite found.
struct FoundRecording {
  std::string sequence;
  std::string scene_type;  ///< as its data set calls the kind of place; "" = not told
  friend bool operator==(const FoundRecording&, const FoundRecording&) = default;
};
/// What patterns found, by the pattern as the suite has it. Results keep it, so that they can be
/// put together where the recordings are not.
using FoundRecordings = std::map<std::string, std::vector<FoundRecording>>;

/// Whether a source names something that code makes ("generated:bathroom:0") instead of a file.
bool is_generated(const std::filesystem::path& source);

/// What a suite's paths are relative to, and whether the files must be there: results are put
/// together and exported where nothing of what made them may be left.
struct SuitePaths {
  std::filesystem::path folder;
  bool must_exist = true;
  FoundRecordings found = {};  ///< of patterns that need not be looked for
};

/// The environments of a suite.
struct Environments {
  std::vector<Environment> list;
  FoundRecordings found;
  std::vector<std::string> notes;  ///< recordings that were left out, one line each
};

/// Reads the list `environments` of a suite. Each entry is a mapping with the fields of
/// Environment that a scene has, or those that a recording has, and one of these more:
/// - `count: N` makes N of it, with {i} = 0 .. N-1 put into name, scene and tours; the name
/// defaults
///   to CATEGORY-{i}.
/// - `sequences: PATTERN` in the place of `sequence` makes an environment of every recording that
///   matches (* and ? in the last part of the path), in the order of names, named by its folder or
///   file. Its category is the one given, or what the mapping `categories` makes of the scene type
///   that the data set tells; recordings of other types are left out, which a note counts.
/// - `files: PATTERN` stands alone: every file that matches (* and ? in the last part of the path),
///   in the order of names, holds one such mapping, its paths relative to its own folder.
/// Names default to the category; `robot` to the one given.
/// @throws InputError naming file, line, field and value: an empty list, two environments of one
/// name, a file that is missing.
Environments read_environments(const YamlReader& list, const SuitePaths& paths,
                               const std::optional<std::filesystem::path>& default_robot);

/// The file that a suite names; where there is none, what is shipped under that name.
/// @throws InputError at this place if it must exist and does not.
std::filesystem::path named_file(const YamlReader& node, const SuitePaths& paths,
                                 std::optional<Shipped> what = {});

}  // namespace mh
