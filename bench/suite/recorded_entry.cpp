// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/recorded_entry.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "bench/suite/entry_names.hpp"
#include "bench/suite/names.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/ros/topic_names.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Reads a recording by its name, with its path relative to the suite.
/// @param topics  ROS topics of the recording; absent if none are named
std::string read_sequence(const YamlReader& node, const SuitePaths& paths, int index,
                          const std::optional<YamlReader>& topics) {
  const auto [layout, path] = split_sequence(with_index(node.as_string(), index));
  if (path.empty()) node.fail("names no recording");
  const fs::path found = (paths.folder / path).lexically_normal();
  const std::string source = join_sequence(layout, found);
  if (!paths.must_exist) return source;
  const SequenceReader& reader = [&]() -> const SequenceReader& {
    try {
      return reader_of(source);
    } catch (const InputError& error) {
      node.fail(error.what());
    }
  }();
  if (!is_there(found)) node.fail(fmt::format("'{}' does not exist", found.string()));
  if (reader.is_of_folders() && !is_folder(found))
    node.fail(fmt::format("'{}' is not a folder", found.string()));
  if (topics && !reader.has_topics)
    topics->fail(fmt::format("'{}': a recording of layout '{}' has no topics", topics->as_string(),
                             reader.name));
  return source;
}

void check_topics(const YamlReader& topics) {
  try {
    parse_topic_names(topics.as_string());
  } catch (const InputError& error) {
    topics.fail(error.what());
  }
}

/// What an entry names in addition to its recordings of frames, the same for all its environments.
struct BesideFrames {
  std::optional<YamlReader> queries, topics;
  std::optional<fs::path> settings, classes;

  BesideFrames(YamlReader& node, const SuitePaths& paths)
      : queries(node.find("queries")), topics(node.find("topics")) {
    if (const auto file = node.find("settings"))
      settings = named_file(*file, paths, Shipped::kSettings);
    if (const auto file = node.find("classes")) classes = named_file(*file, paths);
    if (topics) check_topics(*topics);
    const auto refuse = [&](const char* key) {
      if (const auto other = node.find(key))
        other->fail("is for simulated scenes: a recording has its own");
    };
    const Environment none;
    sources(none, [&](const WorldSource& source, const auto&) { refuse(source.key); });
    for (const char* key : {"up", "floor_z_m"}) refuse(key);
  }
};

Environment recorded_environment(std::string name, std::string category, std::string sequence,
                                 const BesideFrames& beside, const SuitePaths& paths, int index) {
  Environment e;
  e.name = std::move(name);
  e.category = std::move(category);
  e.sequence = std::move(sequence);
  if (beside.queries) e.queries = read_sequence(*beside.queries, paths, index, beside.topics);
  if (e.queries && place_of(*e.queries, paths) == place_of(e.sequence, paths))
    beside.queries->fail("is the recording that is mapped: its test frames are queried anyway");
  e.settings = beside.settings;
  e.classes = beside.classes;
  if (beside.topics) e.topics = beside.topics->as_string();
  return e;
}

/// Finds the recordings that match a pattern, sorted by name; notes folders without a recording. A
/// pattern that matches nothing is an error, or only noted if `may_be_absent`.
std::vector<FoundRecording> find_recordings(const YamlReader& pattern, const SuitePaths& paths,
                                            bool may_be_absent, std::vector<std::string>& notes) {
  const auto [layout, path] = split_sequence(pattern.as_string());
  const fs::path full = (paths.folder / path).lexically_normal();
  std::vector<FoundRecording> found;
  std::vector<std::string> others;
  for (const std::string& name :
       list_folder(full.parent_path().empty() ? "." : full.parent_path(), full.filename())) {
    const fs::path place = full.parent_path() / name;
    try {
      require_open(place);
    } catch (const InputError& error) {
      pattern.fail(error.what());
    }
    if (!is_there(place)) pattern.fail(fmt::format("'{}' is a broken link", place.string()));
    const auto readers = sequence_readers();
    const auto reader = std::ranges::find_if(readers, [&](const SequenceReader* r) {
      return (layout.empty() || layout == r->name) && r->recognizes(place);
    });
    if (reader != readers.end())
      found.push_back({join_sequence(layout, place),
                       (*reader)->scene_type ? (*reader)->scene_type(place) : ""});
    else if (is_folder(place))  // files are lists or tables next to the recordings
      others.push_back(name);
  }
  if (found.empty() && !may_be_absent)
    pattern.fail(fmt::format("no recording matches '{}'", full.string()));
  if (found.empty()) notes.push_back(fmt::format("{}: left out: it does not exist", full.string()));
  if (!others.empty())
    notes.push_back(fmt::format("{}: left out: {} without a recording, the first: {}",
                                pattern.as_string(), counted(others.size(), "folder"), others[0]));
  return found;
}

/// Reads `categories`, "Bathroom: bathroom" and so on; empty if the entry has none.
std::map<std::string, std::string> read_categories(YamlReader& node) {
  std::map<std::string, std::string> categories;
  if (auto map = node.find("categories"))
    for (const auto& [type, category] : map->entries()) {
      check_folder_name(category, category.as_string());
      categories[type] = category.as_string();
    }
  return categories;
}

/// Summarizes what was left out, with counts: "3 'Apartment', 2 without a type".
std::string counted_types(const std::map<std::string, std::size_t>& types) {
  std::string text;
  for (const auto& [type, count] : types)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count,
                        type.empty() ? std::string("without a scene type") : "'" + type + "'");
  return text;
}

}  // namespace

std::string place_of(const std::string& sequence, const SuitePaths& paths) {
  const fs::path path = without_trailing_slash(split_sequence(sequence).second);
  std::error_code error;
  return (paths.must_exist ? fs::weakly_canonical(path, error) : path).string();
}

std::vector<Environment> read_recorded_entry(YamlReader node, const SuitePaths& paths) {
  const auto [category, name, first, end] = read_names(node);
  const YamlReader sequence = node.at("sequence");
  const BesideFrames beside(node, paths);
  node.finish();
  std::vector<Environment> environments;
  for (int i = first; i < end; ++i) {
    environments.push_back(recorded_environment(with_index(name, i), category,
                                                read_sequence(sequence, paths, i, beside.topics),
                                                beside, paths, i));
    check_folder_name(node, environments.back().name);
  }
  return environments;
}

std::vector<Environment> read_pattern_entry(YamlReader node, const SuitePaths& paths,
                                            Environments& all) {
  const YamlReader pattern = node.at("sequences");
  const std::map<std::string, std::string> categories = read_categories(node);
  if (categories.empty()) node.string("category");  // reports that it is missing
  std::optional<std::string> fixed;
  if (const auto category = node.find("category")) {
    if (!categories.empty()) category->fail("is given together with `categories`: give only one");
    check_folder_name(*category, category->as_string());
    fixed = category->as_string();
  }
  const bool may_be_absent = node.boolean("may_be_absent", false);
  const BesideFrames beside(node, paths);
  if (beside.queries) beside.queries->fail("is for one recording, not for a pattern");
  node.finish();

  const std::string text = pattern.as_string();
  const auto known = paths.found.find(text);
  const std::vector<FoundRecording> found =
      known != paths.found.end() ? known->second
                                 : find_recordings(pattern, paths, may_be_absent, all.notes);
  std::map<std::string, std::size_t> left_out;
  std::vector<Environment> made;
  for (const FoundRecording& recording : found) {
    const auto category = categories.find(recording.scene_type);
    if (!fixed && category == categories.end()) {
      ++left_out[recording.scene_type];
      continue;
    }
    const fs::path place = split_sequence(recording.sequence).second;
    made.push_back(recorded_environment(place.stem().string(), fixed ? *fixed : category->second,
                                        recording.sequence, beside, paths, 0));
  }
  if (made.empty() && !found.empty())
    pattern.fail(fmt::format("none of {} has a scene type that `categories` names: {}",
                             counted(found.size(), "recording"), counted_types(left_out)));
  if (made.size() < found.size())
    all.notes.push_back(fmt::format("{}: {} of {} left out: {}", text, found.size() - made.size(),
                                    counted(found.size(), "recording"), counted_types(left_out)));
  all.found[text] = found;
  return made;
}

}  // namespace mh
