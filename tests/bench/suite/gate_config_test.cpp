// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/gate_config.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "bench/results/gate/baseline.hpp"
#include "bench/results/gate/from_runs.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/vocabulary/vocabulary.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

GateConfig read(const std::string& text) {
  return read_gate(YamlReader::parse(text, "suite.yaml"), {"hall", "attic"});
}

TEST(GateConfig, HoldsTolerancesForAllAndForOneScenario) {
  const GateConfig c = read(
      "tolerances: {completeness: 0.05, ate_rmse_m: {absolute: 0.01, relative: 0.5}}\n"
      "scenarios: {attic: {completeness: 0.2}}\n");
  EXPECT_EQ(c.tolerances.at("completeness").of(0.9), 0.05);
  EXPECT_EQ(c.tolerances.at("ate_rmse_m").of(0.1), 0.05);
  EXPECT_EQ(c.tolerances.at("ate_rmse_m").of(0.001), 0.01);
  EXPECT_EQ(c.of_scenario.at("attic").at("completeness").of(0.9), 0.2);
}

TEST(GateConfig, SlipsAreNamed) {
  for (const char* text :
       {"scenarios: {}", "tolerances: {compleetness: 0.1}", "tolerances: {completeness: -0.1}",
        "tolerances: {completeness: {abs: 0.1}}", "tolerances: {}\nscenarios: {cellar: {}}",
        "tolerances: {}\nextra: 1"})
    EXPECT_THROW(read(text), InputError) << text;
}

std::string gate_digest(const std::filesystem::path& suite) {
  InputReader inputs;
  return gate_suite_digest(load_suite(suite), inputs);
}

/// A suite whose scene is a single triangle.
class GateDigest : public testing::Test {
 protected:
  GateDigest()
      : folder_(std::filesystem::temp_directory_path() / ("mh_gate_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    const std::string root = MH_SOURCE_DIR "/bench/scenarios/";
    for (const char* name : {"house.obj", "later.obj"})
      write(name, "mtllib look.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    write("look.mtl", "newmtl a\nKd 1 0 0\n");
    write("robot", read_file(root + "robot.yaml"));
    write("tour", read_file(root + "tours/room.yaml"));
    write("pedestrian", read_file(root + "pedestrian.yaml"));
    write("level", read_file(MH_SOURCE_DIR "/sim/sensors/levels/ideal.yaml"));
    train_words(1);
  }
  ~GateDigest() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  void train_words(std::uint64_t seed) const {
    std::vector<std::vector<Descriptor>> images{std::vector<Descriptor>(40)};
    for (std::size_t i = 0; i < images[0].size(); ++i)
      images[0][i][0] = RandomStream(seed).below(i, UINT64_MAX);
    Vocabulary::train(images, {.branching = 2, .depth = 1}).save(folder_ / "words");
  }
  std::string digest(const std::string& more = "") const { return digest_of("house.obj", more); }
  std::string digest_of(const std::string& scene, const std::string& more = "") const {
    write("suite.yaml", "environments: [{category: hall, scene: " + scene +
                            ", mapping_tour: tour, query_tour: tour, query_scene: later.obj, "
                            "pedestrian: pedestrian}]\n"
                            "robot: robot\nvocabulary: words\nlevels: [level]\nsystems: [plain]\n"
                            "labels: [exact]\n" +
                            more);
    return gate_digest(folder_ / "suite.yaml");
  }
  std::filesystem::path folder_;
};

TEST_F(GateDigest, SeesEachFileAndSettingThatMakesTheRuns) {
  const std::string before = digest();
  for (const char* name :
       {"house.obj", "later.obj", "look.mtl", "robot", "tour", "level", "pedestrian"}) {
    const std::string text = read_file(folder_ / name);
    write(name, text + "# changed\n");
    EXPECT_NE(digest(), before) << name;
    write(name, text);
    EXPECT_EQ(digest(), before) << name;
  }
  EXPECT_NE(digest("trials: 3"), before);
  EXPECT_NE(digest("seed: 3"), before);
  EXPECT_NE(digest("protocol: {rewind_frames: 49}"), before);
  const std::string turned = digest_of("house.obj, up: y");
  EXPECT_NE(turned, before);
  EXPECT_NE(digest_of("house.obj, up: y, floor_z_m: 0.5"), turned);
  EXPECT_NE(digest("senses: [imu]"), before);
  const auto labels = [&](const std::string& of) {
    digest();  // writes the suite
    std::string suite = read_file(folder_ / "suite.yaml");
    const std::string exact = "labels: [exact]";
    suite.replace(suite.find(exact), exact.size(), "labels: [" + of + "]");
    write("suite.yaml", suite);
    return gate_digest(folder_ / "suite.yaml");
  };
  EXPECT_EQ(labels("exact"), before);
  const std::string confused = labels("{of: exact, name: noisy, confusion: 0.1}");
  EXPECT_NE(confused, before);
  EXPECT_NE(labels("{of: exact, name: noisy, confusion: 0.6}"), confused);
  const std::string graded = digest("graded: {distance_m: [0, 1], angle_deg: [0, 30]}");
  EXPECT_NE(graded, before);
  EXPECT_NE(digest("graded: {distance_m: [0, 2], angle_deg: [0, 30]}"), graded);
}

// The digest and the keys of the runs come from a single read of the files: if a file changes
// afterwards, the runs detect that.
TEST_F(GateDigest, IsOfTheFilesAsTheyWereRead) {
  const std::string before = digest();
  const Suite suite = load_suite(folder_ / "suite.yaml");
  InputReader inputs;
  inputs.inputs_of(expand(suite).front());
  for (const char* name : {"house.obj", "level"}) write(name, read_file(folder_ / name) + "\n");
  train_words(2);
  EXPECT_EQ(gate_suite_digest(suite, inputs), before);
  InputReader later;
  EXPECT_NE(gate_suite_digest(suite, later), before);
  EXPECT_NE(gate_settings(suite, later), gate_settings(suite, inputs));
}

TEST_F(GateDigest, LeavesOutWhatAChangeMayChange) {
  const std::string before = digest();
  EXPECT_EQ(digest("slam: {semantics: {xi: 2}}"), before);
  EXPECT_EQ(digest("check: {tolerances: {completeness: 0.1}}"), before);
  train_words(2);
  EXPECT_EQ(digest(), before);
}

// Otherwise `modelhouse check ci` would refuse to compare: a new suite needs a new baseline.
TEST(Baseline, OfTheShippedSuiteIsThatOfTheSuiteAsItIsShipped) {
  const std::filesystem::path suites = MH_SOURCE_DIR "/bench/suites";
  EXPECT_EQ(load_baseline(suites / "ci.baseline.json").suite_digest,
            gate_digest(suites / "ci.yaml"));
}

TEST_F(GateDigest, WhatAChangeMayChangeIsTold) {
  const auto settings = [&](const std::string& more = "") {
    digest(more);  // writes the suite
    InputReader inputs;
    return Baseline{.suite = "s",
                    .suite_digest = "",
                    .origin = {},
                    .settings = gate_settings(load_suite(folder_ / "suite.yaml"), inputs)};
  };
  const Baseline before = settings();
  EXPECT_TRUE(changed_settings(before, settings("trials: 3")).empty());
  const auto xi = changed_settings(before, settings("slam: {semantics: {xi: 3}}"));
  ASSERT_EQ(xi.size(), 1u);
  EXPECT_EQ(xi[0], "slam/semantics/xi: 1.5 -> 3.0");
  train_words(2);
  const auto words = changed_settings(before, settings());
  ASSERT_EQ(words.size(), 1u);
  EXPECT_TRUE(words[0].starts_with("vocabulary: ")) << words[0];
}

}  // namespace
}  // namespace mh
