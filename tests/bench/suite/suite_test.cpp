// SPDX-License-Identifier: Apache-2.0
#include "bench/suite/suite.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bench/suite/find_program.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/run_key.hpp"
#include "bench/suite/run_spec.hpp"
#include "bench/suite/shipped.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A folder with the suite and the files that it names.
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
        << "environments:\n- {category: house, scene: house.yaml, mapping_tour: tour.yaml}\n"
        << "robot: robot.yaml\nvocabulary: words\n"
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
      "slam: {semantics: {gamma: 0.5, xi: 2, overlap: labels}, features: {count: 500}}\n"
      "protocol: {test_interval: 10, reset: map, truth: interpolated}\ntrials: 3\nseed: 7\n");
  EXPECT_EQ(suite.name, "suite");
  ASSERT_EQ(suite.environments.size(), 1u);
  EXPECT_EQ(suite.environments[0].name, "house");
  EXPECT_EQ(suite.environments[0].scene, folder_ / "house.yaml");
  EXPECT_EQ(suite.environments[0].robot, folder_ / "robot.yaml");
  EXPECT_FALSE(suite.environments[0].query_tour);
  EXPECT_EQ(suite.slam->semantics.gamma, 0.5);
  EXPECT_EQ(suite.slam->semantics.xi, 2.0);
  EXPECT_EQ(suite.slam->semantics.alpha, SemanticConfig{}.alpha);
  EXPECT_EQ(suite.slam->semantics.overlap, Overlap::kLabels);
  EXPECT_EQ(suite.protocol.test_interval, 10);
  EXPECT_EQ(suite.protocol.reset, DropReset::kMap);
  EXPECT_EQ(suite.protocol.truth, QueryTruth::kInterpolated);
  EXPECT_EQ(suite.trials, 3);
  EXPECT_EQ(suite.seed, 7u);
}

TEST_F(SuiteFile, IsJudgedByCorrectAnswersUnlessItNamesSuccess) {
  EXPECT_EQ(load("").measure, Measure::kCorrect);
  EXPECT_EQ(load("measure: success\n").measure, Measure::kSuccess);
  EXPECT_NE(error("measure: sucess\n").find("'sucess' is not one of correct, success"),
            std::string::npos);
  // Suites whose designs were fixed before any measurement use success as their measure.
  for (const char* name : {"arms", "rules_verdict", "table1", "like_rooms"})
    EXPECT_EQ(load_suite(shipped_file(name, Shipped::kSuite)).measure, Measure::kSuccess) << name;
  EXPECT_EQ(load_suite(shipped_file("model_house", Shipped::kSuite)).measure, Measure::kCorrect);
}

TEST_F(SuiteFile, SensesAreOfARobotThatDrives) {
  EXPECT_TRUE(load("").senses.empty());
  const Suite suite = load("senses: [odometry]\n");
  EXPECT_EQ(suite.senses, std::vector{Sense::kOdometry});
  for (const RunSpec& run : expand(suite)) EXPECT_EQ(run.senses, suite.senses);
  EXPECT_EQ(load("senses: [imu, odometry]\n").senses, (std::vector{Sense::kImu, Sense::kOdometry}));
  EXPECT_NE(error("senses: [odometry, odometry]\n").find("'odometry' is listed twice"),
            std::string::npos);
  EXPECT_NE(error("senses: [sonar]\n").find("sonar"), std::string::npos);
  const auto by_hand = [&](const char* sense) {
    std::ofstream(folder_ / "by_hand.yaml")
        << "environments:\n- {category: house, scene: house.yaml, robot: robot.yaml, mapping_tour: "
           "'handheld:0'}\nlevels: [pepper.yaml]\nsystems: [plain]\nlabels: [none]\nvocabulary: "
           "words\nsenses: ["
        << sense << "]\n";
    return load_suite(folder_ / "by_hand.yaml").senses;
  };
  EXPECT_EQ(by_hand("imu"), std::vector{Sense::kImu});
  EXPECT_THROW(by_hand("laser"), InputError);
  try {
    by_hand("odometry");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("'house' is a handheld scan"), std::string::npos)
        << e.what();
  }
}

TEST_F(SuiteFile, RefusesADesignThatChangedSinceItWasStated) {
  std::ofstream(folder_ / "design.md") << "The question, and how it is answered.\n";
  const std::string study = "study: {design: design.md, xxh3: 'ca917f622f4946c3'}\n";
  EXPECT_EQ(error(study), "");
  std::ofstream(folder_ / "design.md", std::ios::app) << "And another one.\n";
  const std::string message = error(study);
  EXPECT_NE(message.find("suite.yaml:8"), std::string::npos) << message;
  EXPECT_NE(message.find("design.md has changed since it was stated"), std::string::npos)
      << message;
  EXPECT_NE(error("study: {design: none.md, xxh3: '0'}\n").find("none.md"), std::string::npos);
}

TEST_F(SuiteFile, RefusesToSweepInAStatedStudy) {
  std::ofstream(folder_ / "design.md") << "The question, and how it is answered.\n";
  const std::string study = "study: {design: design.md, xxh3: 'ca917f622f4946c3'}\n";
  const std::string sweep = "parameters: {map: fixed, semantics.gamma: [0.5, 1]}\n";
  EXPECT_EQ(error(sweep), "");
  const std::string message = error(study + sweep);
  EXPECT_NE(message.find("suite.yaml:9: parameters: a sweep in a stated study"), std::string::npos)
      << message;
}

TEST_F(SuiteFile, IsReadElsewhereWhereTheFilesThatItNamesNeedNotBe) {
  const Suite here = load("");
  const std::string content = read_file(here.file);
  for (const char* name : {"house.yaml", "robot.yaml", "tour.yaml", "words", "pepper.yaml"})
    fs::remove(folder_ / name);
  const Suite elsewhere = parse_suite(content, here.file, {}, false);
  EXPECT_EQ(elsewhere.environments[0].scene, here.environments[0].scene);
  EXPECT_EQ(elsewhere.vocabulary, here.vocabulary);
  EXPECT_EQ(elsewhere.levels, here.levels);
  EXPECT_THROW(parse_suite(content, here.file), InputError);
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

TEST_F(SuiteFile, EveryKindOfLabelsReachesARunOfItsOwn) {
  const std::vector<RunSpec> runs =
      expand(load("", "[pepper.yaml]", "[exact, annotated, boxes, detector]"));
  ASSERT_EQ(runs.size(), 5u);  // four for the semantic system, one for the plain system
  for (const RunSpec& run : runs) EXPECT_EQ(run_spec_from_json(to_json(run)).labels, run.labels);
  EXPECT_EQ(runs[1].name, "semantic-annotated-pepper-0");
  EXPECT_EQ(runs[1].labels, LabelMode::kAnnotated);
}

TEST_F(SuiteFile, TakesWhatIsShippedByItsName) {
  std::ofstream(folder_ / "named.yaml")
      << "environments:\n- {category: house, scene: model_house, mapping_tour: "
         "model_house/mapping}\n"
      << "robot: pepper\nvocabulary: vocabulary\nlevels: [pepper.yaml, ideal]\n"
      << "systems: [plain]\nlabels: [none]\n";
  const Suite suite = load_suite(folder_ / "named.yaml");
  const fs::path root = MH_SOURCE_DIR;
  EXPECT_EQ(suite.environments[0].scene, root / "scenes/model_house/house.yaml");
  EXPECT_EQ(suite.environments[0].mapping_tour, root / "scenes/model_house/tours/mapping.yaml");
  EXPECT_EQ(suite.environments[0].robot, root / "robots/pepper/pepper.yaml");
  EXPECT_EQ(suite.vocabulary, root / "assets/vocabulary.mhvoc");
  EXPECT_EQ(suite.levels[0].file, folder_ / "pepper.yaml") << "a file beside the suite goes first";
  EXPECT_EQ(suite.levels[1].file, root / "sim/sensors/levels/ideal.yaml");
  EXPECT_NE(error("", "[peper]").find("did you mean 'pepper'?"), std::string::npos);
}

TEST_F(SuiteFile, NeedsAVocabularyForOurOwnSystemsAlone) {
  const auto load_with = [&](const std::string& systems) {
    std::ofstream(folder_ / "suite.yaml")
        << "environments:\n- {category: house, scene: house.yaml, mapping_tour: tour.yaml}\n"
        << "robot: robot.yaml\nlevels: [pepper.yaml]\nlabels: [none]\nsystems: " << systems << "\n";
    return load_suite(folder_ / "suite.yaml");
  };
  const Suite outside =
      load_with("[{name: theirs, protocol: trajectory, command: 'cat {dataset} {trajectory}'}]");
  EXPECT_TRUE(outside.vocabulary.empty());
  ASSERT_EQ(expand(outside).size(), 1u);
  for (const auto& [protocol, key] :
       {std::pair("trajectory", "reply_limit_s"), std::pair("conversation", "run_limit_s")}) {
    const std::string other =
        fmt::format("[{{name: a, command: x, protocol: {}, {}: 3}}]", protocol, key);
    try {
      load_with(other);
      ADD_FAILURE() << other;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(fmt::format("{}: applies only to protocol '", key)),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW(load_with("[plain]"), InputError);
}

TEST_F(SuiteFile, AMisspeltMotionIsToldWhichOneWasMeant) {
  std::ofstream(folder_ / "suite.yaml")
      << "environments:\n- {category: house, scene: house.yaml, mapping_tour: 'handhled:0'}\n"
      << "robot: robot.yaml\nvocabulary: words\nlevels: [pepper.yaml]\nsystems: [plain]\nlabels: "
         "[none]\n";
  try {
    load_suite(folder_ / "suite.yaml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(
        std::string(e.what()).find("did you mean 'handheld'? There are: auto, survey, handheld, "),
        std::string::npos)
        << e.what();
  }
}

TEST_F(SuiteFile, AMotionThatCannotBeIsNamedWithItsPlace) {
  std::ofstream(folder_ / "suite.yaml")
      << "environments:\n- {category: house, scene: house.yaml, mapping_tour: 'handheld:0:10'}\n"
      << "robot: robot.yaml\nvocabulary: words\nlevels: [pepper.yaml]\nsystems: [plain]\nlabels: "
         "[none]\n";
  try {
    load_suite(folder_ / "suite.yaml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("suite.yaml:2: environments[0].mapping_tour: handheld "
                                         "motion: frames: 10 is outside 30 to 100000"),
              std::string::npos)
        << e.what();
  }
}

TEST_F(SuiteFile, AMisspeltKeyIsToldWhichOneWasMeant) {
  EXPECT_NE(error("protocoll: {}\n").find("did you mean 'protocol'?"), std::string::npos);
  EXPECT_NE(error("", "[pepper.yaml]", "[exakt]").find("did you mean 'exact'?"), std::string::npos);
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
        BadLine{"color: red\n", "unknown key 'color'"},
        BadLine{"slam: {semantics: {alpha: 1.2}}\n", "slam.semantics.alpha: 1.2 is outside [0, 1)"},
        BadLine{"slam: {semantics: {alpha: 1}}\n", "slam.semantics.alpha: 1 is outside [0, 1)"},
        BadLine{"slam: {semantics: {beta: -0.1}}\n", "slam.semantics.beta: -0.1 is outside [0, 1)"},
        BadLine{"slam: {semantics: {xi: 0.5}}\n", "slam.semantics.xi: 0.5 is outside"},
        BadLine{"slam: {semantics: {gamma: -1}}\n", "slam.semantics.gamma: -1 is outside"},
        BadLine{"slam: {semantics: {gamma: .nan}}\n",
                "slam.semantics.gamma: '.nan' is not a finite number"},
        BadLine{"slam: {semantics: {gamma: much}}\n",
                "slam.semantics.gamma: 'much' is not a number"},
        BadLine{"slam: {semantics: {overlap: both}}\n",
                "'both' is not one of labels, augmented, words"},
        BadLine{"slam: {semantics: {delta: 1}}\n", "unknown key 'slam.semantics.delta'"},
        BadLine{"slam: 3\n", "must be a mapping"},
        BadLine{"compare: [[semantic, plian]]\n", "'plian' is not one of the suite's systems"},
        BadLine{"compare: [[semantic]]\n", "must be two systems"},
        BadLine{"compare: [[plain, plain]]\n", "compares a system with itself"},
        BadLine{"compare: [[semantic, plain], [semantic, plain]]\n", "is listed twice"},
        BadLine{"parameters: {map: fixed}\n", "varies nothing"},
        BadLine{"parameters: {semantics.alpha: [0.5]}\n", "key 'map' is missing"},
        BadLine{"parameters: {map: new, semantics.alpha: [0.5]}\n",
                "'new' is not one of fixed, rebuilt"},
        BadLine{"parameters: {map: fixed, semantics.alpha: [0.5, 1.2]}\n",
                "parameters.semantics.alpha[1]: 1.2 is outside [0, 1)"},
        BadLine{"parameters: {map: fixed, semantics.xi: [0.5]}\n",
                "parameters.semantics.xi[0]: 0.5 is outside"},
        BadLine{"parameters: {map: fixed, semantics.gamma: [-1]}\n",
                "parameters.semantics.gamma[0]: -1 is outside"},
        BadLine{"parameters: {map: fixed, semantics.gamma: [1, 1]}\n", "'1' is listed twice"},
        BadLine{"parameters: {map: fixed, semantics.gamma: []}\n", "is empty"},
        BadLine{"parameters: {map: fixed, level.light.share: [0.5]}\n",
                "decides the map, too: it needs `map: rebuilt`"},
        BadLine{"parameters: {map: rebuilt, level.light.shares: [0.5]}\n",
                "did you mean 'light.share'"},
        BadLine{"parameters: {map: rebuilt, level.light.share: [1.5]}\n", "1.5 is outside [0, 1]"},
        BadLine{"parameters: {map: rebuilt, level.light.share: [1, 1]}\n", "'1' is listed twice"},
        BadLine{"parameters: {map: fixed, delta: [1]}\n",
                "parameters.delta: is not a setting of SLAM"},
        BadLine{"parameters: {map: fixed, semantics.gama: [1]}\n", "semantics.gamma"},
        BadLine{"parameters: {map: fixed, features.count: [500]}\n", "needs `map: rebuilt`"},
        BadLine{"parameters: {map: rebuilt, features.count: [5]}\n", "5 is outside [10, 20000]"},
        BadLine{"parameters: {map: rebuilt, sobol: {points: 2, ranges: {loop.enabled: [false, "
                "true]}}}\n",
                "is not a number"},
        BadLine{"parameters: {map: fixed, sobol: {points: 4, ranges: {semantics.xi: [2, 1]}}}\n",
                "2 is not below 1"},
        BadLine{
            "parameters: {map: fixed, sobol: {points: 4, ranges: {semantics.alpha: [0, 1.2]}}}\n",
            "1.2 is outside [0, 1)"},
        BadLine{"parameters: {map: fixed, sobol: {points: 4, ranges: {}}}\n", "names no setting"},
        BadLine{"non_inferiority_margin: 2\n", "2 is outside [0, 1]"},
        BadLine{"protocol: {test_interval: 1}\n", "would hold out every frame"},
        BadLine{"protocol: {reset: all}\n", "'all' is not one of counter, map"},
        BadLine{"trials: 0\n", "trials: 0 is outside"},
        BadLine{"trials: 1.5\n", "trials: '1.5' is not an integer"},
        BadLine{"seed: 18446744073709551615\n", "seed: 18446744073709551615 is outside [0, "},
        BadLine{"name: a/b\n", "'a/b' cannot name a folder"},
        BadLine{"seed: -1\n", "seed: -1 is outside"}));

TEST_F(SuiteFile, RefusesEmptyAndDoubledLists) {
  EXPECT_NE(error("", "[]").find("suite.yaml:5: levels: is empty"), std::string::npos);
  EXPECT_NE(error("", "[pepper.yaml, pepper.yaml]").find("is listed twice"), std::string::npos);
  EXPECT_NE(error("", "[ideal.yaml]").find("no such file"), std::string::npos);
  EXPECT_NE(error("", "[pepper.yaml]", "[]").find("labels: is empty"), std::string::npos);
  EXPECT_NE(error("", "[pepper.yaml]", "exact").find("labels: must be a list"), std::string::npos);
}

TEST_F(SuiteFile, EnvironmentsAreListedCountedOrFoundInFiles) {
  std::ofstream(folder_ / "b.env.yaml")
      << "{category: office, name: second, scene: house.yaml, mapping_tour: tour.yaml}";
  std::ofstream(folder_ / "a.env.yaml")
      << "{category: office, name: first, scene: house.yaml, mapping_tour: tour.yaml,\n"
         " query_tour: tour.yaml}";
  std::ofstream(folder_ / "suite.yaml")
      << "environments:\n- files: '*.env.yaml'\n"
         "- {category: hall, count: 3, scene: 'generated:hall:{i}', mapping_tour: tour.yaml}\n"
         "- {category: hall, first: 5, count: 2, scene: 'generated:hall:{i}'}\n"
         "robot: robot.yaml\nvocabulary: words\nlevels: [pepper.yaml]\nsystems: [plain]\n"
         "labels: [exact]\n";
  const Suite suite = load_suite(folder_ / "suite.yaml");
  std::vector<std::string> names;
  for (const Environment& e : suite.environments) names.push_back(e.name);
  EXPECT_EQ(names, (std::vector<std::string>{"first", "second", "hall-0", "hall-1", "hall-2",
                                             "hall-5", "hall-6"}));
  EXPECT_TRUE(suite.environments[0].query_tour);
  EXPECT_EQ(suite.environments[3].scene, "generated:hall:1");
  EXPECT_EQ(suite.environments[6].scene, "generated:hall:6");
  EXPECT_TRUE(is_generated(suite.environments[3].scene));
  EXPECT_EQ(expand(suite)[3].name, "hall-1-plain-pepper-0");
}

TEST_F(SuiteFile, ASweepOverGammaOrMassThatWouldNotActIsRefused) {
  const auto message = [&](const std::string& parameters, const std::string& mass) -> std::string {
    std::ofstream(folder_ / "suite.yaml")
        << "environments:\n- {category: house, scene: house.yaml, robot: robot.yaml}\n"
           "vocabulary: words\nlevels: [pepper.yaml]\nlabels: [exact]\nsystems: [semantic]\n"
           "slam: {semantics: {label_mass: "
        << mass << "}}\nparameters: {" << parameters << "}\n";
    try {
      load_suite(folder_ / "suite.yaml");
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string none = "semantics.label_mass: 0 is not a mass";
  EXPECT_NE(message("map: fixed, semantics.label_mass: [0, 0.1]", "0").find(none),
            std::string::npos);
  EXPECT_EQ(message("map: fixed, semantics.label_mass: [0.01, 0.1]", "0"), "");
  const std::string idle = "semantics.gamma does nothing on a fixed map";
  const std::string both = "semantics.label_mass: [0.01, 0.1], semantics.gamma: [0, 1]";
  EXPECT_NE(message("map: fixed, " + both, "0").find(idle), std::string::npos);
  EXPECT_EQ(message("map: rebuilt, " + both, "0"), "");
  EXPECT_NE(message("map: fixed, semantics.gamma: [0, 1]", "0.02").find(idle), std::string::npos);
}

TEST_F(SuiteFile, ASweepThatNoSystemFeelsIsRefused) {
  const auto load = [&](const std::string& systems, const std::string& parameters) {
    std::ofstream(folder_ / "suite.yaml")
        << "environments:\n- {category: house, scene: house.yaml, robot: robot.yaml}\n"
           "vocabulary: words\nlevels: [pepper.yaml]\nlabels: [exact]\nsystems: "
        << systems << "\nparameters: {map: fixed, " << parameters << "}\n";
    return load_suite(folder_ / "suite.yaml");
  };
  try {
    load("[plain]", "semantics.gamma: [0.5, 1]");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no system of the suite uses what is varied"),
              std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(load("[plain]", "semantics.alpha: [0.5, 0.8]"));
  EXPECT_NO_THROW(load("[plain, semantic]", "semantics.gamma: [0.5, 1]"));
}

TEST_F(SuiteFile, SceneMayBeAScannetFolderWithAFrame) {
  fs::create_directories(folder_ / "scans/s");
  std::ofstream(folder_ / "scans/s/s_vh_clean_2.ply") << "ply";
  const auto key = [&](const std::string& keys) {
    std::ofstream(folder_ / "suite.yaml")
        << "environments:\n- {category: scan, scene: scans/s/, robot: robot.yaml" << keys
        << "}\nvocabulary: words\nlevels: [pepper.yaml]\nsystems: [plain]\nlabels: [exact]\n";
    const Suite suite = load_suite(folder_ / "suite.yaml");
    EXPECT_EQ(suite.environments[0].scene, folder_ / "scans/s");
    const RunSpec spec = expand(suite)[0];
    EXPECT_EQ(run_spec_from_json(to_json(spec)).environment.frame, spec.environment.frame);
    return std::pair(spec.environment.frame, run_key(spec, {}));
  };
  const auto [none, plain_key] = key("");
  EXPECT_EQ(none, SceneFrame{});
  const auto [frame, told_key] = key(", up: y, floor_z_m: 0.05");
  EXPECT_EQ(frame, (SceneFrame{.up = UpAxis::kY, .floor_z_m = 0.05}));
  EXPECT_NE(told_key, plain_key);
  EXPECT_NE(key(", floor_z_m: 0.06").second, told_key);
}

TEST_F(SuiteFile, RefusesEnvironmentsThatAreNone) {
  const auto message = [&](const std::string& list) -> std::string {
    std::ofstream(folder_ / "suite.yaml") << "environments: " << list << "\nvocabulary: words\n";
    try {
      load_suite(folder_ / "suite.yaml");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string rest = "scene: house.yaml, robot: robot.yaml, mapping_tour: tour.yaml";
  EXPECT_NE(message("[]").find("suite.yaml:1: environments: is empty"), std::string::npos);
  EXPECT_NE(message("[{category: a, " + rest + "}, {category: a, " + rest + "}]")
                .find("two environments are named 'a'"),
            std::string::npos);
  EXPECT_NE(message("[{category: a, scene: none.yaml, robot: robot.yaml, mapping_tour: t}]")
                .find("environments[0].scene: '"),
            std::string::npos);
  EXPECT_NE(message("[{category: a, color: 3, " + rest + "}]").find("unknown key"),
            std::string::npos);
  EXPECT_NE(message("[{category: a, scene: house.yaml, mapping_tour: tour.yaml}]")
                .find("key 'robot' is missing"),
            std::string::npos);
  EXPECT_NE(message("[{category: a, up: x, " + rest + "}]").find("'x' is neither y nor z"),
            std::string::npos);
  EXPECT_NE(message("[{files: '*.nothing'}]").find("no file matches"), std::string::npos);
}

TEST_F(SuiteFile, AGridHasEveryCombinationAndOneRunForAFixedMap) {
  const Suite suite =
      load("parameters: {map: fixed, semantics.xi: [1, 2], semantics.alpha: [0.5, 0.6, 0.7]}\n");
  ASSERT_EQ(suite.sweep.points.size(), 6u);
  EXPECT_EQ(suite.sweep.points[4]->semantics.xi, 2.0);
  EXPECT_EQ(suite.sweep.points[4]->semantics.alpha, 0.6);
  EXPECT_EQ(suite.sweep.points[4]->semantics.beta, suite.slam->semantics.beta);
  const std::vector<RunSpec> runs = expand(suite);
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].points.size(), 6u);
  EXPECT_EQ(runs[2].points.size(), 3u) << "the plain system knows no xi";
  EXPECT_EQ(runs[0].slam, suite.slam);
}

TEST_F(SuiteFile, ARebuiltMapMakesARunForEachPoint) {
  const Suite suite =
      load("parameters: {map: rebuilt, semantics.xi: [1, 2], semantics.alpha: [0.5, 0.6]}\n");
  const std::vector<RunSpec> runs = expand(suite);
  ASSERT_EQ(runs.size(), 4u * 2u + 2u);
  for (const RunSpec& run : runs) {
    ASSERT_EQ(run.points.size(), 1u);
    EXPECT_EQ(run.points[0], run.slam->semantics);
  }
  EXPECT_EQ(runs[2].name, "semantic-exact-pepper-p01-0");
}

TEST_F(SuiteFile, SaysWhichSystemsAreCompared) {
  EXPECT_EQ(load("").compare, (std::vector<SystemPair>{{0, 1}}));
  EXPECT_EQ(load("compare: [[plain, semantic]]\n").compare, (std::vector<SystemPair>{{1, 0}}));
  EXPECT_TRUE(load("compare: []\n").compare.empty());
}

TEST_F(SuiteFile, ASweepTakesAnySetting) {
  const Suite suite = load(
      "parameters: {map: rebuilt, features.count: [500, 1000], loop.enabled: [true, false]}\n"
      "slam: {track: {min_inliers: 25}}\n");
  EXPECT_EQ(suite.sweep.varied, (std::vector<std::string>{"features.count", "loop.enabled"}));
  ASSERT_EQ(suite.sweep.points.size(), 4u);
  const std::vector<RunSpec> runs = expand(suite);
  ASSERT_EQ(runs.size(), 3u * 4u) << "exact, boxes and the plain system, which looks at them too";
  EXPECT_EQ(runs[2].slam->features.count, 500);
  EXPECT_FALSE(runs[2].slam->loop.enabled);
  for (const RunSpec& run : runs) {
    EXPECT_EQ(run.slam->track.min_inliers, 25);
    EXPECT_EQ(run.points, std::vector{run.slam->semantics});
    EXPECT_EQ(run_spec_from_json(to_json(run)).slam, run.slam);
  }
}

// Sobol's sequence by the recurrence of Joe and Kuo ("Constructing Sobol sequences with better
// two-dimensional projections", 2008), computed in integers from the first rows of their table.
// Each axis is shifted by its own bits, which are those of point 0.
TEST(Sobol, IsTheSequenceOfJoeAndKuoShifted) {
  struct Row {
    unsigned s, a;
    std::vector<std::uint64_t> m;
  };
  std::vector<Row> rows = {
      {1, 0, {1}},          {2, 1, {1, 3}},        {3, 1, {1, 3, 1}},       {3, 2, {1, 1, 1}},
      {4, 1, {1, 1, 3, 3}}, {4, 4, {1, 3, 5, 13}}, {5, 2, {1, 1, 5, 5, 17}}};
  for (auto& [s, a, m] : rows)
    for (std::size_t k = m.size(); k < 32; ++k) {  // m[k] is Joe and Kuo's m_(k+1)
      std::uint64_t next = m[k - s] ^ (m[k - s] << s);
      for (unsigned i = 1; i < s; ++i)
        if ((a >> (s - 1 - i)) % 2 == 1) next ^= m[k - i] << i;
      m.push_back(next);
    }
  const auto bits = [](double share) { return static_cast<std::uint64_t>(share * 0x1.0p32); };
  const auto shift = sobol_point(0, 5);
  ASSERT_EQ(shift.size(), rows.size() + 1);
  for (const std::uint32_t index : {1U, 2U, 3U, 6U, 7U, 29U, 1000U, 65535U, 0x9abcdef1U}) {
    const auto point = sobol_point(index, 5);
    for (std::size_t d = 0; d < point.size(); ++d) {
      std::uint64_t expected = 0;
      for (unsigned k = 0; k < 32; ++k)
        if ((index >> k) % 2 == 1) expected ^= (d == 0 ? 1 : rows[d - 1].m[k]) << (31 - k);
      EXPECT_EQ(bits(point[d]) ^ bits(shift[d]), expected) << index << ", axis " << d;
    }
  }
  EXPECT_NE(sobol_point(0, 6), shift) << "the seed makes the shift";
  EXPECT_NE(shift[0], shift[1]);
}

TEST_F(SuiteFile, ASobolSequenceTakesWholeNumbersToo) {
  const Suite suite = load(
      "parameters: {map: rebuilt, sobol: {points: 8, ranges: {features.count: [500, 507], "
      "track.coast_s: [0.5, 1]}}}\n");
  std::set<int> counts;
  ASSERT_EQ(suite.sweep.points.size(), 8u);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const SlamConfig& point = suite.sweep.points[i];
    const auto share = sobol_point(i, 0);
    counts.insert(point.features.count);
    EXPECT_EQ(point.features.count, std::lround(500 + 7 * share[0]));
    EXPECT_NEAR(point.track.coast_s, 0.5 + 0.5 * share[1], 1e-12);
  }
  EXPECT_GE(counts.size(), 6u);
}

TEST_F(SuiteFile, NamesAnOutsideProgram) {
  std::ofstream(folder_ / "suite.yaml")
      << "environments:\n- {category: house, scene: house.yaml, mapping_tour: tour.yaml}\n"
         "robot: robot.yaml\nvocabulary: words\nlevels: [pepper.yaml]\nlabels: [exact]\n"
         "systems: [plain, {name: vo, command: 'run {dataset} {trajectory}', protocol: "
         "trajectory}, semantic]\n"
         "parameters: {map: rebuilt, semantics.xi: [1, 2]}\n";
  const Suite suite = load_suite(folder_ / "suite.yaml");
  EXPECT_EQ(suite.systems[1].outside->mode, OutsideMode::kTrajectory);
  const std::vector<RunSpec> runs = expand(suite);
  ASSERT_EQ(runs.size(), 4u) << "the semantic system alone looks at xi";
  EXPECT_EQ(runs[1].name, "vo-exact-pepper-0");
}

TEST_F(SuiteFile, AnOutsideProgramIsOneForEachValueOfItsOwnParameters) {
  const auto load_with = [&](const std::string& command, const std::string& vary) {
    std::ofstream(folder_ / "suite.yaml")
        << "environments:\n- {category: house, scene: house.yaml, mapping_tour: tour.yaml}\n"
           "robot: robot.yaml\nlevels: [pepper.yaml]\nlabels: [exact]\nsystems:\n"
           "- {name: orb, protocol: trajectory, command: '"
        << command << "', vary: {" << vary << "}}\n";
    return load_suite(folder_ / "suite.yaml").systems;
  };
  const auto systems =
      load_with("slam {n} {mode} {dataset} {trajectory}", "n: [500, 1000], mode: [fast, \"a'b\"]");
  ASSERT_EQ(systems.size(), 4U);
  EXPECT_EQ(systems[1].name, "orb_n_500_mode_a'b");
  EXPECT_EQ(systems[1].outside->command, "slam '500' 'a'\\''b' {dataset} {trajectory}");
  EXPECT_EQ(systems[2].name, "orb_n_1000_mode_fast");
  EXPECT_EQ(systems[2].outside->name, systems[2].name);
  EXPECT_THROW(load_with("slam {dataset} {trajectory}", "n: [1]"), InputError) << "not in it";
  EXPECT_THROW(load_with("slam {n} {trajectory}", "n: []"), InputError);
  EXPECT_THROW(load_with("slam {n} {trajectory}", "m: [1]"), InputError);
  EXPECT_THROW(load_with("slam {n} {trajectory}", "n: [1, 1]"), InputError) << "is listed twice";
}

TEST_F(SuiteFile, AnOutsideProgramsRunIsNamedByWhatItsFilesHold) {
  const auto put = [&](const char* name, const char* text) {
    std::ofstream(folder_ / name) << text;
  };
  for (const char* name : {"slam", "slam.py", "words.txt", "weights", "log"}) put(name, "1");
  const auto key_and_inputs = [&](const std::string& more = "") {
    std::ofstream(folder_ / "suite.yaml")
        << "environments:\n- {category: house, scene: house.yaml, mapping_tour: tour.yaml}\n"
           "robot: robot.yaml\nvocabulary: words\nlevels: [pepper.yaml]\nlabels: [exact]\n"
           "systems:\n- {name: vo, command: 'exec ./slam slam.py --words=words.txt no.txt >> log; "
           "true', protocol: conversation, inputs: [weights"
        << more << "]}\n";
    const RunSpec run = expand(load_suite(folder_ / "suite.yaml")).front();
    std::string names;
    const std::vector<InputDigest> inputs = inputs_of_program(run.system);
    for (const InputDigest& input : inputs) {
      EXPECT_TRUE(input.name.starts_with("vo: ")) << input.name;
      names += input.name.substr(4) + " ";
    }
    return std::pair(run_key(run, inputs), names);
  };
  const auto before = key_and_inputs();
  EXPECT_EQ(before.second, "./slam slam.py words.txt weights ");
  EXPECT_EQ(key_and_inputs(), before);
  for (const char* name : {"slam", "slam.py", "words.txt", "weights"}) {
    put(name, "2");
    EXPECT_NE(key_and_inputs().first, before.first) << name;
    put(name, "1");
  }
  put("log", "2");
  EXPECT_EQ(key_and_inputs(), before) << "it writes that one";
  try {
    key_and_inputs(", gone.bin");
    FAIL();
  } catch (const InputError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find("suite.yaml:"), std::string::npos) << what;
    EXPECT_NE(what.find("inputs[1]: "), std::string::npos) << what;
    EXPECT_NE(what.find("gone.bin' cannot be read: no such file"), std::string::npos) << what;
  }
}

TEST_F(SuiteFile, NamesALibraryAndItsRunIsNamedByWhatItsFilesHold) {
  const auto put = [&](const char* name, const char* text) {
    std::ofstream(folder_ / name) << text;
  };
  for (const char* name : {"libvo.so", "vo.yaml", "weights"}) put(name, "1");
  const auto suite = [&](const std::string& system) {
    std::ofstream(folder_ / "suite.yaml")
        << "environments:\n- {category: house, scene: house.yaml, mapping_tour: tour.yaml}\n"
           "robot: robot.yaml\nlevels: [pepper.yaml]\nlabels: [exact]\nsystems:\n- {name: vo, "
        << system << "}\n";
    return load_suite(folder_ / "suite.yaml");
  };
  const Suite read = suite("library: libvo.so, settings: vo.yaml, inputs: [weights]");
  const SystemSpec& vo = read.systems.front();
  EXPECT_EQ(vo.outside->mode, OutsideMode::kConversation);
  EXPECT_TRUE(vo.is_outside());
  EXPECT_FALSE(vo.takes_settings());
  EXPECT_NO_THROW(require_program(*vo.outside));
  EXPECT_EQ(unseen_program(*vo.outside), "");
  const RunSpec run = expand(read).front();
  EXPECT_EQ(run.name, "vo-exact-pepper-0");
  EXPECT_EQ(to_json(run_spec_from_json(to_json(run))), to_json(run));
  const auto key = [&] { return run_key(run, inputs_of_program(run.system)); };
  std::string names;
  for (const InputDigest& input : inputs_of_program(run.system)) names += input.name + " ";
  EXPECT_EQ(names, "vo: libvo.so vo: vo.yaml vo: modelhouse-library-host vo: weights ");
  const std::string before = key();
  for (const char* name : {"libvo.so", "vo.yaml", "weights"}) {
    put(name, "2");
    EXPECT_NE(key(), before) << name;
    put(name, "1");
  }
  EXPECT_EQ(key(), before);

  const auto refused = [&](const std::string& system) {
    try {
      require_program(*suite(system).systems.front().outside);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const auto expect_refused = [&](const std::string& system, const std::string& part) {
    const std::string what = refused(system);
    EXPECT_NE(what.find("suite.yaml:7: "), std::string::npos) << what;
    EXPECT_NE(what.find(part), std::string::npos) << what;
  };
  expect_refused("library: libgone.so",
                 "outside library 'vo' (libgone.so) cannot be loaded: no such file; has it been "
                 "built?");
  expect_refused("library: libvo.so, command: slam",
                 "systems[0].command: is for a command, but this is a library");
  expect_refused("library: libvo.so, protocol: conversation",
                 "systems[0].protocol: is for a command");
  expect_refused("library: libvo.so, settings: gone.yaml",
                 "gone.yaml' cannot be read: no such file");
  expect_refused("library: ''", "library: is empty");
  expect_refused("library: libvo.so, run_limit_s: 5", "applies only to protocol 'trajectory'");
  expect_refused("command: slam, protocol: library", "'library' is not one of");
}

TEST_F(SuiteFile, OneOfOursMayHaveSettingsOfItsOwn) {
  const std::string content = read_file(load("slam: {features: {count: 500}}\n").file);
  const auto suite = [&](const std::string& system) {
    std::string text = content;
    const std::string systems = "systems: [semantic, plain]";
    text.replace(text.find(systems), systems.size(), "systems: [semantic, plain, " + system + "]");
    return parse_suite(text, folder_ / "suite.yaml");
  };
  const Suite read = suite(
      "{name: released, system: plain, slam: {base: orb_slam2, relocalize: {neighbor_scores: "
      "as_released}, semantics: {alpha: 0.7}}}");
  const SystemSpec& released = read.systems.back();
  EXPECT_EQ(released.kind, SystemKind::kPlain);
  EXPECT_EQ(read.compare, (std::vector<SystemPair>{{0, 1}}));
  const RunSpec run = expand(read).back();
  EXPECT_EQ(run.name, "released-pepper-0");
  EXPECT_EQ(run.slam->relocalize.neighbor_scores, NeighborScores::kAsReleased);
  EXPECT_EQ(run.slam->relocalize.acceptance, Acceptance::kOrbSlam2);
  EXPECT_EQ(run.slam->semantics.alpha, 0.7);
  EXPECT_EQ(run.slam->semantics.gamma, 0) << "plain stays plain";
  EXPECT_EQ(run.slam->features.count, 500) << "what it does not set is the suite's";
  EXPECT_EQ(to_json(run_spec_from_json(to_json(run))), to_json(run));
  EXPECT_EQ(
      expand(suite("{name: same, system: plain, slam: {features: {count: 500}}}")).back().slam,
      expand(read).at(2).slam);

  const auto refused = [&](const std::string& system) {
    try {
      suite(system);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  for (const auto& [system, part] : {std::pair{"{name: a, system: plane, slam: {}}", "'plane'"},
                                     {"{name: plain, system: plain, slam: {}}", "Modelhouse's own"},
                                     {"{name: a, system: plain}", "slam"},
                                     {"{name: a, system: plain, slam: {}}", "sets nothing"},
                                     {"{name: a, system: plain, slam: {semantics: {xi: 0.5}}}",
                                      "slam.semantics.xi: 0.5 is outside"},
                                     {"{name: a, system: plain, slam: {semantics: {x: 1}}}",
                                      "unknown key 'systems[2].slam.semantics.x'"},
                                     {"{name: a, system: plain, slam: {words: 1}}", "unknown key"},
                                     {"{name: a, system: plain, command: b, slam: {base: ours}}",
                                      "unknown key 'systems[2].command'"}})
    EXPECT_NE(refused(system).find(part), std::string::npos) << refused(system);
}

TEST(FilesOf, TheFirstWordIsLookedForOnThePath) {
  const auto files = files_of({.name = "vo", .command = "sh -c true"});
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].word, "sh");
  EXPECT_TRUE(files[0].file.is_absolute()) << files[0].file;
}

TEST(FilesOf, ALibraryIsRunByItsHost) {
  const OutsideProgram program{.name = "mine", .folder = "/", .library = "lib.so"};
  const auto places = places_of(program);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0], "/lib.so");
  EXPECT_EQ(places[1], library_host());
  EXPECT_EQ(library_host().filename(), "modelhouse-library-host");
}

TEST_F(SuiteFile, TheProgramsOfACommandAreSeenAsTheShellReadsThem) {
  fs::create_directories(folder_ / "sub");
  fs::create_directories(folder_ / "sp ace");
  for (const char* name : {"prog.sh", "sub/prog.sh", "sp ace/prog.sh", "log.txt"}) {
    std::ofstream(folder_ / name) << "#!/bin/sh\n";
    fs::permissions(folder_ / name, fs::perms::owner_all);
  }
  setenv("MH_TEST_FOLDER", folder_.c_str(), 1);
  const auto seen = [&](const std::string& command) {
    const OutsideProgram program{.name = "vo", .command = command, .folder = folder_};
    std::string names;
    for (const ProgramFile& file : files_of(program))
      names += file.file.lexically_normal().lexically_relative(folder_).string() + ";";
    return names + (unseen_program(program).empty() ? "" : "warned");
  };
  for (const char* command :
       {"./prog.sh", "$MH_TEST_FOLDER/prog.sh", "\"${MH_TEST_FOLDER}\"/prog.sh", "$PWD/prog.sh",
        "exec './prog.sh' {seed}", "A=1 ./prog\\.sh", "cd sub && $MH_TEST_FOLDER/prog.sh 2>&1",
        "./prog.sh | tee -a log.txt", "./prog.sh >| log.txt # sub/prog.sh"})
    EXPECT_EQ(seen(command), "prog.sh;") << command;
  for (const char* command : {"\"sp ace/prog.sh\"", "sp\\ ace/prog.sh", "'sp ace'/prog.sh"})
    EXPECT_EQ(seen(command), "sp ace/prog.sh;") << command;
  for (const char* command :
       {"cd sub && ./prog.sh", "D=$MH_TEST_FOLDER; $D/prog.sh", "./{seed}.sh", "$(echo ./prog.sh)",
        "`echo ./prog.sh`", "./pro?.sh", "$MH_NOT_SET/prog.sh", "cd `dirname x` && ./prog.sh"})
    EXPECT_EQ(seen(command), "warned") << command;
  EXPECT_EQ(seen("cd sub && echo ready"), "") << "the shell's own words alone";
  OutsideProgram reported{.name = "vo", .command = "cd sub && ./prog.sh", .folder = folder_};
  reported.inputs = {"sub/prog.sh"};
  EXPECT_EQ(unseen_program(reported), "");
  ASSERT_EQ(files_of(reported).size(), 1u);
  EXPECT_EQ(files_of(reported)[0].file, folder_ / "sub/prog.sh");
  const std::string home = std::getenv("HOME") == nullptr ? "/" : std::getenv("HOME");
  setenv("HOME", folder_.c_str(), 1);
  EXPECT_EQ(seen("~/prog.sh"), "prog.sh;");
  setenv("HOME", home.c_str(), 1);
}

TEST(Sobol, EachDyadicIntervalHoldsItsShare) {
  for (const std::uint64_t seed : {0u, 1u, 2u})
    for (const std::uint32_t count : {16u, 64u})
      for (std::size_t d = 0; d < 4; ++d) {
        std::vector<int> in(count);
        for (std::uint32_t i = 0; i < count; ++i)
          ++in[static_cast<std::size_t>(sobol_point(i, seed)[d] * count)];
        EXPECT_EQ(in, std::vector<int>(count, 1)) << "dimension " << d << ", seed " << seed;
      }
}

TEST(Sobol, TheFirstTwoDimensionsAreANet) {
  // A (0, 6, 2)-net: each cell of an 8 x 8 grid contains one of 64 points.
  std::vector<int> in(64);
  for (std::uint32_t i = 0; i < 64; ++i) {
    const auto p = sobol_point(i, 7);
    ++in[static_cast<std::size_t>(p[0] * 8) * 8 + static_cast<std::size_t>(p[1] * 8)];
  }
  EXPECT_EQ(in, std::vector<int>(64, 1));
}

TEST_F(SuiteFile, TakesDetectorsAsLabels) {
  const Suite suite =
      load("", "[pepper.yaml]",
           "[exact, {network: nano.onnx, fill: foreground}, {network: yolo.weights, "
           "name: third, classes: my.names, confidence: 0.4}]");
  ASSERT_EQ(suite.labels.size(), 3U);
  EXPECT_EQ(name(suite.labels[1]), "nano");
  EXPECT_EQ(with_labels(suite.labels[2]), "labels from third");
  EXPECT_EQ(suite.labels[2].detector->config, folder_ / "yolo.cfg");
  EXPECT_EQ(suite.labels[2].detector->settings.confidence, 0.4);
  const std::vector<RunSpec> runs = expand(suite);
  EXPECT_EQ(runs[1].name, "semantic-nano-pepper-0");
  const RunSpec back = run_spec_from_json(to_json(runs[1]));
  EXPECT_EQ(back.labels, runs[1].labels);
  // The key depends on the contents of the files and on the settings, but not on names.
  const std::vector<InputDigest> inputs = {{"detector", 7, {}}};
  RunSpec other = runs[1];
  other.labels.called = "another";
  other.labels.detector->network = "/elsewhere/nano.onnx";
  EXPECT_EQ(run_key(other, inputs), run_key(runs[1], inputs));
  other.labels.detector->settings.fill = BoxFill::kBox;
  EXPECT_NE(run_key(other, inputs), run_key(runs[1], inputs));
}

TEST_F(SuiteFile, TakesDosesOfFaultsAsLabels) {
  const Suite suite = load("", "[pepper.yaml]",
                           "[exact, {of: exact, name: confused_25, confusion: 0.25}, "
                           "{of: boxes, name: coarse, class_set: five}]");
  ASSERT_EQ(suite.labels.size(), 3U);
  EXPECT_EQ(with_labels(suite.labels[1]), "exact labels, confused_25");
  EXPECT_EQ(with_dials({}, suite.labels[1]).labels.noise.confusion, 0.25);
  EXPECT_EQ(with_dials({}, suite.labels[2]).labels.noise.class_set, ClassSet::kFive);
  EXPECT_EQ(with_dials({}, suite.labels[0]), SensorConfig());
  const std::vector<RunSpec> runs = expand(suite);
  EXPECT_EQ(runs[1].name, "semantic-confused_25-pepper-0");
  EXPECT_EQ(run_spec_from_json(to_json(runs[1])).labels, runs[1].labels);
  RunSpec other = runs[1];
  other.labels.called = "another";
  EXPECT_EQ(run_key(other, {}), run_key(runs[1], {}));
  other.labels.dials->confusion = 0.3;
  EXPECT_NE(run_key(other, {}), run_key(runs[1], {}));
  EXPECT_NE(run_key(runs[0], {}), run_key(runs[1], {}));
}

TEST_F(SuiteFile, RefusesDetectorsThatCannotBeMeant) {
  const auto says = [&](const char* labels, const char* part) {
    const std::string text = error("", "[pepper.yaml]", labels);
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  says("[{network: a.onnx, boxes: b.json}]", "b.json) are both given: name only one");
  says("[{fill: box}]", "names neither `network` nor `boxes`");
  says("[{network: a.onnx, fil: box}]", "fil");
  says("[{network: a.onnx, fill: boxes}]", "'boxes' is not one of box, foreground");
  says("[{network: a.onnx, name: exact}]", "'exact' is a kind of labels");
  says("[{of: exact, confusion: 0.2}]", "name");
  says("[{of: none, name: a, confusion: 0.2}]", "'none' labels have no dials");
  says("[{of: exact, name: boxes, confusion: 0.2}]", "'boxes' is a kind of labels");
  says("[{of: exact, name: a, confusion: 1.2}]", "1.2");
  says("[{of: exact, name: a, confused: 0.2}]", "confused");
  says("[{of: exact, name: a}, {of: boxes, name: a}]", "'a' is listed twice");
  says("[{network: a.onnx}, {network: b/a.onnx}]", "'a' is listed twice");
}

TEST(ShippedSuites, AreWellFormed) {
  // What users set; these files do not exist here, and suites can be read without them, too.
  const std::map<std::string, SuiteOverrides> of_users = {
      {"real_detector", {.set = {{"network", "/yolox_nano.onnx"}}}},
      {"bases_recorded", {.set = {{"mapped", "/mapped"}, {"queried", "/queried"}}}},
      {"real",
       {.set = {{"recordings", "/data"}},
        .found = {{"tum:/data/rgbd_dataset_freiburg1_*",
                   {{"tum:/data/rgbd_dataset_freiburg1_desk", ""}}},
                  {"tum:/data/rgbd_dataset_freiburg2_*", {}},
                  {"tum:/data/rgbd_dataset_freiburg3_*", {}},
                  {"bonn:/data/rgbd_bonn_*", {}},
                  {"scannet:/data/scene????_??", {}}}}},
      {"table1_scannet",
       {.set = {{"scans", "/scans"}},
        .found = {{"scannet:/scans/scene????_00",
                   {{"scannet:/scans/scene0000_00", "Bedroom / Hotel"},
                    {"scannet:/scans/scene0001_00", "Lobby"},
                    {"scannet:/scans/scene0002_00", "Gym"}}}}}}};
  for (const std::string& name : shipped_names(Shipped::kSuite)) {
    const fs::path file = shipped_file(name, Shipped::kSuite);
    const auto set = of_users.find(name);
    const Suite suite = set == of_users.end()
                            ? load_suite(file)
                            : parse_suite(read_file(file), file, set->second, false);
    if (name == "table1_scannet") {
      EXPECT_EQ(suite.environments.size(), 3U);
      EXPECT_EQ(suite.environments.back().category, "misc");
      EXPECT_TRUE(suite.notes.empty());
    }
    EXPECT_GE(suite.systems.size(), 1u) << file;
    std::set<std::string> names;
    for (const RunSpec& run : expand(suite)) EXPECT_TRUE(names.insert(run.name).second) << run.name;
  }
}

TEST_F(SuiteFile, NamesGradedQueries) {
  const Suite suite =
      load("graded: {distance_m: [0, 0.4, 2], angle_deg: [0, 30, 60], speed: [1, 3]}");
  ASSERT_TRUE(suite.graded);
  EXPECT_EQ(suite.graded->distance_m, (std::vector<double>{0, 0.4, 2}));
  EXPECT_EQ(suite.graded->per_bin, 10u);
  EXPECT_EQ(suite.graded->speed, (std::vector<double>{1, 3}));
  for (const RunSpec& spec : expand(suite)) {
    EXPECT_EQ(spec.graded, suite.graded);
    EXPECT_EQ(run_spec_from_json(to_json(spec)).graded, suite.graded);
  }
  EXPECT_FALSE(load("").graded);
}

TEST_F(SuiteFile, RefusesBadGradedQueries) {
  const auto complaint = [&](const char* text) { return error(std::string("graded: ") + text); };
  EXPECT_NE(complaint("{distance_m: [0, 1]}").find("angle_deg"), std::string::npos);
  EXPECT_NE(complaint("{distance_m: [1], angle_deg: [0, 9]}").find("at least two"),
            std::string::npos);
  EXPECT_NE(complaint("{distance_m: [0, 2, 1], angle_deg: [0, 9]}").find("edges must increase"),
            std::string::npos);
  EXPECT_NE(complaint("{distance_m: [0, 1], angle_deg: [0, 200]}").find("outside [0, 180]"),
            std::string::npos);
  EXPECT_NE(complaint("{distance_m: [0, 1], angle_deg: [0, 9], speed: [0]}").find("[0.1, 10]"),
            std::string::npos);
  EXPECT_NE(complaint("{distance_m: [0, 1], angle_deg: [0, 9], per_bin: 0}").find("per_bin"),
            std::string::npos);
  EXPECT_NE(complaint("{distance_m: [0, 1], angle_deg: [0, 9], bins: 3}").find("bins"),
            std::string::npos);
}

}  // namespace
}  // namespace mh
