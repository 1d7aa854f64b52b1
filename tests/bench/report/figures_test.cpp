// SPDX-License-Identifier: Apache-2.0
// Tables, JSON, CSV and LaTeX of made-up results; every cell is known and different from all
// others, so that no two of them can be swapped without a failure.
#include <unistd.h>

#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/report/export.hpp"
#include "bench/report/results_json.hpp"
#include "bench/report/results_table.hpp"
#include "bench/store/store.hpp"
#include "tests/bench/results/made_up_results.hpp"

namespace mh {
namespace {

using Cells = std::vector<std::string>;
namespace fs = std::filesystem;

// Worked out by hand. Held out, 8 queries: 6 answered, 5 correct, 1 false; mean of the distances
// 1.2 / 6 = 0.2, median (0.03 + 0.04) / 2 = 0.035; attempts 18 / 8 = 2.25; candidates 32 / 8 = 4,
// three of eight queries have one. Second tour, 5 queries: 3 answered, 2 correct, 1 false; mean
// 0.24, median 0.07; attempts 16 / 5 = 3.2; candidates 12 / 5 = 2.4, one of five queries has one.
const MadeUpFigures kSemantic = {
    .completeness = 0.875,
    .ate_m = 0.0111,
    .ate_deg = 0.75,
    .first_pose_m = 0.0222,
    .rpe_frame_m = 0.00333,
    .rpe_second_m = 0.00444,
    .restarts = 6,
    .dropped = 7,
    .held_out = {.correct = 5,
                 .distances_m = {0.01, 0.02, 0.03, 0.04, 0.1, 1.0},
                 .aligned_more_m = 0.5,
                 .attempts = {1, 1, 1, 1, 1, 3, 5, 5},
                 .final = {1, 1, 1, 4, 5, 5, 5, 10},
                 .keyframes = 120,
                 .c1 = 60,
                 .c2 = 30,
                 .c3 = 12,
                 .label_mass = 0.31,
                 .gamma = 1.75,
                 .unscored = 0.11,
                 .stale = 0.22,
                 .stale_weight = 0.33,
                 .stale_age = 4.4,
                 .unanswered = RelocalizationStage::kInliers},
    .second_tour = {.correct = 2,
                    .distances_m = {0.05, 0.07, 0.6},
                    .aligned_more_m = 0.25,
                    .attempts = {1, 2, 3, 5, 5},
                    .final = {1, 2, 3, 3, 3},
                    .keyframes = 100,
                    .c1 = 64,
                    .c2 = 32,
                    .c3 = 16,
                    .label_mass = 0.17,
                    .gamma = 0.85,
                    .unanswered = RelocalizationStage::kPnp},
    .pairs = {.compared = 1000, .penalized = 123, .rejected_by_xi = 45, .ratio_helped = 6},
    .track_ms = {1, 2, 30},
    .relocalize_ms = {4, 5, 60}};

// Held out, 8 queries: 5 answered, 2 correct, 3 false; mean 2.5 / 5 = 0.5, median 0.45; attempts 22
// / 8 = 2.75. Second tour, 5 queries: 4 answered, 1 correct, 3 false; mean 0.7, median 0.75.
const MadeUpFigures kPlain = {.completeness = 0.625,
                              .ate_m = 0.0555,
                              .ate_deg = 0.25,
                              .first_pose_m = 0.0666,
                              .rpe_frame_m = 0.00777,
                              .rpe_second_m = 0.00888,
                              .restarts = 8,
                              .dropped = 9,
                              .held_out = {.correct = 2,
                                           .distances_m = {0.06, 0.14, 0.45, 0.85, 1.0},
                                           .aligned_more_m = 0.125,
                                           .attempts = {1, 1, 1, 1, 3, 5, 5, 5},
                                           .final = {2, 2, 2, 2, 2, 2, 1, 11},
                                           .keyframes = 90,
                                           .c1 = 45,
                                           .c2 = 27,
                                           .c3 = 18,
                                           .label_mass = 0,
                                           .gamma = 0,
                                           .unanswered = RelocalizationStage::kPnp},
                              .second_tour = {.correct = 1,
                                              .distances_m = {0.1, 0.7, 0.8, 1.2},
                                              .aligned_more_m = 0.375,
                                              .attempts = {1, 1, 1, 4, 5},
                                              .final = {2, 2, 2, 2, 10},
                                              .keyframes = 80,
                                              .c1 = 56,
                                              .c2 = 40,
                                              .c3 = 24,
                                              .label_mass = 0,
                                              .gamma = 0,
                                              .unanswered = RelocalizationStage::kMatches},
                              .pairs = {},
                              .track_ms = {7, 8, 90},
                              .relocalize_ms = {10, 11, 120}};

class Figures : public testing::Test {
 protected:
  Figures() { fs::create_directories(folder_); }
  ~Figures() override { fs::remove_all(folder_); }

  static std::vector<RunResult> runs_of(const Suite& suite) {
    std::vector<RunResult> runs;
    for (const RunSpec& spec : expand(suite))
      runs.push_back(
          made_up_run(spec, spec.system.kind == SystemKind::kSemantic ? kSemantic : kPlain));
    return runs;
  }

  fs::path folder_ = fs::temp_directory_path() / ("mh_figures_" + std::to_string(getpid()));
  const Suite suite_ = (fs::create_directories(folder_), made_up_suite(folder_, {"den"}));
  const std::vector<RunResult> runs_ = runs_of(suite_);
};

/// The cells of a line, which are separated by two or more spaces.
Cells cells_of(const std::string& line) {
  static const std::regex kGap("  +");
  const std::string inside = std::regex_replace(line, std::regex("^ +| +$"), "");
  return {std::sregex_token_iterator(inside.begin(), inside.end(), kGap, -1),
          std::sregex_token_iterator()};
}

/// The cells of the next line that begins with `name`, below the line whose cells are `heading`.
Cells below(const std::string& text, const Cells& heading, const std::string& name) {
  std::istringstream lines(text);
  bool found = false;
  for (std::string line; std::getline(lines, line);) {
    const Cells cells = cells_of(line);
    if (cells == heading)
      found = true;
    else if (found && cells[0] == name)
      return cells;
  }
  return {found ? "no row of this name" : "no such heading"};
}

TEST_F(Figures, OfTheTextTableStandUnderTheirHeadings) {
  const std::string table = results_table(suite_, runs_);
  const Cells held_out = {"held out",     "success", "correct",  "false pos.", "in map",
                          "where mapped", "mean m",  "median m", "aligned m",  "attempts"};
  EXPECT_EQ(below(table, held_out, "semantic"),
            (Cells{"semantic", "75.00%", "62.50%", "12.50%", "87.50%", "71.43%", "0.2000", "0.0350",
                   "0.7000", "2.25"}))
      << table;
  EXPECT_EQ(below(table, held_out, "plain"),
            (Cells{"plain", "62.50%", "25.00%", "37.50%", "87.50%", "57.14%", "0.5000", "0.4500",
                   "0.6250", "2.75"}));
  Cells second_tour = held_out;
  second_tour[0] = "2nd tour";
  EXPECT_EQ(below(table, second_tour, "semantic"),
            (Cells{"semantic", "60.00%", "40.00%", "20.00%", "80.00%", "50.00%", "0.2400", "0.0700",
                   "0.4900", "3.20"}))
      << table;
  EXPECT_EQ(below(table, second_tour, "plain"),
            (Cells{"plain", "80.00%", "20.00%", "60.00%", "80.00%", "75.00%", "0.7000", "0.7500",
                   "1.0750", "2.40"}));
}

TEST_F(Figures, OfTheTextTablesHeadAreSuccessCorrectAndMeanDistance) {
  const std::string table = results_table(suite_, runs_);
  const std::size_t second = table.find("  second tour, 5 queries\n");
  ASSERT_NE(second, std::string::npos) << table;
  EXPECT_NE(table.find("  held-out frames (the paper's way), 8 queries\n"), std::string::npos);
  const Cells heading = {"Reloc. success (%)", "Where mapped (%)", "Correct (%)",
                         "Average distance (m)"};
  EXPECT_EQ(below(table, heading, "semantic"),
            (Cells{"semantic", "75.00", "71.43", "62.50", "0.2000"}));
  EXPECT_EQ(below(table, heading, "plain"), (Cells{"plain", "62.50", "57.14", "25.00", "0.5000"}));
  const Cells of_second = {"second tour, 5 queries"};
  EXPECT_EQ(below(table, of_second, "semantic"),
            (Cells{"semantic", "60.00", "50.00", "40.00", "0.2400"}));
  EXPECT_EQ(below(table, of_second, "plain"),
            (Cells{"plain", "80.00", "75.00", "20.00", "0.7000"}));
}

TEST_F(Figures, OfQueriesHaveNoHeadWhereNothingWasAsked) {
  std::vector<RunResult> unasked(runs_.begin(), runs_.end());
  for (RunResult& run : unasked) run.points[0] = {};
  Suite outside = suite_;
  outside.published.reset();
  const std::string table = results_table(outside, unasked);
  EXPECT_EQ(table.find("Reloc. success"), std::string::npos) << table;
  EXPECT_NE(table.find("ATE m"), std::string::npos) << table;
}

TEST_F(Figures, OfCandidatesStandUnderTheirEquations) {
  const std::string table = results_table(suite_, runs_);
  const Cells held_out = {"held out",    "keyframes",   "after eq. 3", "after eq. 4",
                          "after eq. 5", "after eq. 6", "one left",    "label mass"};
  EXPECT_EQ(below(table, held_out, "semantic"),
            (Cells{"semantic", "120", "60.00 (50.00%)", "30.00 (25.00%)", "12.00 (10.00%)",
                   "4.00 (3.33%)", "37.5%", "31.0%"}))
      << table;
  EXPECT_EQ(below(table, held_out, "plain"),
            (Cells{"plain", "90", "45.00 (50.00%)", "27.00 (30.00%)", "18.00 (20.00%)",
                   "3.00 (3.33%)", "12.5%", "0.0%"}));
  Cells second_tour = held_out;
  second_tour[0] = "2nd tour";
  EXPECT_EQ(below(table, second_tour, "semantic"),
            (Cells{"semantic", "100", "64.00 (64.00%)", "32.00 (32.00%)", "16.00 (16.00%)",
                   "2.40 (2.40%)", "20.0%", "17.0%"}));
}

TEST_F(Figures, OfMappingStandUnderTheirHeadings) {
  const std::string table = results_table(suite_, runs_);
  const Cells mapping = {"mapping",  "ATE m",   "ATE median", "ATE deg",  "first pose m",
                         "RPE m/fr", "RPE m/s", "complete",   "restarts", "dropped"};
  EXPECT_EQ(below(table, mapping, "semantic"),
            (Cells{"semantic", "0.0111", "0.0067", "0.750", "0.0222", "0.00333", "0.00444",
                   "87.50%", "6", "7"}))
      << table;
  EXPECT_EQ(below(table, mapping, "plain"), (Cells{"plain", "0.0555", "0.0333", "0.250", "0.0666",
                                                   "0.00777", "0.00888", "62.50%", "8", "9"}));
  for (const char* line : {"  semantic, held_out: unanswered, by the stage reached: 2 inliers\n",
                           "  semantic, second_tour: unanswered, by the stage reached: 2 pnp\n",
                           "  plain, held_out: unanswered, by the stage reached: 3 pnp\n",
                           "  plain, second_tour: unanswered, by the stage reached: 1 matches\n"})
    EXPECT_NE(table.find(line), std::string::npos) << line << table;
  EXPECT_TRUE(
      std::regex_search(table, std::regex("motion_model +1000 +123 \\(12\\.3%\\) +45 +6\n")))
      << table;
}

TEST_F(Figures, OfOthersStandBesideTheMeasuredAte) {
  Suite suite = suite_;
  suite.published_ate_m = {{"ORB-SLAM2", {{"den", 0.016}, {"desk", 0.022}}}, {"Another", {}}};
  for (const std::string& text : {results_table(suite, runs_), results_screen(suite, runs_)})
    EXPECT_EQ(below(text, {"ATE m", "semantic", "plain", "Another", "ORB-SLAM2"}, "den"),
              (Cells{"den", "0.0111", "0.0555", "-", "0.0160"}))
        << text;
}

// On the queries that both answer, the semantic system is closer by 0.05, 0.12, 0.42, 0.81 and 0.9:
// 2.3 / 5 = 0.46. Of eight queries, it answers one more than the plain system, and three more
// correctly.
TEST_F(Figures, OfTheComparisonAreSemanticMinusPlain) {
  const std::string table = results_table(suite_, runs_);
  for (const char* figure :
       {"success, held_out, exact labels +\\+0\\.1250 ",
        "correct, held_out, exact labels +\\+0\\.3750 ",
        "distance where both answer, m, held_out, exact labels +-0\\.4600 ",
        "success, second_tour, exact labels +-0\\.2000 ",
        "correct, second_tour, exact labels +\\+0\\.2000 ",
        // (0.05 + 0.07 + 0.6 - 0.1 - 0.7 - 0.8) / 3
        "distance where both answer, m, second_tour, exact labels +-0\\.2933 "})
    EXPECT_TRUE(std::regex_search(table, std::regex(figure))) << figure << table;
  std::map<std::string, double> differences;
  const auto json = results_json(suite_, runs_);
  for (const auto& c : json["comparisons"]) differences[c["what"]] = c["difference"];
  EXPECT_DOUBLE_EQ(differences["success, held_out, exact labels"], 0.125);
  EXPECT_DOUBLE_EQ(differences["correct, held_out, exact labels"], 0.375);
  EXPECT_NEAR(differences["distance where both answer, m, held_out, exact labels"], -0.46, 1e-12);
}

// Two rooms with the same figures, except that the plain system in the second room is as good as
// the semantic one. So the plain system's means are halfway between the systems' figures in the
// first room.
TEST_F(Figures, OfTableOneAreMeansOverScenes) {
  const Suite two = made_up_suite(folder_, {"den", "nook"});
  std::vector<RunResult> runs = runs_of(two);
  for (RunResult& run : runs)
    if (run.spec.environment.name == "nook" && run.spec.system.kind == SystemKind::kPlain)
      run = made_up_run(run.spec, kSemantic);
  const std::string table = results_table(two, runs);
  const Cells heading = {"environments",
                         "system",
                         "scenes",
                         "ATE m",
                         "RPE m/fr",
                         "complete",
                         "held out: success",
                         "correct",
                         "false pos.",
                         "where mapped",
                         "mean m",
                         "2nd tour: success",
                         "correct",
                         "false pos.",
                         "where mapped",
                         "mean m"};
  const Cells semantic = {"rooms",  "semantic", "2",      "0.0111", "0.00333", "87.50%",
                          "75.00%", "62.50%",   "12.50%", "71.43%", "0.2000",  "60.00%",
                          "40.00%", "20.00%",   "50.00%", "0.2400"};
  EXPECT_EQ(below(table, heading, "rooms"), semantic) << table;
  // The plain system's line is the next one.
  EXPECT_EQ(below(table, semantic, "rooms"),
            (Cells{"rooms", "plain", "2", "0.0333", "0.00555", "75.00%", "68.75%", "43.75%",
                   "25.00%", "64.29%", "0.3500", "70.00%", "30.00%", "40.00%", "62.50%", "0.4700"}))
      << table;
  // Each figure is a mean over two scenes, so it is half of the difference in the first room. The
  // -0.2 is for the second tour.
  for (const char* figure : {"success, held_out, exact labels +\\+0\\.0625 ",
                             "pooled success, held_out, exact labels +\\+0\\.0625 ",
                             "pooled correct, second_tour, exact labels .*10 queries of 2 scenes",
                             "correct, held_out, exact labels +\\+0\\.1875 ",
                             "false positive, held_out, exact labels +-0\\.1250 ",
                             "distance where both answer, m, held_out, exact labels +-0\\.2300 ",
                             "success, second_tour, exact labels +-0\\.1000 ",
                             "false positive, second_tour, exact labels +-0\\.2000 "})
    EXPECT_TRUE(std::regex_search(table, std::regex(figure))) << figure << table;
  const auto all = results_json(two, runs)["categories"][3];
  EXPECT_EQ(all["category"], "all");
  EXPECT_EQ(all["system"], "plain");
  EXPECT_NEAR(all["trajectory"]["ate_rmse_m"].get<double>(), 0.0333, 1e-12);
  EXPECT_NEAR(all["trajectory"]["rpe_frame_rmse_m"].get<double>(), 0.00555, 1e-12);
  EXPECT_DOUBLE_EQ(all["trajectory"]["completeness"], 0.75);
  EXPECT_DOUBLE_EQ(all["held_out"]["correct"], 0.4375);
  EXPECT_DOUBLE_EQ(all["second_tour"]["correct"], 0.3);
}

TEST_F(Figures, OfTheTimesStandUnderTheirHeadings) {
  const std::string table = times_table(suite_, runs_);
  const Cells heading = {"wall time, ms per call: median (p95)", "track", "relocalize"};
  // Only the median is compared: the 95th percentile of three values depends on the interpolation.
  EXPECT_EQ(below(table, heading, "den, semantic, exact labels")[1].substr(0, 4), "2.0 ") << table;
  EXPECT_EQ(below(table, heading, "den, semantic, exact labels")[2].substr(0, 4), "5.0 ") << table;
  EXPECT_EQ(below(table, heading, "den, plain")[1].substr(0, 4), "8.0 ") << table;
  EXPECT_EQ(below(table, heading, "den, plain")[2].substr(0, 5), "11.0 ") << table;
}

/// Rounds numbers to 12 digits, so that 0.1 + 0.2 equals 0.3.
nlohmann::json rounded(const nlohmann::ordered_json& json) {
  nlohmann::json flat = nlohmann::json::parse(json.dump()).flatten();
  for (auto& value : flat)
    if (value.is_number()) value = std::stod(fmt::format("{:.12g}", value.get<double>()));
  return flat.unflatten();
}

TEST_F(Figures, OfTheJsonsRowsHaveTheirNames) {
  const auto json = results_json(suite_, runs_);
  ASSERT_EQ(json["rows"].size(), 2u);
  const nlohmann::json semantic = rounded(json["rows"][0]), plain = rounded(json["rows"][1]);
  EXPECT_EQ(semantic["system"], "semantic");
  EXPECT_EQ(semantic["trajectory"],
            nlohmann::json::parse(R"({"completeness": 0.875, "in_any_map": 0.9375,
      "ate_rmse_m": 0.0111, "ate_median_m": 0.00666, "ate_rmse_deg": 0.75, "ate_first_pose_m": 0.0222, "rpe_frame_rmse_m": 0.00333,
      "rpe_second_rmse_m": 0.00444, "offered": 1000.0, "tracked": 875.0,
      "scored": 874.125})"));
  EXPECT_EQ(semantic["mapping"], nlohmann::json::parse(R"({"failures": 0.0, "restarts": 6.0,
      "dropped": 7.0, "penalized": null})"));
  EXPECT_EQ(semantic["held_out"], nlohmann::json::parse(R"({"queries": 8.0, "success": 0.75,
      "correct": 0.625, "false_positive": 0.125, "in_map": 0.875, "success_in_map": 0.714285714286, "distance_mean_m": 0.2, "distance_median_m": 0.035,
      "aligned_distance_mean_m": 0.7, "attempts": 2.25, "candidates": {"keyframes": 120.0,
      "c1": 60.0, "c2": 30.0, "c3": 12.0, "final": 4.0, "single": 0.375, "label_mass": 0.31,
      "gamma": 1.75, "unscored": 0.11, "stale": 0.22, "stale_weight": 0.33, "stale_age": 4.4}})"));
  EXPECT_EQ(semantic["second_tour"], nlohmann::json::parse(R"({"queries": 5.0, "success": 0.6,
      "correct": 0.4, "false_positive": 0.2, "in_map": 0.8, "success_in_map": 0.5, "distance_mean_m": 0.24, "distance_median_m": 0.07,
      "aligned_distance_mean_m": 0.49, "attempts": 3.2, "candidates": {"keyframes": 100.0,
      "c1": 64.0, "c2": 32.0, "c3": 16.0, "final": 2.4, "single": 0.2, "label_mass": 0.17,
      "gamma": 0.85, "unscored": null, "stale": null, "stale_weight": null,
      "stale_age": null}})"));
  EXPECT_EQ(semantic["matchers"]["motion_model"],
            nlohmann::json::parse(R"({"compared": 1000, "penalized": 123, "rejected_by_xi": 45,
      "ratio_helped": 6})"));
  EXPECT_EQ(plain["held_out"]["correct"], 0.25);
  EXPECT_EQ(plain["second_tour"]["correct"], 0.2);
}

TEST_F(Figures, OfTheJsonsRunsHaveTheirNames) {
  const nlohmann::json run = rounded(results_json(suite_, runs_)["runs"][0]);
  EXPECT_EQ(run["trajectory"],
            nlohmann::json::parse(R"({"completeness": 0.875, "in_any_map": 0.9375,
      "ate_rmse_m": 0.0111, "ate_median_m": 0.00666, "ate_rmse_deg": 0.75, "ate_first_pose_m": 0.0222, "rpe_frame_rmse_m": 0.00333,
      "rpe_second_rmse_m": 0.00444, "offered": 1000.0, "tracked": 875.0,
      "scored": 874.125})"));
  EXPECT_EQ(run["points"][0]["held_out"].size(), 8u);
  EXPECT_EQ(run["points"][0]["second_tour"].size(), 5u);
  nlohmann::json query = run["points"][0]["held_out"][5];  // a false answer
  for (const char* pose : {"truth", "estimate"}) query.erase(pose);
  EXPECT_EQ(query, nlohmann::json::parse(R"({"frame": 179, "stamp_ns": 179, "success": true,
      "correct": false, "false_positive": true, "in_map": true, "map": 0, "stage": "verified", "attempts": 3, "blank_frames": 0,
      "distance_m": 1.0, "angle_deg": 10.0, "aligned_distance_m": 1.5, "candidates":
      {"keyframes": 120, "c1": 60, "c2": 30, "c3": 12, "final": 5, "label_mass": 0.31, "gamma": 1.75,
      "unscored": 0.11, "stale": 0.22, "stale_weight": 0.33, "stale_age": 4.4},
      "grade": {"mapped_m": null, "mapped_deg": null, "shown": null, "speed": null}})"));
}

/// A results file with the made-up results, as the bench writes it.
Store stored(const fs::path& folder, const Suite& suite, const std::vector<RunResult>& runs) {
  Store store(folder / "r.sqlite");
  std::vector<std::pair<std::string, std::string>> plan;
  for (const RunResult& run : runs) plan.emplace_back(run.spec.name, "key of " + run.spec.name);
  store.plan(suite, {}, plan);
  for (const RunResult& run : runs) store.put("key of " + run.spec.name, run, {});
  return store;
}

Cells split(const std::string& line, const std::string& by) {
  const std::regex gap(by);
  return {std::sregex_token_iterator(line.begin(), line.end(), gap, -1),
          std::sregex_token_iterator()};
}

TEST_F(Figures, OfTheCsvStandUnderTheirHeadings) {
  std::istringstream lines(export_csv(stored(folder_, suite_, runs_)));
  std::string line;
  std::getline(lines, line);
  const Cells heading = split(line, ",");
  std::getline(lines, line);
  const Cells row = split(line, ",");
  std::map<std::string, std::string> cell;
  for (std::size_t c = 0; c < heading.size(); ++c) cell[heading[c]] = c < row.size() ? row[c] : "";
  ASSERT_GT(heading.size(), 2u);
  EXPECT_EQ(heading[0], "run");
  EXPECT_EQ(heading[1], "environment");
  EXPECT_EQ(row[0], runs_[0].spec.name);
  EXPECT_EQ(cell["system"], "semantic");
  for (const auto& [name, value] :
       std::map<std::string, double>{{"ate_rmse_m", 0.0111},
                                     {"ate_median_m", 0.00666},
                                     {"ate_rmse_deg", 0.75},
                                     {"ate_first_pose_m", 0.0222},
                                     {"rpe_frame_rmse_m", 0.00333},
                                     {"rpe_second_rmse_m", 0.00444},
                                     {"completeness", 0.875},
                                     {"in_any_map", 0.9375},
                                     {"restarts", 6},
                                     {"dropped", 7},
                                     {"held_out.queries", 8},
                                     {"held_out.success", 0.75},
                                     {"held_out.correct", 0.625},
                                     {"held_out.false_positive", 0.125},
                                     {"held_out.distance_mean_m", 0.2},
                                     {"held_out.distance_median_m", 0.035},
                                     {"held_out.candidates.final", 4},
                                     {"held_out.candidates.label_mass", 0.31},
                                     {"second_tour.queries", 5},
                                     {"second_tour.success", 0.6},
                                     {"second_tour.correct", 0.4},
                                     {"second_tour.false_positive", 0.2},
                                     {"second_tour.distance_mean_m", 0.24},
                                     {"second_tour.distance_median_m", 0.07},
                                     {"second_tour.candidates.final", 2.4},
                                     {"second_tour.candidates.label_mass", 0.17}})
    EXPECT_NEAR(std::stod("0" + cell[name]), value, 1e-12) << name << " is " << cell[name];
}

TEST_F(Figures, OfTheLatexTableStandUnderTheirHeadings) {
  std::istringstream lines(export_latex(stored(folder_, suite_, runs_)));
  std::vector<Cells> rows;
  for (std::string line; std::getline(lines, line);)
    if (line.find(" & ") != std::string::npos)
      rows.push_back(split(line.substr(0, line.rfind(" \\\\")), " & "));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0],
            (Cells{"environment", "level", "labels", "system", "trials", "ATE m", "RPE m/fr",
                   "complete", "query set", "queries per environment", "success (\\%)",
                   "success where mapped (\\%)", "correct (\\%)", "false pos. (\\%)",
                   "mean distance (m)", "median distance (m)", "attempts"}));
  EXPECT_EQ(rows[1], (Cells{"den", "pepper", "exact", "semantic", "1", "0.0111", "0.00333",
                            "87.50\\,\\%", "held\\_out", "8.0", "75.00", "71.43", "62.50", "12.50",
                            "0.2000", "0.0350", "2.25"}));
  EXPECT_EQ(rows[2], (Cells{"den", "pepper", "exact", "semantic", "1", "0.0111", "0.00333",
                            "87.50\\,\\%", "second\\_tour", "5.0", "60.00", "50.00", "40.00",
                            "20.00", "0.2400", "0.0700", "3.20"}));
  EXPECT_EQ(rows[3], (Cells{"den", "pepper", "exact", "plain", "1", "0.0555", "0.00777",
                            "62.50\\,\\%", "held\\_out", "8.0", "62.50", "57.14", "25.00", "37.50",
                            "0.5000", "0.4500", "2.75"}));
  EXPECT_EQ(rows[4][12], "20.00");
}

TEST_F(Figures, OfALatexTableHaveNamesThatLatexCanTypeset) {
  const fs::path file = folder_ / "made_up.yaml";
  made_up_suite(folder_, {"den_\\~^<|> 45° Bürö 漢&%$#"});
  std::string text = read_file(file);
  const std::string_view labels = "[exact]";
  text.replace(text.find(labels), labels.size(),
               "[{of: exact, name: confused_25, confusion: 0.25}]");
  const Suite named = parse_suite(text, file, {}, false);
  const std::string table = export_latex(stored(folder_, named, runs_of(named)));
  const std::string row =
      "den\\_\\textbackslash{}\\textasciitilde{}\\textasciicircum{}\\textless{}\\textbar{}"
      "\\textgreater{} 45$^\\circ$ Bürö [U+6F22]\\&\\%\\$\\# & pepper & confused\\_25 & semantic "
      "& ";
  EXPECT_NE(table.find(row), std::string::npos) << table;
}

}  // namespace
}  // namespace mh
