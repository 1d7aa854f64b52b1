// SPDX-License-Identifier: Apache-2.0
#include "bench/results/gate/gate.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "bench/results/gate/baseline.hpp"
#include "bench/results/gate/report.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

using Values = std::map<std::string, std::optional<double>, std::less<>>;

/// Five seeds of one scenario; completeness and ATE vary slightly over them.
std::vector<RunFigures> five_runs(double completeness = 0.9, double ate = 0.02) {
  std::vector<RunFigures> runs;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const double spread = 0.01 * (static_cast<double>(seed) - 2);
    runs.push_back({"corridor", "plain-pepper", seed, std::to_string(seed),
                    Values{{"completeness", completeness + spread},
                           {"offered", 200},
                           {"ate_rmse_m", ate + 0.1 * spread},
                           {"held_out.correct", 0.8},
                           {"held_out.queries", 20}}});
  }
  return runs;
}

const GateConfig kConfig{.tolerances = {{"completeness", {0.05, 0}}, {"ate_rmse_m", {0.005, 0.5}}},
                         .of_scenario = {}};

const Change& change_of(const GateResult& result, std::string_view measure) {
  for (const Change& c : result.changes)
    if (c.measure->name == measure) return c;
  throw std::runtime_error("no such measure");
}

TEST(Gate, NothingChangedPasses) {
  const GateResult result = compare(five_runs(), five_runs(), kConfig, true);
  EXPECT_TRUE(result.passed());
  EXPECT_EQ(result.runs, 5u);
  EXPECT_EQ(result.identical, 5u);
  ASSERT_EQ(result.changes.size(), 2u);  // only figures that have a tolerance are judged
  for (const Change& c : result.changes) EXPECT_EQ(c.verdict, ChangeVerdict::kSame);
}

TEST(Gate, FailsBeyondTheToleranceAndNotWithinIt) {
  const auto verdict = [](double after) {
    const GateResult r = compare(five_runs(0.9), five_runs(after), kConfig, false);
    return change_of(r, "completeness").verdict;
  };
  EXPECT_EQ(verdict(0.86), ChangeVerdict::kWithin);
  EXPECT_EQ(verdict(0.85), ChangeVerdict::kWithin);  // exactly at the tolerance
  EXPECT_EQ(verdict(0.84), ChangeVerdict::kWorse);
  EXPECT_EQ(verdict(0.94), ChangeVerdict::kWithin);
  EXPECT_EQ(verdict(0.96), ChangeVerdict::kBetter);
}

TEST(Gate, ASystemThatIsNotRepeatableIsWorseWhereChanceCannotSayWhy) {
  const auto judged = [](double after) {
    auto runs = five_runs(after);
    for (RunFigures& run : runs) run.repeatable = false, run.digest += " other bits";
    return compare(five_runs(0.9), runs, kConfig, true);
  };
  EXPECT_TRUE(judged(0.9).passed()) << "its bits differ from time to time";
  EXPECT_EQ(judged(0.9).identical, 0u);
  const auto verdict = [&](double after) {
    return change_of(judged(after), "completeness").verdict;
  };
  // The runs before and after both have a standard deviation of 0.01581, so the median of the five
  // differences has one of 1.2533 * 0.01581 * sqrt(2 / 5) = 0.01253. The tolerance of 0.05 plus
  // 1.86 times that is 0.0733.
  EXPECT_EQ(verdict(0.84), ChangeVerdict::kWithin);
  EXPECT_EQ(verdict(0.828), ChangeVerdict::kWithin);
  EXPECT_EQ(verdict(0.826), ChangeVerdict::kWorse);
  EXPECT_EQ(verdict(0.972), ChangeVerdict::kWithin);
  EXPECT_EQ(verdict(0.974), ChangeVerdict::kBetter);
  EXPECT_NEAR(change_of(judged(0.9), "completeness").detectable, 0.0838, 1e-4);
  EXPECT_NE(gate_report(judged(0.9), "s").find("not repeatable is worse where"), std::string::npos);
}

TEST(Gate, MoreErrorIsWorseAndLessIsBetter) {
  const auto verdict = [](double after) {
    const GateResult r = compare(five_runs(0.9, 0.02), five_runs(0.9, after), kConfig, false);
    return change_of(r, "ate_rmse_m").verdict;
  };
  EXPECT_EQ(verdict(0.029),
            ChangeVerdict::kWithin);  // the tolerance is half of the baseline's value
  EXPECT_EQ(verdict(0.031), ChangeVerdict::kWorse);
  EXPECT_EQ(verdict(0.009), ChangeVerdict::kBetter);
}

TEST(Gate, TakesTheMedianOfPairedChanges) {
  // Two of five seeds fail completely: the median change is still zero, whatever the mean is.
  auto after = five_runs();
  after[1].values["completeness"] = 0.0;
  after[3].values["completeness"] = 0.0;
  EXPECT_TRUE(compare(five_runs(), after, kConfig, false).passed());
  after[4].values["completeness"] = 0.0;
  EXPECT_FALSE(compare(five_runs(), after, kConfig, false).passed());
  // Runs are paired by seed, not by order: each seed loses 0.06, although the two lists have
  // different orders.
  auto shuffled = five_runs(0.84);
  std::swap(shuffled[0], shuffled[4]);
  EXPECT_NEAR(change_of(compare(five_runs(), shuffled, kConfig, false), "completeness").change,
              -0.06, 1e-12);
}

TEST(Gate, PairsByTheSeedAndNotByTheSortedValues) {
  // Seeds trade places: the sorted values are unchanged, but the median of the paired changes is
  // 0.03.
  auto before = five_runs(), after = five_runs();
  const double shift[5] = {0.03, 0.03, 0.03, -0.045, -0.045};
  for (std::size_t i = 0; i < 5; ++i)
    after[i].values["completeness"] = *before[i].values["completeness"] + shift[i];
  EXPECT_NEAR(change_of(compare(before, after, kConfig, false), "completeness").change, 0.03,
              1e-12);
}

TEST(Gate, AFigureThatIsLostIsTheWorst) {
  auto after = five_runs();
  for (std::size_t i = 0; i < 3; ++i) after[i].values["ate_rmse_m"] = std::nullopt;
  const GateResult lost = compare(five_runs(), after, kConfig, false);
  EXPECT_EQ(change_of(lost, "ate_rmse_m").verdict, ChangeVerdict::kWorse);
  EXPECT_NE(gate_report(lost, "ci").find("undetermined now"), std::string::npos);
  const GateResult gained = compare(after, five_runs(), kConfig, false);
  EXPECT_EQ(change_of(gained, "ate_rmse_m").verdict, ChangeVerdict::kBetter);
}

TEST(Gate, SaysTheSmallestChangeThatItCouldHaveSeen) {
  const GateResult r = compare(five_runs(), five_runs(), kConfig, false);
  // The standard deviation of 0.88 .. 0.92 is 0.0158; the median paired change has a standard
  // deviation that is 1.2533 sqrt(2/5) times as large.
  const double error = 1.2533 * std::sqrt(2.0 / 5) * std::sqrt(0.001 / 4);
  EXPECT_NEAR(change_of(r, "completeness").detectable, 0.05 + 0.84 * error, 1e-9);
  // Shares come in steps: with 20 queries, the first step beyond a tolerance of 0.12 is 3 of 20.
  GateConfig shares;
  shares.tolerances = {{"held_out.correct", {0.12, 0}}};
  EXPECT_NEAR(compare(five_runs(), five_runs(), shares, false).changes[0].detectable, 0.15, 1e-12);
}

TEST(Gate, AScenariosOwnToleranceStandsInThePlaceOfTheCommonOne) {
  GateConfig config = kConfig;
  config.of_scenario["corridor"]["completeness"] = {0.2, 0};
  EXPECT_TRUE(compare(five_runs(0.9), five_runs(0.8), config, false).passed());
  config.of_scenario.clear();
  config.of_scenario["kitchen"]["completeness"] = {0.2, 0};
  EXPECT_FALSE(compare(five_runs(0.9), five_runs(0.8), config, false).passed());
}

TEST(Gate, OtherBitsOfTheSameProgramOnTheSameMachineFail) {
  auto after = five_runs();
  after[2].digest = "other";
  const GateResult same = compare(five_runs(), after, kConfig, true);
  EXPECT_FALSE(same.passed());
  EXPECT_EQ(same.unrepeatable, std::vector<std::string>{"corridor plain-pepper seed 2"});
  const GateResult elsewhere = compare(five_runs(), after, kConfig, false);
  EXPECT_TRUE(elsewhere.passed());
  EXPECT_EQ(elsewhere.identical, 4u);
}

TEST(Gate, RunsThatAreMissingOnEitherSideAreAnError) {
  auto fewer = five_runs();
  fewer.pop_back();
  EXPECT_THROW(compare(five_runs(), fewer, kConfig, false), InputError);
  EXPECT_THROW(compare(fewer, five_runs(), kConfig, false), InputError);
}

TEST(GateReport, NamesWhatMovedByHowMuchAndWhere) {
  const GateResult result = compare(five_runs(0.9), five_runs(0.7), kConfig, false);
  const std::string report = gate_report(result, "ci");
  EXPECT_NE(report.find("corridor, plain-pepper: completeness fell by 0.2000 (0.9000 -> 0.7000; "
                        "tolerance 0.0500, 5 seeds)"),
            std::string::npos)
      << report;
  EXPECT_NE(report.find("ci: FAILED: 1 of 2 measures worse, 0 better"), std::string::npos);
  const auto group = report.find("\ncorridor, plain-pepper\n  ");
  EXPECT_NE(group, std::string::npos) << report;
  EXPECT_EQ(report.find("\ncorridor, plain-pepper\n", group + 1), std::string::npos)
      << "once over all its measures" << report;
  EXPECT_FALSE(gate_json(result, "ci")["passed"].get<bool>());
}

TEST(GateReport, SaysWhatHasAToleranceAndNoFigure) {
  auto before = five_runs(), after = five_runs();
  for (auto* runs : {&before, &after})
    for (RunFigures& run : *runs) run.values["ate_rmse_m"] = std::nullopt;
  const GateResult result = compare(before, after, kConfig, false);
  EXPECT_EQ(result.changes.size(), 1u);
  EXPECT_EQ(result.not_measured, std::vector<std::string>{"corridor, plain-pepper: ate_rmse_m"});
  EXPECT_TRUE(result.passed());
  EXPECT_NE(gate_report(result, "ci").find("not measured, neither before nor now"),
            std::string::npos);
  EXPECT_EQ(gate_json(result, "ci")["not_measured"].size(), 1u);
  for (auto* runs : {&before, &after})
    for (RunFigures& run : *runs) run.values.erase("ate_rmse_m");
  EXPECT_TRUE(compare(before, after, kConfig, false).not_measured.empty()) << "nobody asked";
}

TEST(GateReport, RunsThatFailedAreErrorsInJunit) {
  FailedRun run;
  run.spec.name = "room-vo-exact-0";
  run.error = "exited with \"3\"";
  const std::string xml = failures_junit(std::vector{run}, "ci");
  EXPECT_NE(xml.find("<testsuites name=\"ci\" tests=\"1\" errors=\"1\">"), std::string::npos)
      << xml;
  EXPECT_NE(xml.find("name=\"room-vo-exact-0\">"), std::string::npos) << xml;
  EXPECT_NE(xml.find("<error message=\"exited with &quot;3&quot;\"/>"), std::string::npos) << xml;
}

TEST(ChangedSettings, NameFilesAsTheyAre) {
  Baseline before, now;
  before.settings["vo"]["mine/run~1.py"] = "a";
  now.settings["vo"]["mine/run~1.py"] = "b";
  EXPECT_EQ(changed_settings(before, now),
            std::vector<std::string>{"vo/mine/run~1.py: \"a\" -> \"b\""});
}

TEST(GateReport, JunitCountsAndEscapes) {
  auto before = five_runs(0.9), after = five_runs(0.7);
  for (auto* runs : {&before, &after})
    for (RunFigures& run : *runs) run.scenario = "a<b&\"c\"";
  const std::string xml = gate_junit(compare(before, after, kConfig, true), "ci");
  EXPECT_NE(xml.find("<testsuites name=\"ci\" tests=\"3\" failures=\"1\">"), std::string::npos)
      << xml;
  EXPECT_NE(xml.find("<testsuite name=\"a&lt;b&amp;&quot;c&quot;\" tests=\"2\" failures=\"1\">"),
            std::string::npos);
  EXPECT_EQ(xml.find("a<b"), std::string::npos);
  EXPECT_NE(xml.find("<testcase classname=\"ci.repeatability\" name=\"same bits\"/>"),
            std::string::npos);
}

class BaselineFile : public testing::Test {
 protected:
  void SetUp() override {
    file_ = std::filesystem::temp_directory_path() /
            ("mh_baseline_" + std::to_string(getpid()) + ".json");
  }
  void TearDown() override { std::filesystem::remove(file_); }
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  std::filesystem::path file_;
};

TEST_F(BaselineFile, ComesBackAsItWas) {
  Baseline saved{.suite = "ci", .suite_digest = "12ab", .origin = {{"processor", "x \"y\""}}};
  saved.runs = five_runs(0.1 + 0.2);
  saved.runs[1].values["ate_rmse_m"] = std::nullopt;
  save_baseline(saved, file_);
  const Baseline read = load_baseline(file_);
  EXPECT_EQ(read.suite, "ci");
  EXPECT_EQ(read.origin, saved.origin);
  ASSERT_EQ(read.runs.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(read.runs[i].values, saved.runs[i].values);  // to the last bit
    EXPECT_EQ(run_name(read.runs[i]), run_name(saved.runs[i]));
    EXPECT_EQ(read.runs[i].digest, saved.runs[i].digest);
  }
  EXPECT_EQ(to_text(read), to_text(saved));
}

TEST_F(BaselineFile, TellsTheSettingsThatChanged) {
  Baseline saved{.suite = "ci",
                 .suite_digest = "12ab",
                 .origin = {},
                 .settings = {{"slam", {{"xi", 1.5}, {"alpha", 0.8}}}, {"vocabulary", "aa"}}};
  save_baseline(saved, file_);
  const Baseline before = load_baseline(file_);
  EXPECT_TRUE(changed_settings(before, saved).empty());
  saved.settings["slam"]["xi"] = 3.0;
  saved.settings["vo"]["./vo"] = "cc";
  EXPECT_EQ(changed_settings(before, saved),
            (std::vector<std::string>{"slam/xi: 1.5 -> 3.0", "vo/./vo: none -> \"cc\""}));
  EXPECT_TRUE(changed_settings(Baseline{}, saved).empty()) << "of an older one nothing is known";
}

TEST(GateReport, OtherSettingsAreNoLackOfRepeatability) {
  auto after = five_runs();
  after[2].digest = "other";
  GateResult result = compare(five_runs(), after, kConfig, false);
  result.changed_settings = {"slam/xi: 1.5 -> 3.0"};
  const std::string report = gate_report(result, "ci");
  EXPECT_NE(report.find("it was made with other settings\n"), std::string::npos) << report;
  EXPECT_NE(report.find("  slam/xi: 1.5 -> 3.0\n"), std::string::npos) << report;
  EXPECT_NE(report.find("ci: passed"), std::string::npos) << report;
  EXPECT_EQ(report.find("repeatable"), std::string::npos) << report;
}

TEST_F(BaselineFile, OfAnotherSuiteIsAnErrorThatSaysSo) {
  const Baseline b{.suite = "ci", .suite_digest = "12ab", .origin = {}};
  EXPECT_NO_THROW(check_suite(b, file_, "ci", "12ab"));
  EXPECT_THROW(check_suite(b, file_, "table1", "12ab"), InputError);
  EXPECT_THROW(check_suite(b, file_, "ci", "ffff"), InputError);
}

TEST_F(BaselineFile, ThatIsNoneIsAnErrorThatNamesIt) {
  EXPECT_THROW(load_baseline(file_), InputError);  // the file does not exist
  for (const char* text :
       {"", "{", "[]", "{}", R"({"format": "modelhouse-baseline-2", "runs": []})",
        R"({"format": "modelhouse-baseline-1", "suite": "ci"})",
        R"({"format": "modelhouse-baseline-1", "suite": "ci", "suite_digest": "", "origin": {},
            "runs": [{"scenario": 7}]})"}) {
    write(text);
    try {
      load_baseline(file_);
      FAIL() << text;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(file_.string()), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace mh
