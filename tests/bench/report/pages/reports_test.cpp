// SPDX-License-Identifier: Apache-2.0
// What `modelhouse report` writes: data equal to the results, and text that remains text.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/report/pages/page_table.hpp"
#include "bench/report/pages/place_images.hpp"
#include "bench/report/pages/plot.hpp"
#include "bench/report/pages/tables.hpp"
#include "bench/report/pages/verdict.hpp"
#include "bench/report/pages/write.hpp"
#include "scenes/recordings/sequence_writer.hpp"
#include "slam/config/slam.hpp"
#include "slam/io/temporary_folder.hpp"
#include "source_dir.hpp"
#include "tests/bench/report/pages/made_up_reports.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kHostile = "<img src=x onerror=alert(1)>";

/// A piece of data as a page receives it.
Json piece(const fs::path& report, const std::string& name) {
  std::string file = name + ".js";
  std::ranges::replace(file, '/', '-');
  const std::string text = read_file(report / "data" / file);
  const auto from = text.find("]=");
  EXPECT_TRUE(text.starts_with("(globalThis.modelhouse?\?={})[")) << text.substr(0, 80);
  return Json::parse(text.substr(from + 2, text.rfind(';') - from - 2));
}

/// A table stored by columns, read as text and as numbers.
struct ReadTable {
  const Json& json;
  const Json& column(const std::string& key) const {
    for (const Json& c : json.at("columns"))
      if (c.at("key") == key) return c;
    throw std::out_of_range(key);
  }
  std::string text(const std::string& key, std::size_t row) const {
    const Json& c = column(key);
    const Json& value = c.at("values").at(row);
    return value.is_null() ? "" : c.at("words").at(value.get<std::size_t>()).get<std::string>();
  }
  Json number(const std::string& key, std::size_t row) const {
    return column(key).at("values").at(row);
  }
};

class Reports : public testing::Test {
 protected:
  PagesSource source_of_suite(const Suite& suite, std::size_t frames = 120,
                              std::size_t queries = 8) const {
    PagesSource source{.name = suite.name, .folder = {}};
    source.suite = suite;
    source.results.runs = made_up_runs(suite, frames, queries);
    put_costs(source);
    return source;
  }
  /// @param environments  all in one category
  PagesSource source_of(const std::vector<std::string>& environments) const {
    return source_of_suite(made_up_suite(work_.path(), environments));
  }
  /// 201 environments, two systems, ten trials.
  PagesSource large_study() const {
    std::vector<std::string> names;
    for (int i = 0; i < 201; ++i) names.push_back(fmt::format("room-{}", i));
    Suite suite = made_up_suite(work_.path(), names);
    suite.trials = 10;
    return source_of_suite(suite, 60, 10);
  }
  /// A suite with a sweep over two query settings, or over `parameters`.
  Suite sweep(const std::string& parameters =
                  "map: fixed, semantics.gamma: [0, 0.5, 1, 2], "
                  "semantics.xi: [1, 1.5, 2]") const {
    const fs::path file = work_.path() / "sweep.yaml";
    write_atomically(file,
                     "environments:\n- {name: den, category: rooms, scene: d.yaml, "
                     "mapping_tour: t.yaml}\nrobot: r.yaml\nvocabulary: v.mhvoc\n"
                     "levels: [pepper.yaml]\nsystems: [semantic, plain]\nlabels: [exact]\n"
                     "parameters: {" +
                         parameters + "}\n");
    return parse_suite(read_file(file), file, {}, false);
  }

  fs::path out() const { return work_.path() / "report"; }

  TemporaryFolder work_{fs::temp_directory_path()};
};

TEST_F(Reports, TheCommittedBundleIsOfItsSources) {
  const std::string digest = digest_of_web(fs::path(MH_SOURCE_DIR) / "bench/report/web");
  for (const char* file : {"app.js", "replay.js"}) {
    const std::string text =
        read_file(fs::path(MH_SOURCE_DIR) / "bench/report/pages/bundle" / file);
    EXPECT_NE(text.find("// sources: " + digest + "\n"), std::string::npos)
        << file << ": run `npm ci && npm run build` in bench/report/web and commit the bundle";
  }
}

TEST_F(Reports, OpenWithoutANetworkAndRunOnlyTheirOwnScripts) {
  const std::string index = read_file(bundle_folder() / "index.html");
  EXPECT_NE(index.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(index.find("unsafe"), std::string::npos);
  for (const char* file : {"index.html", "app.css"}) {
    const std::string text = read_file(bundle_folder() / file);
    EXPECT_EQ(text.find("http:"), std::string::npos) << file;
    EXPECT_EQ(text.find("https:"), std::string::npos) << file;
  }
}

TEST_F(Reports, HoldTheFiguresOfTheirResults) {
  PagesSource source = source_of({"den", "hall"});
  source.suite->published = Published::kTable2;
  const WrittenPages written = write_pages(out(), std::array{source});
  EXPECT_TRUE(fs::exists(written.index));
  const Json json = piece(out(), "0/runs");
  const ReadTable runs{json};
  ASSERT_EQ(json.at("rows"), source.results.runs.size());
  for (std::size_t i = 0; i < source.results.runs.size(); ++i) {
    const RunResult& run = source.results.runs[i];
    EXPECT_EQ(runs.text("run", i), run.spec.name);
    EXPECT_EQ(runs.text("system", i), run.spec.system.name);
    EXPECT_NEAR(runs.number("ate_rmse_m", i).get<double>(), *run.trajectory.ate_rmse_m, 1e-6);
    EXPECT_EQ(runs.number("wall_s", i), source.cost_of.at(run.spec.name).wall_s);
  }
  const Json query_json = piece(out(), "0/queries");
  const ReadTable queries{query_json};
  EXPECT_EQ(query_json.at("rows"), 8 * source.results.runs.size());
  std::size_t correct = 0, expected = 0;
  for (std::size_t row = 0; row < 8 * source.results.runs.size(); ++row)
    correct += queries.text("outcome", row) == "correct" ? 1 : 0;
  for (const RunResult& run : source.results.runs)
    for_each_query(run, [&](const QueryScore& q) { expected += q.correct ? 1 : 0; });
  EXPECT_EQ(correct, expected);
  const Json overview = piece(out(), "0/overview");
  const Json table2 = overview.at("table2");
  EXPECT_EQ(ReadTable{table2}.text("query_set", 2), "published, other data");
  EXPECT_EQ(ReadTable{table2}.number("success", 3), 0.7143);
}

TEST_F(Reports, OfAResultsFileShowEstimatesInTheFrameOfTheTruth) {
  const PagesSource made = source_of({"den"});
  const fs::path folder = work_.path() / "results";
  fs::create_directories(folder);
  {
    Store store(folder / "results.sqlite");
    std::vector<std::pair<std::string, std::string>> keys;
    for (const RunResult& run : made.results.runs)
      keys.emplace_back(run.spec.name, "key-" + run.spec.name);
    store.plan(*made.suite, {}, keys);
    for (const RunResult& run : made.results.runs)
      store.put("key-" + run.spec.name, run, {.wall_s = 12.5, .max_rss_mb = 99});
  }
  const PagesSource read = read_source(folder);
  ASSERT_EQ(read.problem, "");
  write_pages(out(), std::array{read});
  const Json run = piece(out(), "0/paths0").at(0);
  ASSERT_EQ(run.at("truth").at("mm").size(), run.at("estimate").at("mm").size());
  for (std::size_t i = 0; i < run.at("truth").at("mm").size(); ++i)  // the drift is 20 mm
    EXPECT_NEAR(run.at("truth").at("mm").at(i).get<int>(),
                run.at("estimate").at("mm").at(i).get<int>(), 50);
  const Trajectory& truth = read.results.runs.front().truth;
  ASSERT_EQ(run.at("truth").at("turn").size(), 4 * truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Quaterniond turn = truth[i].world_from_camera.quaternion();
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(run.at("truth").at("turn").at(4 * i + k).get<double>(),
                  1e4 * turn.coeffs()[static_cast<Eigen::Index>(k)], 1);
  }
  const Json curve = piece(out(), "0/figures").at("by_frame");
  for (std::size_t row = 0; row < curve.at("rows"); ++row)
    EXPECT_LT(ReadTable{curve}.number("error_m", row).get<double>(), 0.02);
  EXPECT_EQ(ReadTable{piece(out(), "0/runs")}.number("wall_s", 0), 12.5);
}

TEST_F(Reports, StateTheVerdictInAPlainSentenceWithItsFigures) {
  const PagesSource source = source_of({"a", "b", "c", "d", "e", "f"});
  write_pages(out(), std::array{source});
  const Json lines = piece(out(), "0/overview").at("verdicts").at("headlines");
  ASSERT_EQ(lines.size(), 1U);
  // In each environment, semantic has one more correct answer than plain: 6 pairs of the same sign.
  const auto text = lines[0].at("text").get<std::string>();
  EXPECT_TRUE(text.starts_with("Labels: no difference shown between semantic and plain.")) << text;
  const auto detail = lines[0].at("detail").get<std::string>();
  EXPECT_TRUE(detail.starts_with("Correct, held out, exact labels: ")) << detail;
  for (const char* part : {"95 % interval", "6 environments"})
    EXPECT_NE(detail.find(part), std::string::npos) << detail;
}

/// Makes all answers of a system false: every query returns a pose that is 2.57 m off.
void answer_all_falsely(RunResult& run) {
  for (PointResult& point : run.points)
    for (QueryScore& q : point.held_out) {
      q.success = q.false_positive = true;
      q.correct = false;
      q.distance_m = 2.57;
    }
}

TEST_F(Reports, AProgramWhosePosesAreWrongWinsNothingByReturningThem) {
  std::vector<std::string> names;
  for (int i = 0; i < 12; ++i) names.push_back(fmt::format("room-{}", i));
  PagesSource source = source_of(names);
  const auto verdict_of = [&] {
    write_pages(out(), std::array{source});
    const Json overview = piece(out(), "0/overview");
    return std::pair(overview.at("verdicts").at("headlines").at(0), overview.at("tiles"));
  };
  for (RunResult& run : source.results.runs)
    if (run.spec.system.name == "semantic") answer_all_falsely(run);
  const auto [line, json] = verdict_of();
  const auto text = line.at("text").get<std::string>();
  EXPECT_TRUE(line.at("decided").get<bool>());
  EXPECT_TRUE(text.starts_with("plain is better than semantic: ")) << text;
  EXPECT_NE(text.find(" points more correct answers held out"), std::string::npos) << text;
  const ReadTable tiles{json};
  ASSERT_EQ(json.at("rows"), 2);
  EXPECT_EQ(tiles.text("system", 0), "semantic");
  EXPECT_EQ(tiles.number("held_out.correct", 0), 0);
  EXPECT_EQ(tiles.number("held_out.success", 0), 1);
  // If a suite specifies success as its measure, the verdict is about success.
  source.suite->measure = Measure::kSuccess;
  const auto by_success = verdict_of().first.at("text").get<std::string>();
  EXPECT_TRUE(by_success.starts_with("semantic ")) << by_success;
  EXPECT_NE(by_success.find(" points more answers held out"), std::string::npos) << by_success;
}

TEST_F(Reports, TellAnAteThatIsFarAboveTheOthersThoughOneHouseDecidesNothing) {
  PagesSource source = source_of({"den"});
  for (RunResult& run : source.results.runs)
    if (run.spec.system.name == "semantic")
      for (std::size_t i = 0; i < run.estimate.size(); ++i)
        run.estimate[i].world_from_camera =
            SE3(Eigen::Matrix3d::Identity(), {i % 2 == 0 ? 0.2 : -0.2, 0, 0}) *
            run.estimate[i].world_from_camera;
  write_pages(out(), std::array{source});
  const Json overview = piece(out(), "0/overview");
  const auto text = overview.at("verdicts").at("headlines").at(0).at("text").get<std::string>();
  EXPECT_NE(text.find("The ATE of semantic is "), std::string::npos) << text;
  EXPECT_NE(text.find(" times that of plain: 20"), std::string::npos) << text;
  const ReadTable tiles{overview.at("tiles")};
  EXPECT_EQ(tiles.number("ate_rmse_m", 0),
            page_number(source.results.runs[0].trajectory.ate_rmse_m));
  EXPECT_EQ(tiles.number("completeness", 1), 0.97);
  EXPECT_EQ(tiles.number("track_ms", 0), 12) << "the median of 10, 12 and 31";
}

TEST_F(Reports, NoSentenceBeginsWithUndecided) {
  write_pages(out(), std::array{source_of({"a", "b", "c", "d", "e", "f"})});
  EXPECT_EQ(read_file(out() / "data/0-overview.js").find("Undecided"), std::string::npos);
}

TEST_F(Reports, HowFiguresWereMadeIsNoWarning) {
  const PagesSource source = source_of({"den"});
  write_pages(out(), std::array{source});
  const Json overview = piece(out(), "0/overview");
  EXPECT_TRUE(overview.at("warnings").empty()) << overview.at("warnings").dump();
  EXPECT_NE(overview.at("notes").dump().find("docs/slam.md"), std::string::npos);
}

TEST_F(Reports, ShowThePlanThatBenchDrewOrElseThePaths) {
  PagesSource source = source_of({"den"});
  write_pages(out(), std::array{source});
  Json place = piece(out(), "0/place");
  EXPECT_TRUE(place.at("plans").empty());
  EXPECT_EQ(place.at("run").at("name"), source.results.runs.front().spec.name);
  EXPECT_EQ(place.at("queries").at("rows"), 8);
  source.folder = work_.path() / "results";
  for (const RunResult& run : source.results.runs) {
    fs::create_directories(source.folder / run.spec.name);
    write_atomically(source.folder / run.spec.name / "topdown.png", "\x89PNG of held out");
  }
  const std::string first = source.results.runs.front().spec.name;
  write_atomically(source.folder / first / "topdown_second_tour.png", "\x89PNG of the second");
  write_pages(out(), std::array{source});
  place = piece(out(), "0/place");
  ASSERT_EQ(place.at("plans").size(), 2U) << "one of each system";
  EXPECT_EQ(place.at("plans").at(0).at("png"), base64("\x89PNG of the second"));
  EXPECT_EQ(place.at("plans").at(1).at("system"), "plain");
  EXPECT_TRUE(place.at("run").is_null());
  write_atomically(source.folder / first / "topdown_second_tour.png", "no image");
  write_pages(out(), std::array{source});
  EXPECT_EQ(piece(out(), "0/place").at("plans").at(0).at("png"), base64("\x89PNG of held out"));
  // Files of a map that a different run wrote.
  write_atomically(source.folder / first / "map.yaml", "image: map.pgm\n");
  write_pages(out(), std::array{source});
  EXPECT_EQ(piece(out(), "0/place").at("plans").size(), 1U);
}

TEST_F(Reports, OfARecordingShowSomeOfItsFramesOrSayWhyNot) {
  Camera camera;
  camera.width_px = 64;
  camera.height_px = 48;
  camera.fx_px = camera.fy_px = 60;
  camera.cx_px = 31.5;
  camera.cy_px = 23.5;
  const auto writer = make_sequence_writer("tum", work_.path() / "office", camera);
  for (std::size_t i = 0; i < 7; ++i) {
    ExactFrame frame;
    frame.seen.stamp_ns = static_cast<Stamp>(i) * 33'333'333;
    frame.seen.color = Grid2d<Rgb8>(64, 48, Rgb8{static_cast<std::uint8_t>(30 * i), 90, 20});
    frame.seen.depth_m = Grid2d<float>(64, 48, 2.0F);
    frame.classes = Grid2d<ClassId>(64, 48, kVoid);
    frame.instances = Grid2d<InstanceId>(64, 48, InstanceId{});
    writer->add(i, frame);
  }
  writer->finish();
  const fs::path file = work_.path() / "office.yaml";
  write_atomically(file,
                   "environments:\n- {category: office, sequence: 'tum:office'}\n"
                   "vocabulary: v.mhvoc\nsystems: [semantic, plain]\nlabels: [none]\n");
  PagesSource source = source_of_suite(parse_suite(read_file(file), file, {}, false));
  source.frames = frames_json(source);
  write_pages(out(), std::array{source});
  Json frames = piece(out(), "0/place").at("frames");
  EXPECT_TRUE(frames.at("problem").is_null()) << frames.at("problem").dump();
  ASSERT_EQ(frames.at("list").size(), 4U);
  EXPECT_EQ(frames.at("list").at(0).at("frame"), 0);
  EXPECT_EQ(frames.at("list").at(3).at("frame"), 6);
  EXPECT_NE(frames.at("list").at(0).at("jpeg"), frames.at("list").at(3).at("jpeg"));
  // If the results were made from a different recording of this name, no frame is shown.
  RunResult run;
  run.spec.environment.name = source.suite->environments.front().name;
  run.place.inputs = {{"sequence", 1, {}}};
  source.results.runs = {run};
  frames = frames_json(source);
  EXPECT_TRUE(frames.at("list").empty());
  EXPECT_EQ(frames.at("problem"), "has changed since these results were made");
  source.results.runs.clear();
  fs::remove_all(work_.path() / "office");  // as on another machine
  frames = frames_json(source);
  EXPECT_TRUE(frames.at("list").empty());
  EXPECT_FALSE(frames.at("problem").is_null());
  EXPECT_TRUE(frames_json(source_of({"den"})).is_null());
}

TEST_F(Reports, Figure4OfARecordingIsOverTruthAtOtherMomentsThanItsFrames) {
  PagesSource source = source_of({"den"});
  for (RunResult& run : source.results.runs) {
    // Ground truth from motion capture has three poses per frame, none at a frame's timestamp.
    const Trajectory frames = run.truth;
    run.truth.clear();
    for (std::size_t i = 0; i + 1 < frames.size(); ++i)
      for (const int k : {1, 11, 21})
        run.truth.push_back({frames[i].stamp_ns + k * 1'000'000, frames[i].world_from_camera});
    run.alignment = align_estimate(run.estimate, frames);
  }
  write_pages(out(), std::array{source});
  const Json curve = piece(out(), "0/figures").at("by_frame");
  ASSERT_EQ(curve.at("rows"), 8) << "120 frames in windows of 30, of two systems";
  EXPECT_EQ(ReadTable{curve}.number("frame", 3), 105);
  for (std::size_t row = 0; row < curve.at("rows"); ++row)
    EXPECT_LT(ReadTable{curve}.number("error_m", row).get<double>(), 0.2);
}

TEST_F(Reports, ThePapersFiguresStandWhereASuiteNamesThem) {
  PagesSource source = source_of({"den"});
  const auto has_paper = [&] {
    write_pages(out(), std::array{source});
    const std::string text = read_file(out() / "data/0-overview.js");
    EXPECT_EQ(
        text.find("the paper's system") != std::string::npos,
        read_file(out() / "data/0-figures.js").find("the paper's system") != std::string::npos);
    return text.find("0.7925") != std::string::npos;
  };
  EXPECT_FALSE(has_paper());
  source.suite->published = Published::kTable2;
  EXPECT_TRUE(has_paper());
}

TEST_F(Reports, ComparisonsAreInPercentagePointsAndMillimetersAsTheirSentencesAre) {
  write_pages(out(), std::array{source_of({"a", "b", "c", "d", "e", "f"})});
  const Json verdicts = piece(out(), "0/overview").at("verdicts");
  const Json& differences = verdicts.at("differences");
  const ReadTable table{verdicts.at("table")};
  ASSERT_EQ(table.json.at("rows"), differences.size());
  std::set<std::string> units;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const bool share = differences[i].at("unit") == "%";
    units.insert(table.text("unit", i));
    EXPECT_EQ(table.text("unit", i), share ? "points" : "mm");
    EXPECT_NEAR(table.number("difference", i).get<double>(),
                (share ? 100 : 1000) * differences[i].at("difference").get<double>(), 1e-3);
  }
  EXPECT_EQ(units.size(), 2u);
}

TEST_F(Reports, WrittenAgainLeaveForeignFilesAlone) {
  write_pages(out(), std::array{source_of({"den"}), source_of({"hall"})});
  write_atomically(out() / "data/mine.csv", "a,b\n");
  write_atomically(out() / "data/own.js", "alert(1)");
  fs::create_directories(out() / "data/folder");
  EXPECT_TRUE(fs::exists(out() / "data/1-runs.js"));
  write_pages(out(), std::array{source_of({"den"})});
  EXPECT_FALSE(fs::exists(out() / "data/1-runs.js")) << "of the earlier report";
  for (const char* name : {"mine.csv", "own.js", "folder"})
    EXPECT_TRUE(fs::exists(out() / "data" / name)) << name;
}

TEST_F(Reports, CurvesEndWhereFewEnvironmentsAreLeft) {
  PagesSource source = source_of({"a", "b", "c", "d", "e", "f"});
  // Two of the plain system's tours are cut to half their length.
  int shortened = 0;
  for (RunResult& run : source.results.runs) {
    if (run.spec.system.sees_labels() || shortened == 2) continue;
    run.truth.resize(run.truth.size() / 2);
    run.estimate.resize(run.estimate.size() / 2);
    ++shortened;
  }
  write_pages(out(), std::array{source});
  const Json json = piece(out(), "0/figures").at("by_frame");
  const ReadTable curve{json};
  std::size_t ended = 0;
  for (std::size_t row = 0; row < json.at("rows"); ++row) {
    const bool few = curve.number("scenes", row) == 4;
    ended += few ? 1 : 0;
    EXPECT_EQ(curve.number("error_m", row).is_null(), few);
    EXPECT_EQ(curve.number("low", row).is_null(), few);
  }
  EXPECT_EQ(ended, 2u);
}

TEST_F(Reports, DrawAnswersAsFarFromTheTruthAsTheyWereScored) {
  const PagesSource source = source_of({"den"});
  RunResult run = source.results.runs.front();
  const SE3 answer =
      run.estimate[40].world_from_camera * SE3(Eigen::Matrix3d::Identity(), {0.3, 0.1, 0});
  const QueryMoment moment(run.truth[45].stamp_ns, run.truth[45].world_from_camera);
  const auto anchor = find_anchor(run.estimate, run.truth, moment, NearestBy::kPlace, {});
  QueryAnswer answered;
  answered.world_from_camera = answer;
  const QueryScore q = score(answered, moment, anchor, run.alignment.truth_from_estimate, {});
  const auto drawn = answer_in_truth(run, QuerySet::kSecondTour, q);
  ASSERT_TRUE(drawn);
  EXPECT_NEAR((drawn->translation() - run.truth[45].world_from_camera.translation()).norm(),
              *q.distance_m, 1e-9);
  EXPECT_FALSE(answer_in_truth(run, QuerySet::kSecondTour, QueryScore{}));
}

TEST(PairsToDecide, GrowWithTheSquareOfWhatIsMissing) {
  Comparison c;
  c.pairs = 10;
  c.difference = 0.02;
  c.detectable = 0.04;
  EXPECT_EQ(pairs_to_decide(c), 40);
  c.difference = -0.04;
  EXPECT_EQ(pairs_to_decide(c), 10);
  c.clusters = 5;
  EXPECT_EQ(pairs_to_decide(c), 5);
  c.difference = 0;
  EXPECT_EQ(pairs_to_decide(c), std::nullopt);
}

TEST_F(Reports, SayNoAmountIsZeroThatIsNot) {
  const Suite suite = *source_of({"den", "hall"}).suite;
  Comparison c;
  c.what.unit = "m";
  c.what.measure = "ATE";
  c.pairs = 60;
  c.difference = 6.64e-7;
  c.low = -4.8e-7;
  c.high = 2.47e-6;
  c.detectable = 2e-6;
  const std::string text = finding(suite, {{0, 1}, 0, "", c});
  EXPECT_NE(text.find("+0.0007 mm (95 % interval -0.0005 to +0.002)"), std::string::npos) << text;
}

TEST_F(Reports, ShowNamesAsText) {
  PagesSource source = source_of({"den"});
  source.name = kHostile;
  source.suite->name = kHostile;
  source.suite->environments[0].name = kHostile;
  source.suite->systems[0].name = kHostile;
  for (RunResult& run : source.results.runs) run.spec.environment.name = kHostile;
  source.results.failed.push_back({source.results.runs[0].spec, "</script><script>alert(1)"});
  write_pages(out(), std::array{source});
  for (const auto& entry : fs::directory_iterator(out() / "data")) {
    const std::string text = read_file(entry.path());
    EXPECT_EQ(text.find('<'), std::string::npos) << entry.path();
    EXPECT_NE(text.find("(globalThis.modelhouse"), std::string::npos);
  }
  EXPECT_EQ(ReadTable{piece(out(), "0/runs")}.text("environment", 0), kHostile);
}

TEST_F(Reports, SayWhatIsMissing) {
  // Something is missing in each run: one has only a trajectory, one has no ground truth, one
  // failed.
  PagesSource source = source_of({"den"});
  RunResult& outside = source.results.runs[0];
  outside.points = {PointResult()};
  outside.mapping.calls.clear();
  RunResult& blind = source.results.runs[1];
  blind.truth.clear();
  blind.trajectory = {};
  blind.points = {PointResult()};
  source.results.failed.push_back({outside.spec, "out of memory"});
  source.cost_of.clear();
  write_pages(out(), std::array{source});
  EXPECT_TRUE(piece(out(), "0/overview").at("table2").is_null());
  EXPECT_TRUE(piece(out(), "0/figures").at("density").is_null());
  EXPECT_TRUE(piece(out(), "0/reproduction").is_null());
  EXPECT_EQ(piece(out(), "0/queries").at("rows"), 0);
  EXPECT_TRUE(piece(out(), "0/paths0").at(1).at("truth").is_null());
  EXPECT_EQ(ReadTable{piece(out(), "0/runs")}.text("error", 2), "out of memory");
}

TEST_F(Reports, OfASweepSayAtWhichPointTheyAre) {
  write_pages(out(), std::array{source_of_suite(sweep())});
  EXPECT_EQ(piece(out(), "index").at("folders").at(0).at("first_point"), "gamma 0, xi 1");
  const Json json = piece(out(), "0/queries");
  const ReadTable queries{json};
  std::set<std::string> settings;
  for (std::size_t row = 0; row < json.at("rows"); ++row)
    settings.insert(queries.text("settings", row));
  EXPECT_TRUE(settings.contains("gamma 0.5, xi 1.5"));
  EXPECT_EQ(settings.size(), 13U) << "12 points, and none for the plain system";
  write_pages(out(), std::array{source_of({"den"})});
  EXPECT_TRUE(piece(out(), "index").at("folders").at(0).at("first_point").is_null());
}

TEST_F(Reports, Figure4OfASweepThatMapsAnewIsOfItsFirstPoint) {
  PagesSource source = source_of_suite(sweep("map: rebuilt, features.count: [500, 1000]"));
  for (RunResult& run : source.results.runs)
    if (run.spec.slam->features.count == 1000)
      for (TimedPose& pose : run.estimate)
        pose.world_from_camera =
            SE3(Eigen::Matrix3d::Identity(), {5, 0, 0}) * pose.world_from_camera;
  write_pages(out(), std::array{source});
  const Json curve = piece(out(), "0/figures").at("by_frame");
  ASSERT_GT(curve.at("rows"), 0);
  for (std::size_t row = 0; row < curve.at("rows"); ++row)
    EXPECT_LT(ReadTable{curve}.number("error_m", row).get<double>(), 1);
}

TEST_F(Reports, ASystemThatSeesNoLabelsHasOneRowWhateverTheLabels) {
  Suite suite = made_up_suite(work_.path(), {"den"});
  suite.labels = {LabelMode::kExact, LabelMode::kBoxes};
  write_pages(out(), std::array{source_of_suite(suite)});
  const Json json = piece(out(), "0/overview").at("table2");
  const ReadTable table{json};
  std::vector<std::string> seen;
  for (std::size_t row = 0; row < json.at("rows"); ++row)
    if (table.text("query_set", row) == "held_out")
      seen.push_back(table.text("system", row) + " " + table.text("labels", row));
  EXPECT_EQ(seen, (std::vector<std::string>{"semantic exact", "plain none", "semantic boxes"}));
  EXPECT_NE(json.at("note").get<std::string>().find("Success: a pose was returned, right or wrong"),
            std::string::npos);
  const Json curve = piece(out(), "0/figures").at("by_frame");
  std::set<std::string> curves;
  for (std::size_t row = 0; row < curve.at("rows"); ++row)
    curves.insert(ReadTable{curve}.text("system", row) + " " +
                  ReadTable{curve}.text("labels", row));
  EXPECT_EQ(curves, (std::set<std::string>{"semantic exact", "plain none", "semantic boxes"}));
}

TEST_F(Reports, OfAFileThatIsNoResultsFileSayWhy) {
  const fs::path folder = work_.path() / "old";
  fs::create_directories(folder);
  write_atomically(folder / "results.sqlite", "SQLite format 2: something older");
  const PagesSource source = read_source(folder);
  EXPECT_FALSE(source.problem.empty());
  write_pages(out(), std::array{source});
  EXPECT_EQ(piece(out(), "index").at("folders").at(0).at("problem"), source.problem);
  EXPECT_THROW(read_source(work_.path() / "nowhere"), InputError);
}

TEST_F(Reports, OfAStudyOf4020RunsStaySmall) {
  const PagesSource source = large_study();
  ASSERT_EQ(source.results.runs.size(), 4020U);
  const WrittenPages written = write_pages(out(), std::array{source});
  EXPECT_LT(written.bytes, 25'000'000U);
  RecordProperty("megabytes", std::to_string(written.bytes / 1'000'000));
}

// ---- for papers ---------------------------------------------------------------------------------

class Plotted : public Reports {
 protected:
  Plotted() {
    Suite suite = made_up_suite(work_.path(), {"bath", "kitchen", "lobby"});
    int seed = 0;
    for (Environment& e : suite.environments)
      e.scene = fmt::format("generated:bathroom:{}", seed++);
    source_ = source_of_suite(suite);
    OccupancyGrid& grid = source_.results.runs.front().grid;
    grid.resolution_m = 0.5;
    grid.origin_m = {-3, -3};
    grid.cells = Grid2d<std::int8_t>(12, 12, kFreeCell);
    for (int x = 2; x < 6; ++x) grid.cells(x, 3) = kOccupiedCell;
  }
  std::string script(const PlotOrder& order) const {
    return plot_script(source_, order, work_.path() / "plot.pdf");
  }
  /// Number of colors in a PNG drawn by gnuplot.
  std::size_t colors_of(const PlotOrder& order) const {
    const fs::path file = work_.path() / "plot.png";
    write_plot(file, source_, order);
    const auto image = decode_color(read_file(file));
    std::set<std::uint32_t> colors;
    for (const Rgb8 c : image.value()) colors.insert(c.r << 16U | c.g << 8U | c.b);
    return colors.size();
  }
  PagesSource source_{.name = "made up", .folder = {}};
};

TEST_F(Plotted, FiguresHoldTheNumbersOfTheResults) {
  const RunResult& run = source_.results.runs.front();
  EXPECT_NE(script({.figure = 3}).find(fmt::format("{}\n", *run.trajectory.ate_rmse_m)),
            std::string::npos);
  const Eigen::Vector3d at = run.truth[7].world_from_camera.translation();
  EXPECT_NE(script({.figure = 2}).find(fmt::format("\n{} {}\n", at.x(), at.y())),
            std::string::npos);
  // Four occupied cells of 0.5 m, starting at x = -2, in the row that starts at y = -1.5.
  EXPECT_NE(script({.figure = 5}).find("\n-1 -1.25 -2 0 -1.5 -1\n"), std::string::npos);
  EXPECT_EQ(script({.figure = 2}).find("boxxyerror"), std::string::npos);
  for (const int figure : {2, 3, 4, 5}) EXPECT_GT(colors_of({.figure = figure}), 8U) << figure;
}

TEST_F(Plotted, TablesAreThoseOfThePages) {
  source_.suite->published = Published::kTable2;
  for (const int table : {1, 2}) {
    EXPECT_GT(colors_of({.table = table}), 8U);
    const std::string text = script({.table = table});
    for (const char* word : {"'semantic'", "'plain'", table == 1 ? "'ATE m'" : "'success, %'"})
      EXPECT_NE(text.find(word), std::string::npos) << table << word;
  }
  EXPECT_NE(script({.table = 1}).find("'RPE m/s'"), std::string::npos);
  EXPECT_NE(script({.table = 2}).find("'published, other data'"), std::string::npos);
  EXPECT_NE(script({.table = 2}).find("'79.25'"), std::string::npos);
}

TEST_F(Plotted, WhatTheResultsLackIsNamed) {
  const auto error = [&](const PlotOrder& order) -> std::string {
    try {
      script(order);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  source_.results.runs[1].grid = {};
  EXPECT_NE(error({.figure = 5, .run = source_.results.runs[1].spec.name}).find("left no grid"),
            std::string::npos);
  EXPECT_NE(error({.figure = 2, .run = "nobody"}).find("no run 'nobody'"), std::string::npos);
  source_ = source_of({"den"});
  EXPECT_NE(error({.table = 1}).find("one environment"), std::string::npos);
  EXPECT_NE(error({.figure = 3}).find("no environment was generated"), std::string::npos);
  source_.results.runs.clear();
  EXPECT_NE(error({.figure = 2}).find("no finished run"), std::string::npos);
}

// ---- in a browser -------------------------------------------------------------------------------

struct Ended {
  int code = 0;
  std::string out;
};
Ended ended(const std::string& command) {
  Ended made;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> part{};
  while (pipe != nullptr && fgets(part.data(), part.size(), pipe) != nullptr)
    made.out += part.data();
  made.code = WEXITSTATUS(pclose(pipe));
  return made;
}

/// Installs the npm packages of the web sources once, next to the build. @returns why that failed,
/// or ""
std::string installed_packages(const fs::path& home) {
  const fs::path web = fs::path(MH_SOURCE_DIR) / "bench/report/web";
  fs::create_directories(home);
  for (const char* file : {"package.json", "package-lock.json"})
    fs::copy_file(web / file, home / file, fs::copy_options::overwrite_existing);
  const Ended installed = ended(
      fmt::format("cd '{}' && flock lock sh -c 'cmp -s package-lock.json installed || (npm ci "
                  "--ignore-scripts --no-audit --no-fund && cp package-lock.json installed)'",
                  home.string()));
  return installed.code == 0 ? "" : installed.out;
}

bool has_browser() {
  return fs::exists("/usr/bin/chromium") || fs::exists("/usr/bin/chromium-browser");
}

/// Reports of every kind, each in its own folder.
class InTheBrowser : public Reports {
 protected:
  static void write(const std::string& name, const PagesSource& source) {
    write_pages(root() / name, std::array{source});
  }
  static fs::path root() { return fs::path(MH_BROWSER) / "reports"; }

  void write_all() const {
    fs::remove_all(root());
    Suite suite = made_up_suite(work_.path(), {"bath", "kitchen", "lobby", "office", "study"});
    suite.name = suite.environments[1].name = suite.systems[1].name = kHostile;
    int seed = 0;
    for (Environment& e : suite.environments) {
      const char* category = seed % 2 == 0 ? "bathroom" : "kitchen";
      e.category = category;
      e.scene = fmt::format("generated:{}:{}", category, seed++);
    }
    PagesSource rooms = source_of_suite(suite);
    rooms.audit = {
        {"rows", {{{"system", "semantic"}, {"wrong_candidates", 0.1}, {"few_matches", 0.05}}}}};
    put_replay(rooms);
    write("rooms", rooms);
    PagesSource later = rooms;
    later.name = "after";
    later.suite->levels = {
        {.file = "dusk.yaml"}};  // a different level does not change a system's color
    for (RunResult& run : later.results.runs) run.spec.level.file = "dusk.yaml";
    write_pages(root() / "two", std::array{rooms, later});
    write("sweep", source_of_suite(sweep()));
    PagesSource bare = source_of({"den"});
    for (RunResult& run : bare.results.runs) {
      run.points = {PointResult()};
      run.mapping.calls.clear();
      run.truth.clear();
      run.trajectory = {};
    }
    bare.cost_of.clear();
    bare.results.failed.push_back({bare.results.runs[0].spec, kHostile});
    write("odd-bare", bare);
    write("odd-older", {.name = "older",
                        .folder = {},
                        .problem = "out/model_house/results.sqlite: has schema 13 of an older "
                                   "modelhouse, this one reads 17: move it away and run again"});
    write("large", large_study());
  }
};

TEST_F(InTheBrowser, EveryPageShowsItsDataAndAnswersItsReader) {
  if (!has_browser()) GTEST_SKIP() << "chromium is missing (packages.txt)";
  if (ended("command -v node && command -v npm").code != 0) GTEST_SKIP() << "npm is missing";
  const fs::path home = MH_BROWSER;
  if (const std::string why = installed_packages(home); !why.empty())
    GTEST_SKIP() << "npm cannot install the packages: " << why;
  fs::copy_file(fs::path(MH_SOURCE_DIR) / "tests/bench/report/pages/browse.mjs",
                home / "browse.mjs", fs::copy_options::overwrite_existing);
  write_all();
  const Ended seen = ended(fmt::format("cd '{}' && node browse.mjs '{}' '{}'", home.string(),
                                       root().string(), (home / "screenshots").string()));
  EXPECT_EQ(seen.code, 0) << seen.out;
  std::puts(seen.out.c_str());
}

TEST_F(InTheBrowser, TheCommittedBundleIsWhatItsSourcesGive) {
  if (ended("command -v node && command -v npm").code != 0) GTEST_SKIP() << "npm is missing";
  const fs::path home = MH_BROWSER;
  if (const std::string why = installed_packages(home); !why.empty())
    GTEST_SKIP() << "npm cannot install the packages: " << why;
  const fs::path web = fs::path(MH_SOURCE_DIR) / "bench/report/web";
  fs::remove_all(home / "sources");
  fs::create_directories(home / "sources");
  for (const auto& entry : fs::directory_iterator(web))
    if (entry.path().filename() != "node_modules")
      fs::copy(entry.path(), home / "sources" / entry.path().filename(),
               fs::copy_options::recursive);
  fs::create_directory_symlink("../node_modules", home / "sources/node_modules");
  const Ended built = ended(fmt::format("cd '{}' && node --preserve-symlinks build.mjs '{}'",
                                        (home / "sources").string(), out().string()));
  ASSERT_EQ(built.code, 0) << built.out;
  for (const char* file : {"app.js", "app.css", "replay.js", "index.html", "LICENSES.txt"})
    EXPECT_EQ(read_file(out() / file), read_file(bundle_folder() / file)) << file;
}

}  // namespace
}  // namespace mh
