// SPDX-License-Identifier: Apache-2.0
// Table and JSON of made-up episodes; every cell is known.
#include "bench/report/episodes_report.hpp"

#include <initializer_list>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/protocol/metrics/metrics_by_name.hpp"
#include "bench/report/pages/tables.hpp"
#include "bench/report/results_json.hpp"
#include "bench/results/gate/from_runs.hpp"

namespace mh {
namespace {

using Json = nlohmann::ordered_json;

EpisodeScore succeeded(std::size_t start, double time_s, double spl, double worst_m_per_s = 0) {
  return {.variant = "as_mapped",
          .start = start,
          .success = true,
          .said_arrived = true,
          .time_s = time_s,
          .located_s = 1.0,
          .spl = spl,
          .worst_contact_m_per_s = worst_m_per_s};
}

EpisodeScore failed(std::size_t start, const std::string& reason, int collisions = 0,
                    double worst_m_per_s = 0) {
  EpisodeScore score{.variant = "as_mapped", .start = start, .reason = reason, .time_s = 99};
  score.wrong_arrival = score.said_arrived = reason == "wrong_arrival";
  if (reason != "never_relocalized" && reason != "no_path") score.located_s = 2.0;
  score.collisions = collisions;
  score.worst_contact_m_per_s = worst_m_per_s;
  return score;
}

RunResult run_of(const Suite& suite, std::size_t environment, std::size_t system,
                 std::vector<EpisodeScore> scores) {
  RunResult run;
  run.spec.name = suite.systems[system].name + "-" + suite.environments[environment].name;
  run.spec.environment = suite.environments[environment];
  run.spec.system = suite.systems[system];
  run.spec.episodes = suite.episodes;
  run.episodes = std::move(scores);
  return run;
}

Suite suite_of(std::initializer_list<const char*> environments, std::size_t starts,
               std::vector<EpisodeVariant> variants) {
  Suite suite;
  suite.name = "made up";
  for (const char* name : environments) suite.environments.emplace_back().name = name;
  suite.systems = {{.kind = SystemKind::kSemantic, .name = "semantic", .outside = {}},
                   {.kind = SystemKind::kPlain, .name = "plain", .outside = {}}};
  suite.compare = {{0, 1}};
  suite.episodes = EpisodesSpec{.goals = {}, .starts = starts, .variants = std::move(variants)};
  return suite;
}

struct Made {
  Suite suite = suite_of({"kitchen", "hall"}, 3, {{}, {.name = "dim"}});
  std::vector<RunResult> runs;
};

Made two_places() {
  Made made;
  EpisodeScore dim = failed(0, "time_out");
  dim.variant = "dim";
  made.runs = {
      run_of(made.suite, 0, 0,
             {succeeded(0, 20, 0.8, 0.05), failed(1, "stuck", 2, 0.3), succeeded(2, 40, 0.5, 0.02),
              dim}),
      run_of(made.suite, 0, 1, {succeeded(0, 31, 0.5), succeeded(1, 11, 1), failed(2, "time_out")}),
      run_of(made.suite, 1, 0,
             {failed(0, "wrong_arrival"), failed(1, "never_relocalized"),
              failed(2, "stuck", 1, 0.12)}),
      // This system has no episode from the third start in the hall.
      run_of(made.suite, 1, 1, {succeeded(0, 21, 0.25), failed(1, "no_path")})};
  return made;
}

/// The lines of a text, with single spaces between words.
std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string& all = lines.emplace_back();
    for (std::string word; words >> word;) all += (all.empty() ? "" : " ") + word;
  }
  return lines;
}

TEST(EpisodesTable, EachCellStandsUnderItsHeading) {
  const Made made = two_places();
  EXPECT_EQ(
      lines_of(episodes_table(made.suite, made.runs)),
      (std::vector<std::string>{
          "", "made up: 3 kidnappings in 2 environments, the same for each system", "",
          "variant system success 95 % located median s SPL collided worst m/s wrong arrivals",
          // SPL: the sum of 1.3 is divided by all six episodes, not by the two successes; the worst
          // contact is the second one.
          "as_mapped semantic 2/6 10-70 % 5 30.0 0.22 2 0.30 1 "
          "1 never_relocalized, 2 stuck, 1 wrong_arrival",
          "as_mapped plain 3/5 23-88 % 4 21.0 0.35 0 0.00 0 1 no_path, 1 time_out",
          "dim semantic 0/1 0-79 % 1 - 0.00 0 0.00 0 1 time_out",
          "dim plain 0/0 0-100 % 0 - 0.00 0 0.00 0", "",
          // (0 - 1 + 1 - 1 + 0) / 5; there are too few places for an interval.
          "success, as_mapped: semantic - plain: -0.200 (-inf to +inf), 5 pairs, p 1.000, Holm "
          "1.000",
          // (0.3 - 1 + 0.5 - 0.25 + 0) / 5.
          "SPL, as_mapped: semantic - plain: -0.090 (-inf to +inf), 5 pairs, p 1.000, Holm 1.000",
          "", "success, dim: semantic - plain: +0.000 (-inf to +inf), 0 pairs, p 1.000, Holm 1.000",
          "SPL, dim: semantic - plain: +0.000 (-inf to +inf), 0 pairs, p 1.000, Holm 1.000"}));
}

TEST(EpisodesJson, HoldsWhatTheTableHolds) {
  const Made made = two_places();
  const Json json = episodes_json(made.suite, made.runs);
  ASSERT_EQ(json["summary"].size(), 4U);
  Json first = json["summary"][0];
  EXPECT_NEAR(first["low"], 0.09677, 1e-5);
  EXPECT_NEAR(first["high"], 0.70001, 1e-5);
  EXPECT_NEAR(first["spl"], 1.3 / 6, 1e-12);
  for (const char* known : {"low", "high", "spl"}) first.erase(known);
  EXPECT_EQ(first, Json::parse(R"({"variant": "as_mapped", "system": "semantic", "episodes": 6,
      "successes": 2, "located": 5, "median_time_s": 30.0, "collided": 2,
      "worst_contact_m_per_s": 0.3, "wrong_arrivals": 1,
      "reasons": {"never_relocalized": 1, "stuck": 2, "wrong_arrival": 1}})"));
  EXPECT_EQ(json["summary"][1]["system"], "plain");
  EXPECT_EQ(json["summary"][1]["median_time_s"], 21.0);
  EXPECT_EQ(json["summary"][1]["spl"], 0.35);
  EXPECT_EQ(json["summary"][3], Json::parse(R"({"variant": "dim", "system": "plain", "episodes": 0,
      "successes": 0, "low": 0.0, "high": 1.0, "located": 0, "median_time_s": null, "spl": 0.0,
      "collided": 0, "worst_contact_m_per_s": 0.0, "wrong_arrivals": 0, "reasons": {}})"));

  ASSERT_EQ(json["comparisons"].size(), 4U);
  EXPECT_EQ(json["comparisons"][0], Json::parse(R"({"what": "success, as_mapped: semantic - plain",
      "pairs": 5, "difference": -0.2, "low": null, "high": null, "p": 1.0, "p_holm": 1.0})"));
  EXPECT_NEAR(json["comparisons"][1]["difference"], -0.09, 1e-12);

  const Json last = run_json(made.runs[3]);
  EXPECT_EQ(last["name"], "plain-hall");
  ASSERT_EQ(last["episodes"].size(), 2U);
  EXPECT_EQ(last["episodes"][0]["spl"], 0.25);
  EXPECT_EQ(last["episodes"][0]["success"], true);
  EXPECT_EQ(last["episodes"][1]["reason"], "no_path");
  EXPECT_EQ(last["episodes"][1]["located_s"], nullptr);
}

// Six blocks of two starts: success differs in the same direction in all of them (p 2/64), SPL in
// one direction in five blocks and in the other direction in one (14/64). Holm's correction doubles
// the smaller p of the two comparisons.
TEST(EpisodesTable, StartsOfOnePlaceAreComparedInBlocksAndCorrectedByHolm) {
  const Suite suite = suite_of({"kitchen"}, 12, {{}});
  std::vector<EpisodeScore> first, second;
  for (std::size_t start = 0; start < 12; ++start) {
    const bool last_block = start >= 10;
    first.push_back(succeeded(start, 10, last_block ? 0.25 : 0.75));
    second.push_back(failed(start, "stuck"));
    second.back().spl = last_block ? 0.75 : 0.25;
  }
  const std::vector<RunResult> runs{run_of(suite, 0, 0, first), run_of(suite, 0, 1, second)};
  const std::vector<std::string> lines = lines_of(episodes_table(suite, runs));
  EXPECT_EQ(lines.at(lines.size() - 2),
            "success, as_mapped: semantic - plain: +1.000 (+1.000 to +1.000), 12 pairs, p 0.031, "
            "Holm 0.062");
  const Json spl = episodes_json(suite, runs)["comparisons"][1];
  EXPECT_EQ(spl["what"], "SPL, as_mapped: semantic - plain");
  EXPECT_NEAR(spl["difference"], 1.0 / 3, 1e-12);
  EXPECT_EQ(spl["p"], 0.21875);
  EXPECT_EQ(spl["p_holm"], 0.21875);
  EXPECT_LT(spl["low"], spl["difference"]);
  EXPECT_GT(spl["high"], spl["difference"]);
}

TEST(EpisodesMetrics, AreOfTheGate) {
  Made made = two_places();
  made.runs[0].points.resize(1);
  const RunFigures of_run = figures(made.runs[0]);
  EXPECT_EQ(of_run.values.at("episodes.count"), 4);
  EXPECT_EQ(of_run.values.at("episodes.success"), 0.5);
  EXPECT_EQ(of_run.values.at("episodes.median_s"), 30);
  ASSERT_NE(find_metric("episodes.spl"), nullptr);
  const std::string before = of_run.digest;
  made.runs[0].episodes[0].digest ^= 1;
  EXPECT_NE(figures(made.runs[0]).digest, before);
}

TEST(EpisodesJson, IsOfSuitesWithEpisodesAlone) {
  Made made = two_places();
  EXPECT_EQ(episodes_page_json(made.suite, made.runs)["rows"], 4);
  made.suite.episodes.reset();
  EXPECT_EQ(episodes_table(made.suite, made.runs), "");
  EXPECT_TRUE(episodes_page_json(made.suite, made.runs).is_null());
  made.runs[0].spec.episodes.reset();
  EXPECT_FALSE(run_json(made.runs[0]).contains("episodes"));
}

}  // namespace
}  // namespace mh
