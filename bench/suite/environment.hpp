// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/suite/shipped.hpp"
#include "scenes/scene_frame.hpp"
#include "slam/io/fields.hpp"
#include "slam/io/yaml.hpp"

namespace mh {

/// A place to be mapped and queried, as data: a scene and the tours through it, or a recording.
struct Environment {
  std::string name;      ///< unique in its suite, valid as a folder name
  std::string category;  ///< "bathroom": means are taken per category
  // The sources of a scene; sources() describes each.
  std::filesystem::path scene, robot, mapping_tour;
  SceneFrame frame = {};  ///< of the scene files
  std::optional<std::filesystem::path> query_tour = {};
  std::optional<std::filesystem::path> query_scene = {};
  std::optional<std::filesystem::path> kidnapped_tour = {};
  std::optional<std::filesystem::path> sensors = {};
  std::optional<std::filesystem::path> pedestrian = {};
  std::optional<std::filesystem::path> query_pedestrian = {};
  /// A recording ("tum:FOLDER", scenes/recordings/open_sequence.hpp) in place of all of the above
  /// except name and category; empty if the environment is a scene.
  std::string sequence = {};
  std::optional<std::string> queries = {};  ///< the second tour: a recording in the same world
  std::optional<std::filesystem::path> settings = {};  ///< calibration of both recordings
  std::optional<std::filesystem::path> classes = {};   ///< class map for both recordings' labels
  std::string topics = {};  ///< of both recordings, if they are ROS messages: "color=/a,depth=/b"
  /// Whether the suite sets `track.readout_s` itself; if not, the calibration's value applies,
  /// since the readout time is a property of the camera.
  bool suite_states_readout = false;
  bool is_recorded() const { return !sequence.empty(); }
  /// The scene of the second tour.
  const std::filesystem::path& queried_scene() const { return query_scene ? *query_scene : scene; }
  friend bool operator==(const Environment&, const Environment&) = default;
};

/// The kind of an environment's source: determines how its file is found, read and checked.
enum class SourceKind { kScene, kMotion, kTour, kRobot, kLevel, kPedestrian };

/// The forms in which a suite may name a source, in Markdown.
constexpr std::string_view forms(SourceKind kind) {
  using enum SourceKind;
  switch (kind) {
    case kScene:
      return "a house, a mesh, a ScanNet folder, or `generated:CATEGORY:SEED`";
    case kMotion:
      return "a tour's file, or `auto:SEED`, `survey:SEED`, `handheld:SEED:FRAMES`";
    case kTour:
      return "a tour's file";
    case kRobot:
      return "a robot's file";
    case kLevel:
      return "a sensor level";
    case kPedestrian:
      return "a pedestrian's file";
  }
  return "";
}

/// A key of an environment with a scene; the key's value names a source.
struct WorldSource {
  const char* key;
  SourceKind kind;
  const char* meaning;
  bool of_queries = false;     ///< used for queries only: no map depends on it
  bool reveals_truth = false;  ///< a program under test must not see it
};

/// Lists the sources of an environment with a scene: visit(WorldSource, path or optional path). A
/// new source needs a member, a name in fields(), a line here, and a use in build_world()
/// (bench/protocol/world/world.cpp).
template <MaybeConst<Environment> E, class Visit>
void sources(E& e, Visit&& visit) {
  using enum SourceKind;
  visit(WorldSource{"scene", kScene, "where the robot maps", false, true}, e.scene);
  visit(WorldSource{"robot", kRobot, "default: the suite's"}, e.robot);
  visit(WorldSource{"mapping_tour", kMotion, "default: `auto:0`", false, true}, e.mapping_tour);
  visit(WorldSource{"kidnapped_tour", kTour,
                    "after the mapping tour, the robot is moved from one frame to the next to the "
                    "start of this tour, and continues mapping",
                    false, true},
        e.kidnapped_tour);
  visit(WorldSource{"query_tour", kMotion,
                    "the second tour; default: only held-out frames are "
                    "queries",
                    true, true},
        e.query_tour);
  visit(WorldSource{"query_scene", kScene,
                    "a different scene for the second tour: furniture moved, lights changed", true,
                    true},
        e.query_scene);
  visit(
      WorldSource{"sensors", kLevel, "sensor settings of this environment instead of the level's"},
      e.sensors);
  visit(WorldSource{"pedestrian", kPedestrian, "walks while the robot maps", false, true},
        e.pedestrian);
  visit(WorldSource{"query_pedestrian", kPedestrian, "walks during the second tour", true, true},
        e.query_pedestrian);
}

template <MaybeConst<Environment> E, class Visit>
void fields(E& e, Visit& v) {
  auto& [name, category, scene, robot, mapping_tour, frame, query_tour, query_scene, kidnapped_tour,
         sensors, pedestrian, query_pedestrian, sequence, queries, settings, classes, topics,
         suite_states_readout] = e;
  v("name", name);
  v("category", category);
  sources(e, [&](const WorldSource& source, auto& path) { v(source.key, path); });
  v("frame", frame);
  v("sequence", sequence);
  v("queries", queries);
  v("settings", settings);
  v("classes", classes);
  v("topics", topics);
  v("suite_states_readout", suite_states_readout);
}

/// A recording that a pattern of a suite found.
struct FoundRecording {
  std::string sequence;
  std::string scene_type;  ///< the data set's name for the kind of place; "" = unknown
  friend bool operator==(const FoundRecording&, const FoundRecording&) = default;
};
/// The recordings that patterns found, by the pattern as written in the suite. Results store this
/// map, so that they can be merged on machines without the recordings.
using FoundRecordings = std::map<std::string, std::vector<FoundRecording>>;

/// Whether a source names something generated by code ("generated:bathroom:0") instead of a file.
bool is_generated(const std::filesystem::path& source);

/// What a suite's paths are relative to, and whether the files must exist: results are merged and
/// exported on machines that may have none of their inputs.
struct SuitePaths {
  std::filesystem::path folder;
  bool must_exist = true;
  FoundRecordings found = {};  ///< found earlier: their patterns are not searched again
};

/// The environments of a suite.
struct Environments {
  std::vector<Environment> list;
  FoundRecordings found;
  std::vector<std::string> notes;  ///< a line about each recording left out
};

/// Reads the list `environments` of a suite. Each entry is a YAML map with the fields of
/// Environment that apply to a scene, or those that apply to a recording, and at most one of these:
/// - `count: N` creates N environments: {i} in name, scene and tours is replaced by N consecutive
///   numbers, the first of which is given by the key `first` (default 0); the name defaults to
///   CATEGORY-{i}.
/// - `sequences: PATTERN` instead of `sequence` creates an environment for each recording that
///   matches (* and ? in the last part of the path), sorted by name, named after its folder or
///   file. Its category is the given one, or the one that `categories` assigns to the recording's
///   scene type in the data set; recordings of other types are left out and counted in a note. With
///   `may_be_absent: true` a pattern without a match is left out with a note.
/// - `files: PATTERN` must be the only field: each file that matches (* and ? in the last part of
///   the path), sorted by name, contains one such entry, with paths relative to its own folder.
/// A name defaults to the category, `robot` to the given default.
/// @throws InputError naming file, line, field and value: an empty list, two environments with the
///         same name or of the same place, a missing file.
Environments read_environments(const YamlReader& list, const SuitePaths& paths,
                               const std::optional<std::filesystem::path>& default_robot);

/// Reads a source that a suite names: a file, or something generated. @param index  replaces {i}
/// @throws InputError at this place
std::filesystem::path read_source(SourceKind kind, const YamlReader& node, const SuitePaths& paths,
                                  int index = 0);

/// The file that a suite names; if it does not exist, the shipped file of that name.
/// @throws InputError at `node` if a required file is missing.
std::filesystem::path named_file(const YamlReader& node, const SuitePaths& paths,
                                 std::optional<Shipped> what = {});

}  // namespace mh
