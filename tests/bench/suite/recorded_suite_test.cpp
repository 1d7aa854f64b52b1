// SPDX-License-Identifier: Apache-2.0
// Recordings in suites: what their entries mean, and which ones are refused.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/suite/run_spec.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "slam/io/error.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

class RecordedSuite : public testing::Test {
 protected:
  RecordedSuite()
      : folder_(fs::temp_directory_path() / fmt::format("mh_recorded_suite_{}", getpid())) {
    fs::remove_all(folder_);
    for (const char* name : {"desk", "desk_again"}) {
      fs::create_directories(folder_ / name);
      std::ofstream(folder_ / name / "rgb.txt") << "# none\n";
    }
    for (const auto& [scan, type] : {std::pair("scene0000_00", "Bathroom"),
                                     {"scene0001_00", "Bedroom / Hotel"},
                                     {"scene0002_00", "Stairs"},
                                     {"scene0003_00", ""}}) {
      fs::create_directories(folder_ / "scans" / scan / "color");
      fs::create_directories(folder_ / "scans" / scan / "depth");
      if (*type != '\0')
        std::ofstream(folder_ / "scans" / scan / (std::string(scan) + ".txt"))
            << "sceneType = " << type << "\n";
    }
    std::ofstream(folder_ / "scans" / "table.tsv") << "id\n";
    for (const char* name :
         {"camera.yaml", "classes.yaml", "house.yaml", "robot.yaml", "words", "pepper.yaml"})
      std::ofstream(folder_ / name) << "x";
  }
  ~RecordedSuite() override { fs::remove_all(folder_); }

  std::string text(const std::string& environments, const std::string& labels = "[recorded]",
                   const std::string& more = "") const {
    return fmt::format(
        "environments:\n{}\nvocabulary: words\nsystems: [semantic, plain]\nlabels: {}\n{}",
        environments, labels, more);
  }
  Suite load(const std::string& environments, const std::string& labels = "[recorded]",
             const std::string& more = "", const SuiteOverrides& overrides = {}) const {
    return parse_suite(text(environments, labels, more), folder_ / "suite.yaml", overrides);
  }
  std::string error(const std::string& environments, const std::string& labels = "[recorded]",
                    const std::string& more = "", const SuiteOverrides& overrides = {}) const {
    try {
      load(environments, labels, more, overrides);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  static void expect_in(const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << "no '" << part << "' in: " << message;
  }

  fs::path folder_;
};

constexpr const char* kDesk = "- {category: desk, sequence: 'tum:desk'}";

TEST_F(RecordedSuite, ARecordingTakesThePlaceOfASceneAndHasALevelOfItsOwn) {
  const Suite suite = load(
      "- {category: desk, sequence: 'tum:desk', queries: 'tum:desk_again', settings: camera.yaml, "
      "classes: classes.yaml}",
      "[recorded, none]", "trials: 2\n");
  ASSERT_EQ(suite.environments.size(), 1U);
  const Environment& e = suite.environments[0];
  EXPECT_TRUE(e.is_recorded());
  EXPECT_EQ(e.sequence, "tum:" + (folder_ / "desk").string());
  EXPECT_EQ(e.queries, "tum:" + (folder_ / "desk_again").string());
  EXPECT_EQ(e.settings, folder_ / "camera.yaml");
  EXPECT_EQ(e.classes, folder_ / "classes.yaml");
  EXPECT_EQ(suite.levels,
            (std::vector<Level>{{.file = kRecordedLevel, .of_recordings = true, .doses = {}}}));
  std::vector<std::string> names;
  for (const RunSpec& spec : expand(suite)) names.push_back(spec.name);
  EXPECT_EQ(names, (std::vector<std::string>{"semantic-recorded-recorded-0", "semantic-recorded-0",
                                             "plain-recorded-0", "semantic-recorded-recorded-1",
                                             "semantic-recorded-1", "plain-recorded-1"}));
  // Each run's description reaches a separate process unchanged.
  for (const RunSpec& spec : expand(suite)) {
    const RunSpec back = run_spec_from_json(to_json(spec));
    EXPECT_EQ(back.environment.sequence, e.sequence);
    EXPECT_EQ(back.environment.queries, e.queries);
    EXPECT_EQ(back.environment.settings, e.settings);
    EXPECT_EQ(back.environment.classes, e.classes);
    EXPECT_EQ(back.labels, spec.labels);
  }
  // A path whose layout can be recognized needs no layout prefix.
  EXPECT_EQ(load("- {category: desk, sequence: desk}").environments[0].sequence,
            (folder_ / "desk").string());
  EXPECT_EQ(load("- {category: scan, count: 2, sequence: 'scannet:scans/scene000{i}_00'}")
                .environments[1]
                .sequence,
            "scannet:" + (folder_ / "scans/scene0001_00").string());
}

TEST_F(RecordedSuite, TopicsOfMessagesArePartOfWhatARunIs) {
  std::ofstream(folder_ / "desk.mcap") << "x";
  const std::string plain = "- {category: desk, sequence: 'mcap:desk.mcap'}";
  const std::string named =
      "- {category: desk, sequence: 'mcap:desk.mcap', topics: 'color=/a,depth=/b'}";
  const RunSpec run = expand(load(named)).front();
  EXPECT_EQ(run.environment.topics, "color=/a,depth=/b");
  EXPECT_EQ(run_spec_from_json(to_json(run)).environment.topics, run.environment.topics);
  EXPECT_NE(to_json(run), to_json(expand(load(plain)).front()));
  expect_in(error("- {category: desk, sequence: 'mcap:desk.mcap', topics: 'hue=/a'}"),
            "suite.yaml:2: ");
}

TEST_F(RecordedSuite, WhatIsOfScenesIsRefusedWithItsReason) {
  for (const char* key : {"robot: robot.yaml", "mapping_tour: auto", "query_tour: auto",
                          "pedestrian: robot.yaml", "sensors: pepper.yaml", "up: y"})
    expect_in(error(fmt::format("- {{category: desk, sequence: 'tum:desk', {}}}", key)),
              "is for simulated scenes: a recording has its own");
  expect_in(error(kDesk, "[exact]"), "'exact' labels are rendered from a simulated scene");
  expect_in(error("- {category: house, scene: house.yaml, robot: robot.yaml}", "[recorded]",
                  "levels: [pepper.yaml]\n"),
            "no environment is one");
  expect_in(error("- {category: desk, sequence: 'tum:nowhere'}"), "does not exist");
  expect_in(error("- {category: desk, sequence: scans}"), "name its layout: " + sequence_forms());
  expect_in(error("- {category: desk, name: \"a\\nplain 99\", sequence: 'tum:desk'}"),
            "cannot name a folder");
  expect_in(error("- {category: desk, sequence: 'tum:'}"),
            "suite.yaml:2: environments[0].sequence");
  expect_in(error("- {category: desk, sequence: 'tum:words'}"), "is not a folder");
  expect_in(error("- {category: desk, sequence: 'tum:desk', topics: 'color=/a'}"),
            "topics: 'color=/a': a recording of layout 'tum' has no topics");
  expect_in(error(kDesk, "[recorded]", "", {.scene = folder_ / "house.yaml"}), "is a recording");
}

TEST_F(RecordedSuite, ASecondRecordingThatIsNeverQueriedIsNoted) {
  const std::string entry = "- {category: desk, sequence: 'tum:desk', queries: 'tum:desk_again'}";
  EXPECT_TRUE(load(entry).notes.empty());
  const Suite unasked = load(entry, "[recorded]", "protocol: {test_interval: 0}\n");
  ASSERT_EQ(unasked.notes.size(), 1U);
  expect_in(unasked.notes[0], "no frame is queried, not even from the second tour of 'desk'");
}

// Otherwise, statistics over scenes would count the place twice.
TEST_F(RecordedSuite, OnePlaceUnderTwoNamesIsRefused) {
  fs::create_directory_symlink(folder_ / "desk", folder_ / "link");
  for (const char* other : {"tum:desk", "desk", "tum:desk/", "tum:scans/../desk", "tum:link"})
    expect_in(error(fmt::format("{}\n- {{category: table, sequence: '{}'}}", kDesk, other)),
              "suite.yaml:3: environments[1]: 'table' repeats 'desk'");
  expect_in(error(std::string(kDesk) +
                  "\n- {category: table, sequence: 'tum:desk', settings: camera.yaml}"),
            "'table' repeats 'desk'");
  expect_in(error("- {category: desk, count: 2, sequence: 'tum:desk'}"),
            "'desk-1' repeats 'desk-0'");
  expect_in(error("- {category: desk, sequence: 'tum:desk', queries: './desk'}"),
            "suite.yaml:2: environments[0].queries: is the recording that is mapped");
  expect_in(error("- {category: desk, sequence: 'tum:desk', queries: 'tum:link/'}"),
            "is the recording that is mapped");
  // The same sequence with queries from a different recording is a different environment.
  EXPECT_EQ(load(std::string(kDesk) +
                 "\n- {category: table, sequence: 'tum:desk', queries: 'tum:desk_again'}")
                .environments.size(),
            2U);
  const std::string house =
      "- {category: house, scene: house.yaml, robot: robot.yaml, mapping_tour: 'handheld:0'}";
  expect_in(error(house + "\n- {category: home, scene: ./house.yaml, robot: robot.yaml, "
                          "mapping_tour: 'handheld:0'}",
                  "[exact]", "levels: [pepper.yaml]\n"),
            "'home' repeats 'house'");
}

TEST_F(RecordedSuite, TakesTheFaultsThatCanBeAddedToItsImages) {
  const fs::path levels = fs::path(MH_SOURCE_DIR) / "sim/sensors/levels";
  std::ofstream(folder_ / "dark.yaml") << "depth_noise: {enabled: false}\n"
                                          "color_noise: {enabled: false}\nlight: {share: 0.1}\n";
  const Suite suite = load(kDesk, "[recorded]", "levels: [recorded, dark.yaml]\n");
  std::vector<std::string> names;
  for (const RunSpec& spec : expand(suite)) {
    names.push_back(spec.name);
    EXPECT_EQ(run_spec_from_json(to_json(spec)).level, spec.level);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"semantic-recorded-recorded-0", "plain-recorded-0",
                                             "semantic-recorded-dark-0", "plain-dark-0"}));
  const Suite swept =
      load(kDesk, "[recorded]", "parameters: {map: rebuilt, level.lens_blur.sigma_px: [0.5, 2]}\n");
  ASSERT_EQ(swept.levels.size(), 2U);
  EXPECT_EQ(level_name(swept.levels[1]), "recorded+lens_blur.sigma_px=2");
  expect_in(error(kDesk, "[recorded]", "levels: [" + (levels / "handheld.yaml").string() + "]\n"),
            "cannot be added to a recording: motion_blur: needs images along the camera's motion");
  expect_in(error(kDesk, "[recorded]",
                  "parameters: {map: rebuilt, level.motion_blur.exposure_ms: [10]}\n"),
            "cannot be added to a recording: motion_blur");
}

TEST_F(RecordedSuite, MixedWithScenesEachTakesTheLabelsAndLevelsThatFitIt) {
  const std::string both = std::string(kDesk) +
                           "\n- {category: house, scene: house.yaml, robot: robot.yaml, "
                           "mapping_tour: 'handheld:0'}";
  const Suite suite = load(both, "[exact, recorded]", "levels: [pepper.yaml]\n");
  EXPECT_EQ(suite.levels.size(), 2U);
  std::vector<std::string> names;
  for (const RunSpec& spec : expand(suite)) names.push_back(spec.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"desk-semantic-recorded-recorded-0", "desk-plain-recorded-0",
                                      "house-semantic-exact-pepper-0", "house-plain-pepper-0"}));
  expect_in(error(both, "[exact]", "levels: [pepper.yaml]\n"), "none of them is for 'desk'");
  expect_in(error(both, "[recorded]", "levels: [pepper.yaml]\n"), "none of them is for 'house'");
}

TEST_F(RecordedSuite, APatternTakesTheCategoryOfEachScanAndCountsWhatItLeavesOut) {
  const std::string entry =
      "- {sequences: 'scannet:${scans}/scene*', categories: {Bathroom: bathroom, "
      "'Bedroom / Hotel': bedroom}}";
  const SuiteOverrides set{.set = {{"scans", (folder_ / "scans").string()}}};
  const Suite suite = load(entry, "[recorded]", "", set);
  ASSERT_EQ(suite.environments.size(), 2U);
  EXPECT_EQ(suite.environments[0].name, "scene0000_00");
  EXPECT_EQ(suite.environments[0].category, "bathroom");
  EXPECT_EQ(suite.environments[1].category, "bedroom");
  ASSERT_EQ(suite.notes.size(), 1U);
  expect_in(suite.notes[0], "2 of 4 recordings left out: 1 without a scene type, 1 'Stairs'");
  fs::create_directories(folder_ / "scans/scene0009_00");  // half a download
  const Suite with_half = load(entry, "[recorded]", "", set);
  ASSERT_EQ(with_half.notes.size(), 2U);
  expect_in(with_half.notes[0], "left out: 1 folder without a recording, the first: scene0009_00");
  // The results can still be read where the scans do not exist.
  SuiteOverrides elsewhere = set;
  elsewhere.found = suite.found;
  fs::remove_all(folder_ / "scans");
  const Suite again = parse_suite(text(entry), folder_ / "suite.yaml", elsewhere, false);
  ASSERT_EQ(again.environments.size(), 2U);
  EXPECT_EQ(again.environments[1].sequence, suite.environments[1].sequence);
  EXPECT_EQ(again.environments[1].category, "bedroom");

  fs::create_directories(folder_ / "scans");
  fs::create_directory_symlink(folder_ / "nowhere", folder_ / "scans/scene0001_00");
  expect_in(error(entry, "[recorded]", "", set), "scene0001_00' is a broken link");
  fs::remove_all(folder_ / "scans");

  expect_in(error(entry), "'${scans}' is not set: use --set scans=VALUE");
  expect_in(error(kDesk, "[recorded]", "", set), "--set scans: nothing in it is called ${scans}");
  expect_in(error(kDesk, "[recorded]", "", {.set = {{"features.count", "500"}}}),
            "${features.count}; SLAM settings go into the suite, under `slam:`");
  expect_in(error(kDesk, "[recorded]", "slam: {features: {count: ${n}}}\n", {.set = {{"n", "5"}}}),
            "within { } or [ ], ${...} must be quoted");
  expect_in(error(entry, "[recorded]", "", set), "no recording matches");
}

TEST_F(RecordedSuite, APatternThatMayBeAbsentIsLeftOutWithANote) {
  const std::string absent =
      "- {sequences: 'tum:nowhere/rgbd_*', category: tum, may_be_absent: true}\n";
  const Suite suite = load(absent + kDesk);
  ASSERT_EQ(suite.environments.size(), 1U);
  EXPECT_EQ(suite.environments[0].name, "desk");
  ASSERT_EQ(suite.notes.size(), 1U);
  expect_in(suite.notes[0], "nowhere/rgbd_*: left out: it does not exist");
  expect_in(error(absent), "nothing is left to run: ");
}

TEST_F(RecordedSuite, APatternNeedsACategoryOrAMapOfThem) {
  expect_in(error("- {sequences: 'scans/scene*'}"), "category");
  expect_in(error("- {sequences: 'scans/scene*', categories: {Lobby: lobby}}"),
            "none of 4 recordings has a scene type that `categories` names");
  EXPECT_EQ(load("- {sequences: 'scans/scene*', category: scan}").environments.size(), 4U);
}

}  // namespace
}  // namespace mh
