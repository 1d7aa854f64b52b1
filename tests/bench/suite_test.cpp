// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/suite.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "bench/plan/runs.hpp"
#include "slam/core/error.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A folder with empty files for a suite to name, and the suite.
class SuiteFile : public testing::Test {
 protected:
  SuiteFile() : folder_(fs::temp_directory_path() / ("mh_suite_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    for (const char* name : {"house.yaml", "robot.yaml", "tour.yaml", "words", "pepper.yaml"})
      std::ofstream(folder_ / name) << "x";
  }
  ~SuiteFile() override { fs::remove_all(folder_); }

  Suite load(const std::string& extra, const std::string& levels = "[pepper.yaml]",
             const std::string& labels = "[exact, boxes]") {
    std::ofstream(folder_ / "suite.yaml")
        << "scene: house.yaml\nrobot: robot.yaml\nmapping_tour: tour.yaml\nvocabulary: words\n"
        << "levels: " << levels << "\nsystems: [semantic, plain]\nlabels: " << labels << "\n"
        << extra;
    return load_suite(folder_ / "suite.yaml");
  }
  std::string error(const std::string& extra, const std::string& levels = "[pepper.yaml]",
                    const std::string& labels = "[exact, boxes]") {
    try {
      load(extra, levels, labels);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST_F(SuiteFile, ReadsWhatStandsThere) {
  const Suite suite = load(
      "slam: {gamma: 0.5, xi: 2, overlap: labels}\n"
      "protocol: {test_interval: 10, reset: map}\ntrials: 3\nseed: 7\n");
  EXPECT_EQ(suite.name, "suite");
  EXPECT_EQ(suite.scene, folder_ / "house.yaml");
  EXPECT_EQ(suite.semantics.gamma, 0.5);
  EXPECT_EQ(suite.semantics.xi, 2.0);
  EXPECT_EQ(suite.semantics.alpha, SemanticConfig{}.alpha);
  EXPECT_EQ(suite.semantics.overlap, Overlap::kLabels);
  EXPECT_EQ(suite.protocol.test_interval, 10);
  EXPECT_EQ(suite.protocol.reset, DropReset::kMap);
  EXPECT_EQ(suite.trials, 3);
  EXPECT_EQ(suite.seed, 7u);
  EXPECT_FALSE(suite.query_tour);
}

TEST_F(SuiteFile, ExpandsToOneRunPerSystemLabelsLevelTrialAndThePlainOnce) {
  const std::vector<RunSpec> runs = expand(load("trials: 2\n"));
  ASSERT_EQ(runs.size(), 6u);  // 2 trials x (semantic-exact, semantic-boxes, plain)
  EXPECT_EQ(runs[0].name, "semantic-exact-pepper-0");
  EXPECT_EQ(runs[1].name, "semantic-boxes-pepper-0");
  EXPECT_EQ(runs[2].name, "plain-pepper-0");
  EXPECT_EQ(runs[2].labels, LabelMode::kNone);
  EXPECT_EQ(runs[5].trial, 1);
}

struct BadLine {
  const char* line;
  const char* message;  // must be part of the error
};

class BadSuite : public SuiteFile, public testing::WithParamInterface<BadLine> {};

TEST_P(BadSuite, IsRefusedWithFileLineAndValue) {
  const std::string message = error(GetParam().line);
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_NE(message.find("suite.yaml:8: "), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadSuite,
    testing::Values(
        BadLine{"colour: red\n", "unknown key 'colour'"},
        BadLine{"slam: {alpha: 1.2}\n", "slam.alpha: 1.2 is outside [0, 1)"},
        BadLine{"slam: {alpha: 1}\n", "slam.alpha: 1 is outside [0, 1)"},
        BadLine{"slam: {beta: -0.1}\n", "slam.beta: -0.1 is outside [0, 1)"},
        BadLine{"slam: {xi: 0.5}\n", "slam.xi: 0.5 is outside"},
        BadLine{"slam: {gamma: -1}\n", "slam.gamma: -1 is outside"},
        BadLine{"slam: {gamma: .nan}\n", "slam.gamma: '.nan' is not a finite number"},
        BadLine{"slam: {gamma: much}\n", "slam.gamma: 'much' is not a number"},
        BadLine{"slam: {overlap: both}\n", "'both' is none of labels, augmented, words"},
        BadLine{"slam: {delta: 1}\n", "unknown key 'slam.delta'"},
        BadLine{"slam: 3\n", "must be a mapping"},
        BadLine{"protocol: {test_interval: 1}\n", "protocol.test_interval: 1 is outside"},
        BadLine{"protocol: {reset: all}\n", "'all' is none of counter, map"},
        BadLine{"query_tour: nowhere.yaml\n", "no such file"},
        BadLine{"trials: 0\n", "trials: 0 is outside"},
        BadLine{"trials: 1.5\n", "trials: '1.5' is not a whole number"},
        BadLine{"name: a/b\n", "'a/b' cannot name a folder"},
        BadLine{"seed: -1\n", "seed: -1 is outside"}));

TEST_F(SuiteFile, RefusesEmptyAndDoubledLists) {
  EXPECT_NE(error("", "[]").find("suite.yaml:5: levels: is empty"), std::string::npos);
  EXPECT_NE(error("", "[pepper.yaml, pepper.yaml]").find("stands twice"), std::string::npos);
  EXPECT_NE(error("", "[ideal.yaml]").find("no such file"), std::string::npos);
  EXPECT_NE(error("", "[pepper.yaml]", "[]").find("labels: is empty"), std::string::npos);
  EXPECT_NE(error("", "[pepper.yaml]", "exact").find("labels: must be a list"), std::string::npos);
}

TEST(ShippedSuites, AreWellFormed) {
  for (const char* file : {"model_house.yaml", "model_house_ideal.yaml"}) {
    const Suite suite = load_suite(fs::path(MH_SOURCE_DIR) / "bench/suites" / file);
    EXPECT_EQ(suite.systems.size(), 2u) << file;
    EXPECT_EQ(suite.labels.size(), 2u) << file;
  }
}

}  // namespace
}  // namespace mh
