// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/environment.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "bench/plan/names.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/recorded/open_sequence.hpp"
#include "scenes/scannet/files.hpp"
#include "sim/world/travel.hpp"
#include "slam/core/counted.hpp"
#include "slam/core/file_errors.hpp"
#include "slam/core/files.hpp"
#include "slam/core/suggest.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

std::string with_index(std::string text, int index) {
  const std::string mark = "{i}", number = std::to_string(index);
  for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + number.size()))
    text.replace(at, mark.size(), number);
  return text;
}

constexpr const char* kMotions[] = {"auto", "handheld"};

/// What may have been meant by a word that names no file; nothing behind a path.
std::string what_is_known(const std::string& text, Shipped what) {
  const std::string word = what == Shipped::kTour ? text.substr(0, text.find(':')) : text;
  if (!is_bare_name(word)) return "";
  std::vector<std::string> known = shipped_names(what);
  if (what == Shipped::kTour) known.insert(known.begin(), std::begin(kMotions), std::end(kMotions));
  return hint(word, known);
}

fs::path resolve(const std::string& text, const YamlReader& node, const SuitePaths& paths,
                 std::optional<Shipped> what) {
  const fs::path file = (paths.folder / text).lexically_normal();
  std::error_code error;
  if (what && !fs::exists(file, error))
    if (const fs::path shipped = shipped_file(text, *what); !shipped.empty()) return shipped;
  if (const char* reason = paths.must_exist ? why_unreadable(file) : nullptr)
    node.fail(fmt::format("'{}' cannot be read: {}{}", file.string(), reason,
                          what ? what_is_known(text, *what) : ""));
  return file;
}

/// A file, or something that code makes. `index` replaces {i}.
fs::path read_source(const YamlReader& node, const SuitePaths& paths, int index, Shipped what) {
  const std::string text = with_index(node.as_string(), index);
  if (is_generated(text)) return text;
  return resolve(text, node, paths, what);
}

/// A scene: a source, or a ScanNet scene's folder.
fs::path read_scene(const YamlReader& node, const SuitePaths& paths, int index) {
  fs::path folder = (paths.folder / with_index(node.as_string(), index)).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // "scene0000_00/"
  return is_scannet_scene(folder) ? folder : read_source(node, paths, index, Shipped::kScene);
}

/// A tour: a source, or a motion by its name alone (sim/world/travel.hpp).
fs::path read_tour(const YamlReader& node, const SuitePaths& paths, int index) {
  const std::string text = with_index(node.as_string(), index);
  for (const char* motion : kMotions) {
    if (text != motion && !text.starts_with(motion + std::string(":"))) continue;
    try {
      check_motion(text);
    } catch (const InputError& error) {
      node.fail(error.what());
    }
    return std::string(kGeneratedPrefix) + text;
  }
  return read_source(node, paths, index, Shipped::kTour);
}

/// What an entry calls what it makes, and how many of it; `name` with {i} where there are several.
struct EntryNames {
  std::string category, name;
  int count = 1;
};

EntryNames read_names(YamlReader& node) {
  EntryNames names;
  names.count = static_cast<int>(node.integer_or("count", 1, 1, 100000));
  names.category = node.string("category");
  check_folder_name(node.at("category"), names.category);
  names.name = node.string("name", node.has("count") ? names.category + "-{i}" : names.category);
  if (names.count > 1 && names.name.find("{i}") == std::string::npos)
    node.at("name").fail(
        fmt::format("'{}' needs an {{i}}: there are {} of it", names.name, names.count));
  return names;
}

/// A recording by its name, its path seen from the suite.
std::string read_sequence(const YamlReader& node, const SuitePaths& paths, int index) {
  const auto [layout, path] = split_sequence(with_index(node.as_string(), index));
  const std::string source = join_sequence(layout, (paths.folder / path).lexically_normal());
  if (!paths.must_exist) return source;
  try {
    reader_of(source);
  } catch (const InputError& error) {
    node.fail(error.what());
  }
  const fs::path found = split_sequence(source).second;
  if (!is_there(found)) node.fail(fmt::format("'{}' is not there", found.string()));
  return source;
}

/// What a recording has beside its frames, once for all that an entry makes.
struct BesideFrames {
  std::optional<YamlReader> queries;
  std::optional<fs::path> settings, classes;

  BesideFrames(YamlReader& node, const SuitePaths& paths) : queries(node.find("queries")) {
    if (const auto file = node.find("settings"))
      settings = named_file(*file, paths, Shipped::kSettings);
    if (const auto file = node.find("classes")) classes = named_file(*file, paths);
    for (const char* key : {"scene", "robot", "mapping_tour", "query_tour", "query_scene",
                            "kidnapped_tour", "sensors", "pedestrian", "up", "floor_z_m"})
      if (const auto other = node.find(key))
        other->fail("is of a simulated scene: a recording brings its own");
  }
};

Environment recorded_environment(std::string name, std::string category, std::string sequence,
                                 const BesideFrames& beside, const SuitePaths& paths, int index) {
  Environment e;
  e.name = std::move(name);
  e.category = std::move(category);
  e.sequence = std::move(sequence);
  if (beside.queries) e.queries = read_sequence(*beside.queries, paths, index);
  e.settings = beside.settings;
  e.classes = beside.classes;
  return e;
}

std::vector<Environment> read_recorded_entry(YamlReader node, const SuitePaths& paths) {
  const auto [category, name, count] = read_names(node);
  const YamlReader sequence = node.at("sequence");
  const BesideFrames beside(node, paths);
  node.finish();
  std::vector<Environment> environments;
  for (int i = 0; i < count; ++i) {
    environments.push_back(recorded_environment(
        with_index(name, i), category, read_sequence(sequence, paths, i), beside, paths, i));
    check_folder_name(node, environments.back().name);
  }
  return environments;
}

/// The recordings that match a pattern, in the order of names.
std::vector<FoundRecording> find_recordings(const YamlReader& pattern, const SuitePaths& paths) {
  const auto [layout, path] = split_sequence(pattern.as_string());
  const fs::path full = (paths.folder / path).lexically_normal();
  std::vector<FoundRecording> found;
  for (const std::string& name :
       list_folder(full.parent_path().empty() ? "." : full.parent_path(), full.filename())) {
    const fs::path place = full.parent_path() / name;
    const std::string source = join_sequence(layout, place);
    const auto readers = sequence_readers();
    const auto reader = std::ranges::find_if(readers, [&](const SequenceReader* r) {
      return (layout.empty() || layout == r->name) && r->recognizes(place);
    });
    if (reader == readers.end()) continue;  // a list, a table beside the recordings
    found.push_back({source, (*reader)->scene_type ? (*reader)->scene_type(place) : ""});
  }
  if (found.empty()) pattern.fail(fmt::format("no recording matches '{}'", full.string()));
  return found;
}

/// "Bathroom: bathroom" and so on; empty where the entry has none.
std::map<std::string, std::string> read_categories(YamlReader& node) {
  std::map<std::string, std::string> categories;
  if (auto map = node.find("categories"))
    for (const auto& [type, category] : map->entries()) {
      check_folder_name(category, category.as_string());
      categories[type] = category.as_string();
    }
  return categories;
}

/// What was left out, with how many of each: "3 'Apartment', 2 without a type".
std::string counted_types(const std::map<std::string, std::size_t>& types) {
  std::string text;
  for (const auto& [type, count] : types)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count,
                        type.empty() ? std::string("without a scene type") : "'" + type + "'");
  return text;
}

void read_pattern_entry(YamlReader node, const SuitePaths& paths, Environments& all,
                        std::vector<Environment>& made) {
  const YamlReader pattern = node.at("sequences");
  const std::map<std::string, std::string> categories = read_categories(node);
  if (categories.empty()) node.string("category");  // tells that it is missing
  std::optional<std::string> fixed;
  if (const auto category = node.find("category")) {
    if (!categories.empty()) category->fail("stands beside `categories`: one of them is enough");
    check_folder_name(*category, category->as_string());
    fixed = category->as_string();
  }
  const BesideFrames beside(node, paths);
  if (beside.queries) beside.queries->fail("is of one recording, not of a pattern");
  node.finish();

  const std::string text = pattern.as_string();
  const auto known = paths.found.find(text);
  const std::vector<FoundRecording> found =
      known != paths.found.end() ? known->second : find_recordings(pattern, paths);
  std::map<std::string, std::size_t> left_out;
  std::size_t taken = 0;
  for (const FoundRecording& recording : found) {
    const auto category = categories.find(recording.scene_type);
    if (!fixed && category == categories.end()) {
      ++left_out[recording.scene_type];
      continue;
    }
    const fs::path place = split_sequence(recording.sequence).second;
    made.push_back(recorded_environment(place.stem().string(), fixed ? *fixed : category->second,
                                        recording.sequence, beside, paths, 0));
    ++taken;
  }
  if (taken == 0)
    pattern.fail(fmt::format("none of {} has a scene type that `categories` names: {}",
                             counted(found.size(), "recording"), counted_types(left_out)));
  if (taken < found.size())
    all.notes.push_back(fmt::format("{}: {} of {} left out: {}", text, found.size() - taken,
                                    counted(found.size(), "recording"), counted_types(left_out)));
  all.found[text] = found;
}

std::vector<Environment> read_entry(YamlReader node, const SuitePaths& paths,
                                    const std::optional<fs::path>& default_robot) {
  if (node.has("sequence")) return read_recorded_entry(node, paths);
  const auto [category, name, count] = read_names(node);
  const YamlReader scene = node.at("scene");
  const auto tour = node.find("mapping_tour");
  const auto query_tour = node.find("query_tour");
  const auto query_scene = node.find("query_scene");
  if (query_scene && !query_tour) query_scene->fail("needs a query_tour");
  const auto kidnapped_tour = node.find("kidnapped_tour");
  const auto sensors = node.find("sensors"), pedestrian = node.find("pedestrian");
  const SceneFrame frame = read_scene_frame(node);
  const auto robot = node.find("robot");
  if (!robot && !default_robot) node.at("robot");  // tells that it is missing
  node.finish();

  std::vector<Environment> environments;
  for (int i = 0; i < count; ++i) {
    Environment e{.name = with_index(name, i),
                  .category = category,
                  .scene = read_scene(scene, paths, i),
                  .robot = robot ? named_file(*robot, paths, Shipped::kRobot) : *default_robot,
                  .mapping_tour = tour ? read_tour(*tour, paths, i) : fs::path("generated:auto:0"),
                  .frame = frame,
                  .query_tour = {}};
    check_folder_name(node, e.name);
    if (query_tour) e.query_tour = read_tour(*query_tour, paths, i);
    if (query_scene) e.query_scene = read_scene(*query_scene, paths, i);
    if (kidnapped_tour) e.kidnapped_tour = named_file(*kidnapped_tour, paths, Shipped::kTour);
    if (sensors) e.sensors = named_file(*sensors, paths, Shipped::kLevel);
    if (pedestrian) e.pedestrian = named_file(*pedestrian, paths);
    environments.push_back(std::move(e));
  }
  return environments;
}

std::vector<fs::path> matching_files(const YamlReader& pattern, const fs::path& folder) {
  const fs::path path = (folder / pattern.as_string()).lexically_normal();
  const fs::path parent = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  std::vector<fs::path> files;
  if (fs::is_directory(parent))
    for (const auto& entry : fs::directory_iterator(parent))
      if (entry.is_regular_file() &&
          fnmatch(path.filename().c_str(), entry.path().filename().c_str(), FNM_PERIOD) == 0)
        files.push_back(path.parent_path() / entry.path().filename());
  if (files.empty()) pattern.fail(fmt::format("no file matches '{}'", path.string()));
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

bool is_generated(const fs::path& source) {
  return source.string().starts_with(kGeneratedPrefix);
}

fs::path named_file(const YamlReader& node, const SuitePaths& paths, std::optional<Shipped> what) {
  return resolve(node.as_string(), node, paths, what);
}

Environments read_environments(const YamlReader& list, const SuitePaths& paths,
                               const std::optional<fs::path>& default_robot) {
  Environments all;
  std::set<std::string> names;
  const auto add = [&](std::vector<Environment> some, const YamlReader& node) {
    for (Environment& e : some) {
      if (!names.insert(e.name).second)
        node.fail(fmt::format("two environments are named '{}'", e.name));
      all.list.push_back(std::move(e));
    }
  };
  for (YamlReader entry : items_of(list)) {
    if (entry.has("sequences")) {
      std::vector<Environment> made;
      read_pattern_entry(entry, paths, all, made);
      add(std::move(made), entry);
      continue;
    }
    const auto pattern = entry.find("files");
    if (!pattern) {
      add(read_entry(entry, paths, default_robot), entry);
      continue;
    }
    entry.finish();
    for (const fs::path& file : matching_files(*pattern, paths.folder)) {
      const YamlReader node = YamlReader::load(file);
      add(read_entry(node, {file.parent_path(), paths.must_exist, paths.found}, default_robot),
          node);
    }
  }
  return all;
}

}  // namespace mh
