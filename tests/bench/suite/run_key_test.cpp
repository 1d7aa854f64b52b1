// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/run_key.hpp"

#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/suite/inputs.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"
#include "tests/bench/suite/other_build.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;
namespace fs = std::filesystem;

/// What a run would read if each of its sources were a single file with arbitrary content.
std::vector<InputDigest> inputs_of(const RunSpec& spec) {
  std::vector<InputDigest> inputs = inputs_of_program(spec.system);
  const auto add = [&](const std::string& name, const std::optional<fs::path>& source) {
    if (source && !source->empty())
      noted(inputs, name, *source, [&] { return read_file(*source); });
  };
  const Environment& e = spec.environment;
  sources(e, [&](const WorldSource& source, const std::optional<fs::path>& path) {
    add(source.key, path);
  });
  add("sequence", fs::path(e.sequence));
  add("queries", e.queries);
  add("settings", e.settings);
  add("classes", e.classes);
  if (const auto& detector = spec.labels.detector)
    for (const auto& [name, file] : {std::pair("network", detector->network),
                                     {"config", detector->config},
                                     {"classes of the network", detector->classes},
                                     {"boxes", detector->boxes}})
      add(name, file);
  if (!e.is_recorded()) add("level", spec.level.file);
  if (spec.episodes)
    for (const EpisodeVariant& variant : spec.episodes->variants)
      sources(variant, [&](const WorldSource& source, const std::optional<fs::path>& path) {
        add(input_name(variant, source), path);
      });
  add("vocabulary", spec.vocabulary);
  return inputs;
}

std::string run_key_of(const RunSpec& spec) {
  return run_key(spec, inputs_of(spec));
}

std::string map_key_of(const RunSpec& spec) {
  return map_key(spec, inputs_of(spec));
}

/// A run's description with every field that it may have, and files whose content is fixed.
class RunKey : public testing::Test {
 protected:
  RunKey() {
    const Environment environment{.name = "house",
                                  .category = "houses",
                                  .scene = file("scene.yaml"),
                                  .robot = file("robot.yaml"),
                                  .mapping_tour = file("mapping_tour.yaml"),
                                  .frame = {.up = UpAxis::kY, .floor_z_m = 0.5},
                                  .query_tour = file("query_tour.yaml"),
                                  .query_scene = file("query_scene.yaml"),
                                  .kidnapped_tour = file("kidnapped_tour.yaml"),
                                  .sensors = file("sensors.yaml"),
                                  .pedestrian = file("pedestrian.yaml"),
                                  .query_pedestrian = file("query_pedestrian.yaml")};
    ours_ = {.name = "semantic-exact-pepper-0",
             .environment = environment,
             .level = file("pepper.yaml"),
             .vocabulary = file("words"),
             .system = {SystemKind::kSemantic, "semantic", {}},
             .labels = LabelMode::kExact,
             .trial = 1,
             .seed = 3,
             .slam = {},
             .points = {SemanticConfig{}, SemanticConfig{.gamma = 0.5}},
             .protocol = {},
             .graded = GradedSpec{.distance_m = {0, 0.5, 2}, .angle_deg = {0, 60}},
             .episodes = EpisodesSpec{.goals = {"bed"},
                                      .variants = {{.name = "moved", .scene = file("moved.yaml")}}},
             .map_labels = LabelMode::kExact,
             .max_frames = 100};
    theirs_ = library_ = recorded_ = dosed_ = detected_ = ours_;
    theirs_.system = {SystemKind::kOutside, "vo",
                      OutsideProgram{.name = "vo",
                                     .command = file("slam").string() + " {trajectory}",
                                     .folder = folder_,
                                     .inputs = {file("weights").string()}}};
    library_.system = {SystemKind::kOutside, "vo",
                       OutsideProgram{.name = "vo",
                                      .mode = OutsideMode::kConversation,
                                      .folder = folder_,
                                      .inputs = {file("weights").string()},
                                      .library = file("libvo.so").string(),
                                      .settings = file("vo.yaml").string()}};
    recorded_.environment = {.name = "desk",
                             .category = "desks",
                             .scene = {},
                             .robot = {},
                             .mapping_tour = {},
                             .sequence = file("desk.bag"),
                             .queries = file("again.bag"),
                             .settings = file("camera.yaml"),
                             .classes = file("classes.yaml"),
                             .topics = "color=/a,depth=/b",
                             .suite_states_readout = true};
    recorded_.level = {.file = kRecordedLevel, .of_recordings = true};
    recorded_.labels = LabelMode::kRecorded;
    dosed_.labels = {LabelMode::kBoxes, {.enabled = true, .class_set = ClassSet::kFive}, "coarse"};
    detected_.labels = {{.network = file("yolo.weights"),
                         .config = file("yolo.cfg"),
                         .classes = file("yolo.names"),
                         .boxes = {},
                         .settings = {}},
                        "yolo"};
    other_ = file("other.yaml").string();
    other_build = {};
  }
  ~RunKey() override { fs::remove_all(folder_); }

  /// A file whose content is its own name.
  fs::path file(const std::string& name) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / name) << name;
    return folder_ / name;
  }

  /// The description with a different value at one place, one that the field accepts.
  RunSpec with_another(const RunSpec& spec, const Pointer& place) const {
    const Json json = to_json(spec);
    const Json& old = json[place];
    std::vector<Json> others = {other_,
                                "conversation",
                                "trajectory",
                                "boxes",
                                "plain",
                                "words",
                                "map",
                                "interpolated",
                                "z",
                                "continue",
                                "orb_slam2",
                                "as_released",
                                "new_noise",
                                "side_by_side",
                                "same_label",
                                "exact",
                                "all",
                                "yolov5",
                                "center",
                                "unit",
                                "rgb",
                                "foreground",
                                7};
    if (old.is_boolean()) others = {!old.get<bool>()};
    if (old.is_number_integer()) others = {old.get<int>() + 1};
    if (old.is_number_float()) others = {old.get<double>() + 0.125};
    for (const Json& other : others) {
      if (other == old) continue;
      Json changed = json;
      changed[place] = other;
      try {
        RunSpec read = run_spec_from_json(changed);
        if (to_json(read) != json) return read;
      } catch (const InputError&) {
        // not a word that this field accepts
      }
    }
    ADD_FAILURE() << "no other value for " << place.to_string();
    return spec;
  }

  /// The places in a description whose value may change without changing the key.
  template <class Key>
  std::set<std::string> free_places(const RunSpec& spec, Key key) const {
    std::set<std::string> free;
    const std::string before = key(spec);
    const Json places = to_json(spec).flatten();
    for (const auto& [place, value] : places.items())
      if (!value.is_null() && key(with_another(spec, Pointer(place))) == before) free.insert(place);
    return free;
  }

  fs::path folder_ = fs::temp_directory_path() / ("mh_run_key_" + std::to_string(getpid()));
  std::string other_;
  RunSpec ours_, theirs_, library_, recorded_, dosed_, detected_;
};

const std::set<std::string> kNames = {"/name", "/environment/name", "/environment/category",
                                      "/labels/called", "/map_labels/called"};

/// Changes every value, at any depth; adds a value to empty optionals and lists.
template <class T>
void change(T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    value = !value;
  } else if constexpr (std::is_arithmetic_v<T>) {
    value = static_cast<T>(value + 1);
  } else if constexpr (std::is_same_v<T, std::string> || std::is_same_v<T, fs::path>) {
    value += "other";
  } else if constexpr (std::is_enum_v<T>) {
    const auto all = words(value);
    value = all[all.size() > 1 && all[0].second == value ? 1 : 0].second;  // there may be only one
  } else if constexpr (kIsOptional<T>) {
    change(value.emplace());
  } else if constexpr (kIsVector<T>) {
    change(value.emplace_back());
  } else if constexpr (kIsShared<T>) {
    auto whole = *value;
    change(whole);
    value = whole;
  } else {
    for_each_field(value, [](const auto&, auto& field) { change(field); });
  }
}

TEST(RunDescription, KeepsEveryField) {
  RunSpec spec;
  const Json before = to_json(spec).flatten();
  change(spec);
  const Json json = to_json(spec);
  const Json after = json.flatten();
  for (const auto& [place, value] : before.items())
    EXPECT_FALSE(after.contains(place) && after[place] == value) << place << " was not changed";
  const RunSpec back = run_spec_from_json(json);
  EXPECT_EQ(to_json(back), json);
  EXPECT_EQ(run_key(back, {}), run_key(spec, {}));
  EXPECT_NE(run_key(back, {}), run_key(RunSpec(), {}));
  EXPECT_EQ(back.environment, spec.environment);
  EXPECT_EQ(back.system.outside, spec.system.outside);
  EXPECT_EQ(back.labels, spec.labels);
  EXPECT_EQ(back.slam, spec.slam);
  EXPECT_EQ(back.points, spec.points);
  EXPECT_EQ(back.protocol, spec.protocol);
  EXPECT_EQ(back.graded, spec.graded);
  EXPECT_EQ(back.episodes, spec.episodes);
  EXPECT_EQ(back.map_labels, spec.map_labels);
}

TEST(RunDescription, RefusesOneWithoutAFieldOrWithAWordOfNone) {
  const auto refusal = [](const Json& json) {
    try {
      run_spec_from_json(json);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const Json json = to_json(RunSpec());
  EXPECT_EQ(refusal(json), "");
  for (const auto& [key, value] : json.items()) {
    Json less = json;
    less.erase(key);
    EXPECT_NE(refusal(less).find("'" + key + "'"), std::string::npos) << refusal(less);
  }
  Json other = json;
  other["labels"]["mode"] = "exactly";
  EXPECT_EQ(refusal(other), "'exactly' is not a known word");
}

TEST_F(RunKey, IsThatOfTheDescriptionReadBack) {
  for (const RunSpec& spec : {ours_, theirs_, library_, recorded_, dosed_, detected_}) {
    const RunSpec back = run_spec_from_json(to_json(spec));
    EXPECT_EQ(to_json(back), to_json(spec));
    EXPECT_EQ(run_key_of(back), run_key_of(spec));
    EXPECT_EQ(map_key_of(back), map_key_of(spec));
    EXPECT_EQ(stored_spec(back), stored_spec(spec));
  }
}

TEST_F(RunKey, IsOfADescriptionThatIsStoredWithoutPlaces) {
  for (const RunSpec& spec : {ours_, recorded_, dosed_, detected_})
    EXPECT_EQ(stored_spec(spec).find(folder_.string()), std::string::npos) << stored_spec(spec);
  const Json detected = Json::parse(stored_spec(detected_));
  EXPECT_EQ(detected["labels"]["detector"]["network"], "yolo.weights");
  EXPECT_EQ(detected["level"]["file"], "pepper");
  const Json recorded = Json::parse(stored_spec(recorded_));
  EXPECT_EQ(recorded["environment"]["settings"], "camera.yaml");
  EXPECT_EQ(recorded["level"]["file"], kRecordedLevel);
}

TEST_F(RunKey, ChangesWithEveryFieldOfARunButItsNames) {
  ASSERT_EQ(run_key_of(ours_), run_key_of(ours_));
  EXPECT_EQ(free_places(ours_, run_key_of), kNames);
}

TEST_F(RunKey, ChangesWithEveryFieldOfAnOutsideSystemButItsFolder) {
  std::set<std::string> free = kNames;
  free.insert("/system/outside/folder");
  EXPECT_EQ(free_places(theirs_, run_key_of), free);
  EXPECT_EQ(free_places(library_, run_key_of), free);
}

TEST_F(RunKey, ChangesWithEveryFieldOfARecordingAndOfLabels) {
  std::set<std::string> free = kNames;
  free.insert("/level/file");  // its faults are in its content
  EXPECT_EQ(free_places(recorded_, run_key_of), free);
  EXPECT_EQ(free_places(dosed_, run_key_of), kNames);
  EXPECT_EQ(free_places(detected_, run_key_of), kNames);
}

TEST_F(RunKey, OfAMapLeavesOutWhatOnlyItsQueriesDependOn) {
  std::set<std::string> free = kNames;
  free.insert({"/trial", "/system/name", "/environment/query_tour", "/environment/query_scene",
               "/environment/query_pedestrian", "/protocol/query_attempts", "/protocol/attempts",
               "/protocol/max_blank_frames", "/protocol/correct_distance_m",
               "/protocol/correct_angle_deg", "/protocol/truth"});
  const Json places = to_json(ours_).flatten();
  for (const auto& [place, value] : places.items())
    if (place.starts_with("/points/") || place.starts_with("/graded/") ||
        (place.starts_with("/episodes/") && place != "/episodes/ticks_per_frame" &&
         !value.is_null()))
      free.insert(place);
  EXPECT_EQ(free_places(ours_, map_key_of), free);
}

TEST_F(RunKey, ChangesWithAPointOrAnInputMoreAndWithWhatIsNotThere) {
  const std::string before = run_key_of(ours_);
  RunSpec changed = ours_;
  changed.points.push_back(changed.points[0]);
  EXPECT_NE(run_key_of(changed), before);
  changed = ours_;
  changed.max_frames.reset();
  EXPECT_NE(run_key_of(changed), before);
  EXPECT_NE(map_key_of(changed), map_key_of(ours_));
  for (const auto field :
       {&Environment::query_tour, &Environment::query_scene, &Environment::kidnapped_tour,
        &Environment::sensors, &Environment::pedestrian}) {
    changed = ours_;
    (changed.environment.*field).reset();
    EXPECT_NE(run_key_of(changed), before);
  }
  changed = theirs_;
  changed.system.outside->inputs.clear();
  EXPECT_NE(run_key_of(changed), run_key_of(theirs_));
}

// If two files trade places, the same files are read, but each under a different name, so the key
// changes.
TEST_F(RunKey, TellsWhichFileIsWhich) {
  RunSpec changed = ours_;
  std::swap(changed.environment.query_tour, changed.environment.kidnapped_tour);
  EXPECT_NE(run_key_of(changed), run_key_of(ours_));
  changed = ours_;
  std::swap(changed.level.file, changed.vocabulary);
  EXPECT_NE(run_key_of(changed), run_key_of(ours_));
}

TEST_F(RunKey, ChangesWithTheContentOfEachFileAndNotWithItsPlace) {
  for (const char* name :
       {"scene.yaml", "robot.yaml", "mapping_tour.yaml", "query_tour.yaml", "query_scene.yaml",
        "kidnapped_tour.yaml", "sensors.yaml", "pedestrian.yaml", "pepper.yaml", "words"}) {
    const std::string before = run_key_of(ours_);
    std::ofstream(folder_ / name) << name << " edited";
    EXPECT_NE(run_key_of(ours_), before) << name;
    std::ofstream(folder_ / name) << name;
    EXPECT_EQ(run_key_of(ours_), before) << name;
  }
  const fs::path moved = folder_ / "moved";
  fs::create_directories(moved);
  RunSpec elsewhere = ours_;
  Environment& e = elsewhere.environment;
  for (fs::path* source :
       {&elsewhere.level.file, &elsewhere.vocabulary, &e.scene, &e.robot, &e.mapping_tour,
        &*e.query_tour, &*e.query_scene, &*e.kidnapped_tour, &*e.sensors, &*e.pedestrian}) {
    const fs::path to = moved / source->filename();
    fs::copy(*source, to);
    *source = to;
    EXPECT_EQ(run_key_of(elsewhere), run_key_of(ours_)) << to;
    EXPECT_EQ(stored_spec(elsewhere), stored_spec(ours_)) << to;
  }
}

TEST_F(RunKey, ChangesWithTheCodeAndTheBuildAndNotWithTheCommit) {
  for (const auto& key : {run_key_of, map_key_of}) {
    other_build = {};
    const std::string before = key(ours_);
    other_build.code = "2";
    EXPECT_NE(key(ours_), before);
    other_build = {};
    other_build.compiler = "13";
    EXPECT_NE(key(ours_), before);
    other_build = {};
    other_build.commit = "b";
    EXPECT_EQ(key(ours_), before) << "a commit that leaves the code as it is";
  }
}

}  // namespace
}  // namespace mh
