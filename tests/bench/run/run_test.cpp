// SPDX-License-Identifier: Apache-2.0
// The bench with a scripted system in a small artificial world: no SLAM, no ray tracing.
#include "bench/run/one/run_one.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/protocol/metrics/trajectory_score.hpp"
#include "bench/report/results_json.hpp"
#include "bench/report/results_table.hpp"
#include "bench/report/suite_json.hpp"
#include "bench/report/sweep_chart.hpp"
#include "bench/report/topdown.hpp"
#include "bench/report/write.hpp"
#include "bench/results/scenes.hpp"
#include "bench/run/verify.hpp"
#include "bench/suite/shipped.hpp"
#include "bench/suite/suite.hpp"
#include "sim/simulation/travel.hpp"
#include "slam/config/slam.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/io/counted.hpp"
#include "slam/io/error.hpp"
#include "slam/io/temporary_folder.hpp"
#include "tests/bench/changed_frames.hpp"

namespace mh {
namespace {

/// Images that are a function of the camera's position.
class FakeRenderer : public Renderer {
 public:
  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    RenderedFrame frame;
    const auto shade = static_cast<std::uint8_t>(
        static_cast<int>(1e4 * std::abs(world_from_camera.translation().x())) % 251);
    frame.color = Grid2d<Rgb8>(camera.width_px, camera.height_px, Rgb8{shade, 90, 60});
    frame.depth_m = Grid2d<float>(camera.width_px, camera.height_px, 2.0F);
    frame.classes = Grid2d<ClassId>(camera.width_px, camera.height_px, ClassId{5});
    frame.instances = Grid2d<InstanceId>(camera.width_px, camera.height_px, InstanceId{1});
    return frame;
  }
};

/// Reports poses that depend on every pixel it has seen and on its random draws, and fails at frame
/// 70 a given number of times, so that restarts are covered.
class MixingSystem : public System {
 public:
  MixingSystem(bool looks_at_labels, int failures)
      : looks_at_labels_(looks_at_labels), failures_(failures) {}

  SystemReport track(const RgbdFrame& frame, RandomStream stream) override {
    SystemReport report;
    if (frame.stamp_ns == 70 * kPeriod && ++showings_ <= failures_) return report;
    const double wobble = mix(frame, stream);
    report.status = TrackStatus::kTracked;
    report.keyframe_added = frame.stamp_ns % (10 * kPeriod) == 0;
    report.world_from_camera =
        SE3(Eigen::Matrix3d::Identity(),
            Eigen::Vector3d(0.01 * static_cast<double>(frame.stamp_ns / kPeriod), wobble, 1.0));
    poses_[frame.stamp_ns] = *report.world_from_camera;
    return report;
  }
  void rewind() override {}
  void reset() override { poses_.clear(); }
  void freeze() override {}
  Trajectory trajectory() const override {
    Trajectory t;
    for (const auto& [stamp, pose] : poses_) t.push_back({stamp, pose});
    return t;
  }
  std::unique_ptr<RelocalizationSession> open_session() const override {
    struct Session : RelocalizationSession {
      explicit Session(const MixingSystem& s) : system(s) {}
      SystemReport feed(const RgbdFrame& frame, RandomStream stream) override {
        SystemReport report;
        if (frame.depth_m(0, 0) == 0) return report;
        report.candidates = {
            .keyframes = 10, .c1 = 9, .c2 = 4, .c3 = 3, .final = 1, .label_mass = {}, .gamma = {}};
        report.status = TrackStatus::kRelocalized;
        report.relocalization = RelocalizationStage::kVerified;
        report.world_from_camera =
            SE3(Eigen::Matrix3d::Identity(),
                Eigen::Vector3d(0.01 * static_cast<double>(frame.stamp_ns / kPeriod),
                                system.mix(frame, stream), 1.0));
        return report;
      }
      const MixingSystem& system;
    };
    return std::make_unique<Session>(*this);
  }

  static constexpr Stamp kPeriod = 33'333'333;

 private:
  double mix(const RgbdFrame& frame, RandomStream stream) const {
    double sum = 0;
    for (const Rgb8& c : frame.color) sum = 0.9 * sum + c.r;
    if (looks_at_labels_) sum += static_cast<double>(frame.semantics.palette.size());
    return 1e-6 * sum + 1e-3 * stream.uniform(0);
  }

  bool looks_at_labels_;
  int failures_;
  int showings_ = 0;
  std::map<Stamp, SE3> poses_;
};

Trajectory straight_path(std::size_t frames) {
  Trajectory path;
  for (std::size_t i = 0; i < frames; ++i)
    path.push_back(
        {static_cast<Stamp>(i) * MixingSystem::kPeriod,
         SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.01 * static_cast<double>(i), 0, 1.0))});
  return path;
}

/// What is changed in one run: the frames it sees or what its system reports.
struct Change {
  testing_support::FrameChange frame = {};
  std::function<void(std::size_t call, SystemReport&)> report = {};
};
using ChangeOfRun = std::function<Change(const RunSpec&)>;

/// Changes the reports of another system.
class ChangedSystem : public SystemView {
 public:
  ChangedSystem(std::unique_ptr<System> inner, const Change& change)
      : SystemView(std::move(inner)), change_(change) {}
  SystemReport track(const RgbdFrame& frame, RandomStream stream) override {
    SystemReport report = SystemView::track(frame, stream);
    if (change_.report) change_.report(calls_++, report);
    return report;
  }

 private:
  Change change_;
  std::size_t calls_ = 0;
};

struct Place {
  Suite suite;
  World world;

  Place() {
    suite.name = "fake";
    suite.environments = {{.name = "fake",
                           .category = "fake",
                           .scene = "house.yaml",
                           .robot = "robot.yaml",
                           .mapping_tour = "tour.yaml",
                           .query_tour = "tour.yaml"}};
    suite.levels = {{.file = "fake.yaml"}};
    suite.systems = {{SystemKind::kSemantic, "semantic", {}}, {SystemKind::kPlain, "plain", {}}};
    suite.compare = {{0, 1}};
    suite.labels = {LabelMode::kExact, LabelMode::kBoxes};
    world.vocabulary = std::make_shared<const Vocabulary>();
    SimulatedPlace& place = world.simulated.emplace();
    place.renderer = std::make_shared<FakeRenderer>();
    place.scene = std::make_shared<const Scene>();
    place.robot.camera.width_px = 16;
    place.robot.camera.height_px = 12;
    place.robot.camera.cx_px = 7.5;
    place.robot.camera.cy_px = 5.5;
    place.robot.camera.fx_px = place.robot.camera.fy_px = 16;
    place.mapping.camera = straight_path(150);
    place.query_tour = DrivenPath{};
    place.query_tour->camera = straight_path(90);
    simulate(world, LabelMode::kNone);
  }
  std::vector<RunResult> run(const ChangeOfRun& change_of = {}) const {
    std::vector<RunResult> results;
    for (const RunSpec& spec : expand(suite)) {
      World as_seen = world;
      simulate(as_seen, spec.labels.mode);
      const Change change = change_of ? change_of(spec) : Change();
      const auto system = [&](const RunSpec& s, const World&) {
        return std::make_unique<ChangedSystem>(
            std::make_unique<MixingSystem>(s.system.kind == SystemKind::kSemantic, 2), change);
      };
      results.push_back(run_one(spec, testing_support::with_changed_frames(as_seen, change.frame),
                                {.system = system}));
    }
    return results;
  }
};

/// Three points whose queries are answered from one map.
void vary_alpha(Suite& suite) {
  for (const double alpha : {0.5, 0.6, 0.7}) {
    SlamConfig point = suite.slam;
    point.semantics.alpha = alpha;
    suite.sweep.points.push_back(point);
  }
}

TEST(RunOne, IsAFunctionOfItsSpecAndWorld) {
  const Place place;
  const auto once = place.run(), again = place.run();
  ASSERT_EQ(once.size(), 3u);
  EXPECT_FALSE(first_difference(once, again));
  EXPECT_EQ(digests(place.suite, once), digests(place.suite, again));
  EXPECT_EQ(results_json(place.suite, once).dump(), results_json(place.suite, again).dump());
}

TEST(RunOne, PutsTheQueriesUnderEachPoint) {
  Place place;
  vary_alpha(place.suite);
  const auto runs = place.run();
  ASSERT_EQ(runs[0].points.size(), 3u);
  for (const PointResult& point : runs[0].points) EXPECT_EQ(point.held_out.size(), 5u);
}

// A unit of work is one frame, or one query at one point of the sweep: 150 frames + 3 points x (5 +
// 3) queries.
TEST(RunOne, ReportsTheShareOfItsWorkThatIsDone) {
  Place place;
  vary_alpha(place.suite);
  const RunSpec spec = expand(place.suite)[0];
  ASSERT_EQ(spec.points.size(), 3u);
  std::vector<double> shares;
  run_one(spec, place.world,
          {.progress = [&](double share) { shares.push_back(share); },
           .system = [](const RunSpec&,
                        const World&) { return std::make_unique<MixingSystem>(true, 2); }});
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_EQ(shares.end() - std::ranges::find(shares, 150.0 / 174), 25)
      << "all is mapped, then each query";
}

TEST(RunOne, CountsWhatHappened) {
  const Place place;
  const RunResult run = place.run()[0];
  EXPECT_EQ(run.mapping.offered, 145u);
  EXPECT_EQ(run.mapping.restarts, 2);
  EXPECT_EQ(run.trajectory.completeness, 1.0);
  EXPECT_EQ(run.points[0].held_out.size(), 5u);
  EXPECT_EQ(run.points[0].second_tour.size(), 3u);
  EXPECT_EQ(run.times.relocalize_ms.size(), 8u);
  EXPECT_EQ(run.times.blank_ms.size(), 8u) << "told apart from the queries' own frames";
  for (const QueryScore& q : run.points[0].held_out) {
    EXPECT_TRUE(q.success && q.correct);
    EXPECT_LT(q.distance_m.value(), 0.01);
    EXPECT_GT(q.distance_m.value(), 0.0);
  }
  EXPECT_GT(run.volume->voxel_count(), 0u);
}

// The program answers for the first 29 frames, with twice their true distance from the start. That
// is a fifth of the 145 frames that are not test frames. It is asked no queries.
TEST(RunOne, AnOutsideProgramsTrajectoryIsScoredByWhatItWasOffered) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  Trajectory answer = straight_path(29);
  for (TimedPose& pose : answer)
    pose.world_from_camera =
        SE3(pose.world_from_camera.rotation(), 2 * pose.world_from_camera.translation());
  write_tum(folder.path() / "answer.tum", answer);
  Place place;
  place.suite.compare.clear();
  place.suite.labels = {LabelMode::kExact};
  place.suite.systems = {
      {SystemKind::kOutside, "theirs",
       OutsideProgram{
           .name = "theirs",
           .command = "cp " + (folder.path() / "answer.tum").string() + " {trajectory}"}}};
  const RunResult run =
      run_one(expand(place.suite)[0], place.world, {.folder = folder.path(), .occupancy = false});
  EXPECT_EQ(run.mapping.offered, 145u);
  EXPECT_EQ(run.trajectory.completeness, 29.0 / 145);
  EXPECT_EQ(run.estimate.size(), 29u);
  EXPECT_EQ(run.truth.size(), 150u);
  EXPECT_NEAR(run.trajectory.rpe_frame_rmse_m.value(), 0.01, 1e-9) << "2 cm a frame for 1";
  ASSERT_EQ(run.points.size(), 1u);
  EXPECT_TRUE(run.points[0].held_out.empty() && run.points[0].second_tour.empty());
}

TEST(Verify, FindsOnePixelOfOneFrameAndNamesIt) {
  const Place place;
  const auto flip = [](const RunSpec& spec) {
    Change change;
    if (spec.name == "semantic-boxes-fake-0")
      change.frame = [](std::size_t index, RgbdFrame& frame) {
        if (index == 97) frame.color(3, 4).g ^= 1;
      };
    return change;
  };
  const auto difference = first_difference(place.run(), place.run(flip));
  ASSERT_TRUE(difference);
  EXPECT_EQ(*difference, (Difference{"semantic-boxes-fake-0", "mapping", 97, 2, "image"}));
  EXPECT_EQ(describe(*difference),
            "semantic-boxes-fake-0: mapping: frame 97 (after 2 restarts): image differs");
}

TEST(Verify, FindsOnePoseAndNamesIt) {
  const Place place;
  const auto shift = [](const RunSpec& spec) {
    Change change;
    if (spec.system.kind == SystemKind::kPlain)
      change.report = [](std::size_t call, SystemReport& report) {
        if (call == 41)
          report.world_from_camera =
              *report.world_from_camera * SE3(Eigen::Matrix3d::Identity(), {0, 0, 1e-15});
      };
    return change;
  };
  const auto clean = place.run();
  const auto difference = first_difference(clean, place.run(shift));
  ASSERT_TRUE(difference);
  const std::size_t frame = clean[2].mapping.calls[41].index;
  EXPECT_EQ(*difference, (Difference{"plain-fake-0", "mapping", frame, 0, "pose"}));
}

TEST(Verify, FindsAPixelOfAQuery) {
  const Place place;
  const auto nudge = [](const RunSpec&) {
    Change change;
    change.frame = [](std::size_t index, RgbdFrame& frame) {
      if (index == 119) frame.depth_m(1, 1) += 1e-6F;
    };
    return change;
  };
  const auto difference = first_difference(place.run(), place.run(nudge));
  ASSERT_TRUE(difference);
  EXPECT_EQ(*difference, (Difference{"semantic-exact-fake-0", "held_out", 119, 0, "image"}));
}

TEST(Verify, SeesAnotherPath) {
  Place a, b;
  b.world.simulated->query_tour->camera.back().stamp_ns += 1;
  const auto difference = first_difference(a.run(), b.run());
  ASSERT_TRUE(difference);
  EXPECT_EQ(describe(*difference), "semantic-exact-fake-0: world: path differs");
}

TEST(Scenes, MeansAreOfMediansAndScenesArePaired) {
  Place place;
  place.suite.environments.push_back(place.suite.environments[0]);
  place.suite.environments[1].name = "other";
  place.suite.environments.push_back(place.suite.environments[0]);
  place.suite.environments[2].name = "hall";
  place.suite.environments[2].category = "hall";
  place.suite.trials = 3;
  std::vector<RunResult> runs = place.run();
  ASSERT_EQ(runs.size(), 27u);
  // Completeness of the plain system in the first scene: 0.2, 0.9, 0.5; everywhere else 1.
  int trial = 0;
  const double completeness[] = {0.2, 0.9, 0.5};
  for (RunResult& run : runs)
    if (run.spec.system.name == "plain" && run.spec.environment.name == "fake")
      run.trajectory.completeness = completeness[trial++];
  const std::vector<Row> rows = make_rows(place.suite, runs);
  const std::vector<CategoryRow> categories = make_category_rows(place.suite, rows);
  std::vector<std::string> seen;
  for (const CategoryRow& row : categories)
    if (row.labels == LabelMode::kExact && place.suite.systems[row.system].name == "plain")
      seen.push_back(
          fmt::format("{} {} {}", row.category, row.scenes, row.trajectory.completeness));
  EXPECT_EQ(seen,
            (std::vector<std::string>{"fake 2 0.75", "hall 1 1", "all 3 0.8333333333333334"}));
  const std::vector<SceneFamily> families = compare_over_scenes(place.suite, rows);
  ASSERT_EQ(families.size(), 1u);
  EXPECT_EQ(families[0].comparisons[0].what.text(), "success, held_out, exact labels");
  EXPECT_EQ(families[0].comparisons[0].pairs, 3u) << "scenes, not queries";
  EXPECT_NE(results_table(place.suite, runs).find("Wilcoxon"), std::string::npos);
}

TEST(Scenes, NotInferiorNeedsTheWholeIntervalAboveTheMargin) {
  Comparison c{.what = {"success", "", "", ""}, .pairs = 100};
  c.low = -0.03;
  EXPECT_TRUE(not_inferior(c, 0.05));
  EXPECT_FALSE(not_inferior(c, 0.03));
  c.low = -INFINITY;
  EXPECT_FALSE(not_inferior(c, 1.0)) << "too few scenes";
  c.low = 0;  // no query differs
  c.pairs = 60;
  EXPECT_TRUE(not_inferior(c, 0.05));
  c.pairs = 59;
  EXPECT_FALSE(not_inferior(c, 0.05)) << "a loss of 5 % may show in none of 59";
}

TEST(Results, WhatIsUndeterminedIsNull) {
  const Place place;  // its path is straight: no SE(3) alignment
  const std::vector<RunResult> runs = place.run();
  const auto row = results_json(place.suite, runs)["rows"][0];
  EXPECT_TRUE(row["trajectory"]["ate_rmse_m"].is_null());
  EXPECT_TRUE(row["trajectory"]["ate_first_pose_m"].is_number());
  EXPECT_TRUE(row["held_out"]["distance_mean_m"].is_number());
  const Trajectory one = straight_path(1);
  EXPECT_FALSE(score_trajectory(one, one, 1).ate_first_pose_m);
  const std::vector<QueryScore> unanswered(3);
  EXPECT_FALSE(summarize(unanswered).distance_mean_m);
  std::vector<QueryScore> without_map(3);
  for (QueryScore& q : without_map) {
    q.true_world_from_camera = SE3();
    q.success = q.false_positive = true;
  }
  EXPECT_EQ(summarize(without_map).false_positive, 1.0);
  EXPECT_FALSE(summarize(without_map).distance_mean_m);
  EXPECT_FALSE(summarize(without_map).aligned_distance_mean_m);
}

TEST(Results, OfAnswersThatNobodyCanJudgeNothingIsSaidButTheirSuccess) {
  std::vector<QueryScore> queries(4);
  queries[1].success = true;
  const QuerySummary s = summarize(queries);
  EXPECT_EQ(s.success, 0.25);
  EXPECT_FALSE(s.correct || s.false_positive || s.distance_mean_m);
  queries[3].true_world_from_camera = SE3();
  queries[3].success = queries[3].correct = true;
  EXPECT_EQ(summarize(queries).correct, 0.25);
  EXPECT_EQ(summarize(queries).false_positive, 0.0);

  Place place;
  std::vector<RunResult> runs = place.run();
  for (RunResult& run : runs)
    for (QueryScore& q : run.points.front().held_out) {
      q.true_world_from_camera.reset();
      q.distance_m = q.angle_deg = q.aligned_distance_m = {};
      q.correct = q.false_positive = false;
    }
  const auto json = results_json(place.suite, runs);
  EXPECT_TRUE(json["rows"][0]["held_out"]["success"].is_number());
  EXPECT_TRUE(json["rows"][0]["held_out"]["correct"].is_null());
  EXPECT_TRUE(json["rows"][0]["held_out"]["false_positive"].is_null());
  EXPECT_TRUE(json["rows"][0]["second_tour"]["correct"].is_number());
  const auto query = json["runs"][0]["points"][0]["held_out"][0];
  EXPECT_TRUE(query["correct"].is_null() && query["false_positive"].is_null() &&
              query["truth"].is_null());
  const std::string table = results_table(place.suite, runs);
  EXPECT_TRUE(
      std::regex_search(table, std::regex("held out +success[^\n]*\n +[a-z]+ +[0-9.]+% +- +- ")))
      << table;
}

TEST(Sweep, TheBestPointIsComparedWithTheSuitesOwnSettings) {
  Place place;
  place.suite.labels = {LabelMode::kExact};
  place.suite.sweep.varied = {"semantics.gamma", "semantics.alpha"};
  for (const double gamma : {0.5, 1.0})
    for (const double alpha : {0.7, 0.8}) {
      SlamConfig point = place.suite.slam;
      point.semantics.gamma = gamma;
      point.semantics.alpha = alpha;
      place.suite.sweep.points.push_back(point);
    }
  std::vector<RunResult> runs = place.run();
  // Of the semantic system's five held-out answers, 3, 4, 5 and 4 are correct under the four
  // points.
  const std::size_t correct[] = {3, 4, 5, 4};
  for (std::size_t p = 0; p < 4; ++p)
    for (std::size_t q = 0; q < 5; ++q) runs[0].points[p].held_out[q].correct = q < correct[p];
  const std::vector<Row> rows = make_rows(place.suite, runs);
  const std::vector<SweepResult> results = sweep_results(place.suite, rows);
  ASSERT_EQ(results.size(), 2u);  // for the plain system, only the points with different alphas
  const auto best = best_point(place.suite, rows, results[0], QuerySet::kHeldOut);
  ASSERT_TRUE(best);
  EXPECT_EQ(best->point, 2u);
  EXPECT_EQ(best->reference, 3u);  // gamma 1, alpha 0.8
  EXPECT_NEAR(best->to_reference.difference, 0.2, 1e-12);
  EXPECT_EQ(best->equals, 1u);
  const auto plain = best_point(place.suite, rows, results[1], QuerySet::kHeldOut);
  EXPECT_EQ(plain->point, 3u) << "of equals the suite's own";
  EXPECT_EQ(plain->equals, 4u);
  const std::string table = results_table(place.suite, runs);
  EXPECT_NE(table.find("gamma 1, alpha 0.7: 100.00%, +0.2000"), std::string::npos) << table;
  EXPECT_NE(table.find("held_out: 100.00% at each of 4 points"), std::string::npos) << table;
  runs[0].points[0].held_out = runs[0].points[2].held_out;
  EXPECT_NE(results_table(place.suite, runs).find("; 2 points are equal\n"), std::string::npos);
  const PlotPage page = sweep_chart(place.suite, rows, results[0]);
  ASSERT_EQ(page.plots.size(), 6U) << "three measures of two sets of queries";
  const ShadedField& field = page.plots[0].field.value();
  EXPECT_TRUE(field.cells);
  EXPECT_EQ(field.framed, 2U);
  ASSERT_EQ(field.marks.size(), 4U);
  EXPECT_EQ(field.marks[2].value, 100);
  EXPECT_EQ(field.marks[2].text, "100.0");
  EXPECT_EQ(field.marks[2].x, 0) << "alpha 0.7, the first of two";
  EXPECT_EQ(field.marks[2].y, 1) << "gamma 1, the second";
  EXPECT_NE(page.caption.find("most correct answers at gamma 1, alpha 0.7: 100.0 %"),
            std::string::npos)
      << page.caption;
  EXPECT_EQ(sweep_image_name(place.suite.systems[results[0].system], results[0].labels,
                             place.suite.levels[results[0].level]),
            "sweep-semantic-exact-fake.png");
}

TEST(Sweep, OfMoreThanTwoSettingsEachPairHasAPanel) {
  Place place;
  place.suite.labels = {LabelMode::kExact};
  place.suite.systems.resize(1);
  place.suite.compare.clear();
  place.suite.sweep.varied = {"semantics.gamma", "semantics.alpha", "semantics.xi",
                              "semantics.beta"};
  for (const double share : {0.5, 0.6, 0.7}) {
    SlamConfig point = place.suite.slam;
    point.semantics.gamma = point.semantics.xi = share;
    point.semantics.alpha = point.semantics.beta = share;
    place.suite.sweep.points.push_back(point);
  }
  const std::vector<RunResult> runs = place.run();
  for (const auto& [settings, pairs] : {std::pair(std::size_t{4}, 6), {3, 3}, {2, 1}}) {
    place.suite.sweep.varied.resize(settings);
    const std::vector<Row> rows = make_rows(place.suite, runs);
    const PlotPage page = sweep_chart(place.suite, rows, sweep_results(place.suite, rows).front());
    const std::size_t sets = 2;  // held out, second tour
    EXPECT_EQ(page.plots.size(), sets * static_cast<std::size_t>(pairs)) << settings;
    for (const Plot& plot : page.plots) {
      EXPECT_FALSE(plot.field.value().cells);
      EXPECT_EQ(plot.field->marks.size(), 3U);
    }
  }
}

TEST(Results, WhatWasNotAskedIsADashNotZeroPercent) {
  Place place;
  place.suite.labels = {LabelMode::kExact};
  std::vector<RunResult> runs = place.run();
  ASSERT_EQ(runs[0].spec.system.name, "semantic");
  runs[0].points[0] = {};  // as if from a program that answered with only a trajectory
  place.suite.environments.push_back(place.suite.environments[0]);
  place.suite.environments[1].name = "other";
  for (const std::size_t places : {1u, 2u}) {
    place.suite.environments.resize(places);
    std::istringstream lines(results_table(place.suite, runs));
    int of_semantic = 0, of_plain = 0;
    for (std::string line; std::getline(lines, line);) {
      static const std::regex kNothing(" 0\\.00(%| )"), kAsked(" plain .* 100\\.00(%| )");
      if (line.find(" semantic ") != std::string::npos && line.find(" - ") != std::string::npos) {
        EXPECT_FALSE(std::regex_search(line, kNothing)) << line;
        ++of_semantic;
      }
      of_plain += std::regex_search(line, kAsked) ? 1 : 0;
    }
    EXPECT_GE(of_semantic, places == 1 ? 4 : 2);
    EXPECT_GE(of_plain, places == 1 ? 4 : 2);
  }
}

/// Splits off the runs whose names begin with one of `names`, as failures.
std::pair<std::vector<RunResult>, std::vector<FailedRun>> with_failed(
    std::vector<RunResult> runs, const std::vector<std::string>& names) {
  std::vector<FailedRun> failed;
  std::erase_if(runs, [&](const RunResult& run) {
    const bool is = std::ranges::count(names, run.spec.name) > 0;
    if (is) failed.push_back({run.spec, "ended by signal 11"});
    return is;
  });
  EXPECT_EQ(failed.size(), names.size());
  return {std::move(runs), std::move(failed)};
}

TEST(Results, FailedRunsAreToldInTheirRows) {
  Place place;
  place.suite.labels = {LabelMode::kExact};
  place.suite.trials = 3;
  const auto [runs, failed] = with_failed(
      place.run(), {"semantic-exact-fake-1", "plain-fake-0", "plain-fake-1", "plain-fake-2"});
  const std::string table = results_table(place.suite, runs, failed);
  for (const char* part : {"   2 of 3 trials, 1 failed\n", "   failed: 3 of 3 trials\n",
                           "failed, so the figures above do not include 4 runs:\n",
                           "  semantic-exact-fake-1: ended by signal 11\n"})
    EXPECT_NE(table.find(part), std::string::npos) << part << table;
  EXPECT_EQ(table.find("semantic minus plain"), std::string::npos) << "with what? " << table;
  const auto json = results_json(place.suite, runs, failed);
  ASSERT_EQ(json["runs"].size(), 6u);
  EXPECT_EQ(json["runs"][0]["status"], "done");
  EXPECT_EQ(json["runs"][5]["status"], "failed");
  EXPECT_EQ(json["runs"][5]["error"], "ended by signal 11");
  EXPECT_EQ(json["rows"][0]["trials"], 2);
  EXPECT_EQ(json["rows"][0]["failed"], 1);
  EXPECT_EQ(json["rows"][1]["trials"], 0);
  EXPECT_TRUE(json["rows"][1]["trajectory"].is_null());
  EXPECT_TRUE(json["rows"][1]["held_out"].is_null());
  // No run is left.
  const std::string nothing = results_table(place.suite, {}, failed);
  EXPECT_NE(nothing.find("   failed: 3 of 3 trials\n"), std::string::npos) << nothing;
}

TEST(Results, RunsThatNobodyHasMadeYetAreTold) {
  const Place place;
  std::vector<RunResult> runs = place.run();
  const std::vector<std::string> missing = {runs.back().spec.name};
  runs.pop_back();
  const std::string table = results_table(place.suite, runs, {}, missing);
  EXPECT_TRUE(table.ends_with("\nmissing, so the figures above do not include 1 run:\n  " +
                              missing[0] + "\n"))
      << table;
  EXPECT_EQ(results_json(place.suite, runs, {}, missing)["missing"][0], missing[0]);
  EXPECT_TRUE(results_json(place.suite, runs)["missing"].empty());
  const std::vector<std::string> many(12, "x");
  EXPECT_TRUE(results_table(place.suite, runs, {}, many).ends_with("  and 2 more\n"));
}

TEST(Results, RunsWithoutLabelsAreSaidToHaveNone) {
  Place place;
  place.suite.labels = {LabelMode::kNone};
  const std::string table = results_table(place.suite, place.run());
  EXPECT_NE(table.find("fake, level fake, no labels, 1 trial"), std::string::npos) << table;
  EXPECT_EQ(table.find("none labels"), std::string::npos) << table;
}

TEST(Topdown, KeepsItsTextWithinTheMarginsAndItsAnswersOnThePlan) {
  Place place;
  place.suite.environments[0].name = "a corridor";
  RunResult run = place.run()[0];
  const auto drawn = [&] { return draw_topdown(place.world, run, QuerySet::kSecondTour); };
  const auto ink = [](const cv::Mat& part) {
    return cv::countNonZero(part.reshape(1) != 255);  // the background is white
  };
  QueryScore& q = run.points[0].second_tour[0];
  q.correct = false;
  q.false_positive = true;
  q.answer.world_from_camera = SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.3, 1, 1));
  const cv::Mat near = drawn();
  q.answer.world_from_camera = SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.3, 8, 1));
  const cv::Mat far = drawn();
  ASSERT_EQ(near.size(), far.size());
  constexpr int kText = 80;  // title and subtitle; the plan begins below them
  EXPECT_EQ(cv::norm(near.rowRange(0, kText), far.rowRange(0, kText)), 0) << "drawn over the title";
  EXPECT_GT(cv::norm(near, far), 0);
  place.world.simulated->robot.name = std::string(200, 'w');
  EXPECT_EQ(ink(drawn().rowRange(0, kText).colRange(1180, 1200)), 0) << "cut at the edge";
  // A program that answers with only a trajectory was asked no queries.
  run.points[0].second_tour.clear();
  EXPECT_GT(cv::norm(drawn().rowRange(0, kText), far.rowRange(0, kText)), 0);
}

TEST(Topdown, FailuresLieOnTopHeadingsShowAndThePathsCanBeTold) {
  Place place;
  RunResult run = place.run()[0];
  auto& asked = run.points[0].second_tour;
  ASSERT_GE(asked.size(), 2U);
  asked.resize(2);
  Eigen::Matrix3d level;  // a camera that looks along x
  level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const SE3 here(level, Eigen::Vector3d(0.5, 0.5, 1));
  QueryScore answered = asked[0], failed = asked[0];
  answered.success = answered.correct = true;
  answered.false_positive = failed.success = failed.correct = failed.false_positive = false;
  answered.true_world_from_camera = failed.true_world_from_camera = here;
  answered.answer.world_from_camera = here;
  const auto drawn = [&](const QueryScore& first, const QueryScore& second) {
    asked = {first, second};
    return draw_topdown(place.world, run, QuerySet::kSecondTour);
  };
  const cv::Mat image = drawn(answered, failed);
  const auto plan = image.rowRange(80, image.rows - 130);
  const auto pixels_of = [&](const cv::Mat& of, cv::Scalar bgr) {
    cv::Mat mask;
    cv::inRange(of, bgr, bgr, mask);
    return cv::countNonZero(mask);
  };
  EXPECT_EQ(cv::norm(image, drawn(failed, answered)), 0) << "the order of queries decides";
  EXPECT_GT(pixels_of(plan, {150, 140, 140}), 10) << "the failure is hidden";
  QueryScore turned = failed;
  turned.true_world_from_camera =
      SE3(Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()).toRotationMatrix() * level,
          here.translation());
  EXPECT_GT(cv::norm(image, drawn(answered, turned)), 0) << "no heading";
  run.estimate = place.world.simulated->mapping.camera;  // a path without error
  run.alignment.dock_from_estimate = SE3();
  const cv::Mat both = drawn(answered, failed);
  EXPECT_GT(pixels_of(both, {165, 205, 150}), 50) << "the true path is hidden";
  EXPECT_GT(pixels_of(both, {10, 84, 196}), 50) << "the estimated path is hidden";
}

// A fence 1 m wide: it is drawn as furniture once it reaches 0.4 m above the floor, and as a wall
// once it reaches 1.2 m.
TEST(Topdown, FurnitureIsCutAt40CmAndWallsAt120CmAboveTheFloor) {
  Place place;
  const RunResult run = place.run()[0];
  for (const double floor_z_m : {0.0, -0.75}) {
    const auto drawn = [&](double top_m) {
      Scene scene;
      scene.floor.middle_m.z() = floor_z_m;
      for (const double z_m : {floor_z_m, floor_z_m + top_m})
        for (const float x : {0.2F, 1.2F})
          scene.positions_m.emplace_back(x, 1.5F, static_cast<float>(z_m));
      scene.triangles = {{0, 1, 2}, {1, 3, 2}};
      scene.class_of = {1, 1};
      place.world.simulated->scene = std::make_shared<const Scene>(scene);
      return draw_topdown(place.world, run, QuerySet::kSecondTour);
    };
    const cv::Mat none = drawn(0.01), furniture = drawn(0.41), wall = drawn(1.21);
    const double line = cv::norm(none, furniture);
    EXPECT_GT(line, 300);
    EXPECT_GT(cv::norm(furniture, wall), line);
    // The images of the last two comparisons may differ where the fence's two triangles meet.
    EXPECT_EQ(cv::norm(none, drawn(0.39)), 0);
    EXPECT_LT(cv::norm(furniture, drawn(1.19)), 0.1 * line);
    EXPECT_LT(cv::norm(wall, drawn(2.5)), 0.1 * line);
  }
}

// The legend shows the largest distance between the two paths in the plane, in any direction;
// height does not count. Its first line is 84 to 54 px above the lower edge of the image.
TEST(Topdown, TheLegendTellsHowFarThePathsAreApart) {
  Place place;
  RunResult run = place.run()[0];
  run.alignment.dock_from_estimate = SE3();
  const auto legend = [&](const Eigen::Vector3d& first_off, const Eigen::Vector3d& others_off) {
    run.estimate = place.world.simulated->mapping.camera;
    for (TimedPose& pose : run.estimate) {
      const Eigen::Vector3d& off = &pose == &run.estimate[0] ? first_off : others_off;
      pose.world_from_camera =
          SE3(pose.world_from_camera.rotation(), pose.world_from_camera.translation() + off);
    }
    const cv::Mat image = draw_topdown(place.world, run, QuerySet::kSecondTour);
    return image.rowRange(image.rows - 84, image.rows - 54).clone();
  };
  const auto of = [&](double x, double y, double z) {
    const Eigen::Vector3d off(x, y, z);
    return legend(off, off);
  };
  const cv::Mat half = of(0.5, 0, 0);
  EXPECT_EQ(cv::norm(half, of(0, 0.5, 0)), 0);
  EXPECT_EQ(cv::norm(half, of(0, -0.5, 0)), 0);
  EXPECT_EQ(cv::norm(half, of(-0.3, 0.4, 0)), 0);
  EXPECT_EQ(cv::norm(half, of(0.5, 0, 3)), 0);
  EXPECT_EQ(cv::norm(half, legend({0, 0.5, 0}, {0.1, 0, 0})), 0) << "the farthest of all";
  EXPECT_GT(cv::norm(half, of(0.5, 0.1, 0)), 0);
  EXPECT_GT(cv::norm(half, of(0, 0, 0)), 0);
  EXPECT_EQ(cv::norm(of(0, 0, 0), of(0, 0, 2)), 0);
}

TEST(Scenes, WhereRunsFailedItIsSaidOverHowManyScenesTheMeanIs) {
  Place place;
  place.suite.labels = {LabelMode::kExact};
  place.suite.environments.push_back(place.suite.environments[0]);
  place.suite.environments[1].name = place.suite.environments[1].category = "hall";
  const auto [runs, failed] = with_failed(place.run(), {"hall-plain-fake-0"});
  const std::vector<Row> rows = make_rows(place.suite, runs, failed);
  std::vector<std::string> seen;
  for (const CategoryRow& row : make_category_rows(place.suite, rows))
    seen.push_back(fmt::format("{} {} {}/{} {}", row.category, place.suite.systems[row.system].name,
                               row.scenes, row.of, row.failed));
  EXPECT_EQ(seen, (std::vector<std::string>{"fake semantic 1/1 0", "fake plain 1/1 0",
                                            "hall semantic 1/1 0", "hall plain 0/1 1",
                                            "all semantic 2/2 0", "all plain 1/2 1"}));
  const auto families = compare_over_scenes(place.suite, rows);
  ASSERT_EQ(families.size(), 1u);
  EXPECT_EQ(families[0].comparisons[0].pairs, 1u);
  const std::string table = results_table(place.suite, runs, failed);
  for (const char* part :
       {"   0 of 1 scene, 1 run failed\n", "   1 of 2 scenes, 1 run failed\n", "1 of 2 scenes: "})
    EXPECT_NE(table.find(part), std::string::npos) << part << table;
  EXPECT_EQ(table.find("inf"), std::string::npos) << table;
  const auto json = results_json(place.suite, runs, failed);
  EXPECT_TRUE(json["categories"][3]["trajectory"].is_null());
  EXPECT_EQ(json["categories"][5]["of_scenes"], 2);
}

TEST(Sweep, APointThatFailedInSomeScenesIsNeverBest) {
  Place place;
  place.suite.labels = {LabelMode::kExact};
  place.suite.systems.resize(1);
  place.suite.compare.clear();
  place.suite.environments.push_back(place.suite.environments[0]);
  place.suite.environments[1].name = "hall";
  place.suite.sweep.map = SweepMap::kRebuilt;
  place.suite.sweep.varied = {"semantics.alpha"};
  for (const double alpha : {0.7, 0.8}) {
    SlamConfig point = place.suite.slam;
    point.semantics.alpha = alpha;
    place.suite.sweep.points.push_back(point);
  }
  std::vector<RunResult> all = place.run();
  for (RunResult& run : all)  // half of the second point's answers are made wrong
    if (run.spec.points[0].alpha == 0.8)
      for (std::size_t q = 0; q < run.points[0].held_out.size(); q += 2)
        run.points[0].held_out[q].correct = false;
  const auto [runs, failed] = with_failed(std::move(all), {"hall-semantic-exact-fake-p00-0"});
  const std::vector<Row> rows = make_rows(place.suite, runs, failed);
  const auto best =
      best_point(place.suite, rows, sweep_results(place.suite, rows)[0], QuerySet::kHeldOut);
  ASSERT_TRUE(best);
  EXPECT_EQ(best->point, 1u);
}

TEST(Results, OfTwoSystemsTheSameTrialsAreCompared) {
  Place place;
  place.suite.labels = {LabelMode::kExact};
  place.suite.trials = 2;
  std::vector<RunResult> all = place.run();
  const auto bent = [](double by) {  // a path with a corner, which determines the alignment
    Trajectory path = straight_path(40);
    for (std::size_t i = 20; i < path.size(); ++i)
      path[i].world_from_camera =
          SE3(Eigen::Matrix3d::Identity(),
              Eigen::Vector3d(0.2, 0.01 * static_cast<double>(i), 1.0 + by * (i % 2 ? 1 : -1)));
    return path;
  };
  for (RunResult& run : all) {
    run.truth = bent(0);
    run.estimate = bent(run.spec.trial == 0 ? 0.1 : 0.0);
  }
  const auto [runs, failed] = with_failed(std::move(all), {"semantic-exact-fake-0"});
  const std::vector<Row> rows = make_rows(place.suite, runs, failed);
  const auto [semantic, plain] = ate_over_common_frames(rows[0], rows[1]);
  ASSERT_TRUE(semantic && plain);
  EXPECT_NEAR(*semantic, 0, 1e-9);
  EXPECT_NEAR(*plain, 0, 1e-9) << "trial 0 of the plain system has no counterpart";
}

TEST(Results, WhatAnOutsideProgramDoesNotTellIsUnknown) {
  Place place;
  place.suite.labels = {LabelMode::kExact};
  place.suite.compare.clear();
  place.suite.systems = {{SystemKind::kPlain, "plain", {}},
                         {SystemKind::kOutside, "odometry_of_theirs", OutsideProgram{.name = "x"}}};
  std::vector<RunResult> runs = place.run();
  ASSERT_EQ(runs[1].spec.system.kind, SystemKind::kOutside);
  for (QueryScore& q : runs[1].points[0].held_out) {
    q.success = false;
    q.answer.stage.reset();
    q.answer.matches.reset();
    q.answer.candidates = {};
    q.answer.candidates.final = 5;
  }
  runs[1].mapping.matches.reset();
  const QuerySummary s = summarize(runs[1].points[0].held_out);
  EXPECT_FALSE(s.c1 || s.keyframes || s.label_mass);
  EXPECT_EQ(s.final, 5.0);
  EXPECT_EQ(s.single_candidate, 0.0);
  const std::string table = results_table(place.suite, runs);
  EXPECT_TRUE(
      std::regex_search(table, std::regex("odometry_of_theirs +- +- +- +- +5\\.00 +0\\.0% +-\n")))
      << table;
  EXPECT_NE(table.find(" 5 not reported\n"), std::string::npos) << table;
  EXPECT_EQ(table.find("penalized"), std::string::npos) << table;
  const auto query = results_json(place.suite, runs)["runs"][1]["points"][0]["held_out"][0];
  EXPECT_TRUE(query["stage"].is_null());
  EXPECT_TRUE(query["candidates"]["c1"].is_null());
  EXPECT_EQ(query["candidates"]["final"], 5);
}

TEST(Results, ACutRunSaysSo) {
  Place place;
  place.world.simulated->mapping.base = place.world.simulated->mapping.camera;
  place.world.simulated->mapping.length_m = 63;
  EXPECT_FALSE(cut(place.world.simulated->mapping, 150));
  EXPECT_EQ(place.world.simulated->mapping.length_m, 63);
  ASSERT_TRUE(cut(place.world.simulated->mapping, 101));
  EXPECT_NEAR(place.world.simulated->mapping.length_m, 1.0, 1e-9);  // 100 steps of 1 cm
  EXPECT_TRUE(results_json(place.suite, place.run())["suite"]["frames"].is_null());
  place.suite.max_frames = 101;
  place.world.cut = true;
  const std::vector<RunResult> runs = place.run();
  const auto json = results_json(place.suite, runs);
  EXPECT_EQ(json["suite"]["frames"], 101);
  EXPECT_TRUE(json["runs"][0]["place"]["mapping_tour"]["contact_time_s"].is_null());
  const std::string table = results_table(place.suite, runs);
  EXPECT_TRUE(table.starts_with("\nSHORTENED to the first 101 frames")) << table;
  EXPECT_NE(table.find("1 trial, first 101 frames"), std::string::npos) << table;
}

TEST(TimesTable, SaysInWhichSittingsItWasMeasuredAndShowsThePlainSystemOnce) {
  const Place place;
  std::vector<RunResult> runs = place.run();
  for (RunResult& run : runs)
    run.circumstances = {
        .host = "a", .session_start = "2026-01-01T00:00:00Z", .jobs = 2, .load = 0.5};
  const std::string one = times_table(place.suite, runs);
  EXPECT_NE(one.find("measured on a in 1 session, 2 jobs side by side, load per processor 0.5\n"),
            std::string::npos)
      << one;
  EXPECT_EQ(one.find("plain"), one.rfind("plain")) << one;

  runs.back().circumstances = {
      .host = "b", .session_start = "2026-01-01T00:00:00Z", .jobs = 1, .load = 2};
  const std::string two = times_table(place.suite, runs);
  EXPECT_NE(two.find("measured on a, b in 2 sessions, 1 to 2 jobs side by side, load per processor "
                     "0.5 to 2.0: rows need not compare\n"),
            std::string::npos)
      << two;
}

TEST(Results, PathsDoNotDependOnTheSuitesSpelling) {
  const std::vector<RunResult> runs = Place().run();
  const auto scene = [&](const std::filesystem::path& folder) {
    Place place;
    place.suite.file = folder / "suite.yaml";
    place.suite.environments[0].scene = (folder / "../scenes/house.yaml").lexically_normal();
    return results_json(place.suite, runs)["suite"]["environments"][0]["scene"];
  };
  for (const char* folder : {"", ".", "suites", "../suites", "/suites"})
    EXPECT_EQ(scene(folder), "../scenes/house.yaml") << folder;
}

TEST(Results, TellWhatASuiteAsks) {
  const auto told = [](const char* suite) {
    return suite_json(load_suite(shipped_file(suite, Shipped::kSuite)));
  };
  const auto ci = told("ci");
  EXPECT_EQ(ci["environments"][3]["kidnapped_tour"], "../scenarios/tours/kidnap_after.yaml");
  EXPECT_EQ(ci["environments"][4]["query_scene"], "../scenarios/room_moved.yaml");
  EXPECT_EQ(ci["environments"][2]["sensors"], "../scenarios/levels/fast_turn.yaml");
  EXPECT_EQ(ci["environments"][8]["pedestrian"], "../scenarios/pedestrian.yaml");
  EXPECT_TRUE(ci["environments"][0]["pedestrian"].is_null());
  EXPECT_TRUE(ci["graded"].is_null());
  EXPECT_TRUE(ci["episodes"].is_null());
  EXPECT_EQ(ci["compare"].dump(), R"([["semantic","plain"]])");
  EXPECT_GE(told("graded")["graded"]["distance_m"].size(), 3u);
  EXPECT_EQ(told("arms")["compare"][3].dump(), R"(["both","released"])");
  const auto kidnapped = told("kidnapped_harder")["episodes"];
  EXPECT_GE(kidnapped["variants"].size(), 3u);
  EXPECT_FALSE(kidnapped["goals"].empty());
}

TEST(Results, WhatHasNoPairsIsUnknownAndTheFamilyIsCorrectOrWhatTheSuiteNamesAndDistance) {
  Place place;
  std::vector<RunResult> runs = place.run();
  const auto family = [&] {
    std::map<std::string, bool> counted;  // by comparison: whether it has a corrected p
    const auto json = results_json(place.suite, runs);
    for (const auto& c : json["comparisons"]) counted[c["what"]] = !c["p_holm"].is_null();
    return counted;
  };
  const auto of_all = family();
  EXPECT_EQ(of_all.size(), 12u);
  for (const auto& [what, counts] : of_all) EXPECT_EQ(counts, !what.starts_with("success")) << what;
  EXPECT_NE(
      results_table(place.suite, runs).find("Holm over 8 comparisons of correct and distance"),
      std::string::npos);
  place.suite.measure = Measure::kSuccess;
  for (const auto& [what, counts] : family())
    EXPECT_EQ(counts, !what.starts_with("correct")) << what;
  EXPECT_NE(
      results_table(place.suite, runs).find("Holm over 8 comparisons of success and distance"),
      std::string::npos);
  place.suite.measure = Measure::kCorrect;

  for (RunResult& run : runs)
    if (run.spec.system.kind == SystemKind::kPlain)
      for (QueryScore& q : run.points[0].held_out) {
        q.success = q.correct = false;
        q.distance_m.reset();
      }
  const std::string table = results_table(place.suite, runs);
  EXPECT_NE(table.find("Holm over 6 comparisons"), std::string::npos) << table;
  EXPECT_NE(table.find("-   no pairs"), std::string::npos) << table;
  EXPECT_FALSE(family()["distance where both answer, m, held_out, exact labels"]);
  EXPECT_TRUE(family()["distance where both answer, m, second_tour, exact labels"]);
  const auto json = results_json(place.suite, runs);
  for (const auto& c : json["comparisons"])
    for (const char* figure : {"difference", "p"})
      EXPECT_EQ(c[figure].is_null(), c["pairs"] == 0) << c.dump();
}

TEST(Results, TheCommandToMakeThemAgainWorksFromAnyFolder) {
  Place place;
  place.suite.file = "my suites/it's one.yaml";
  place.suite.scene_replaced = true;
  place.suite.environments[0].scene = "other house.glb";
  const std::string here = std::filesystem::current_path().string();
  const std::string command = reproduction_json(place.suite, {})["command"];
  EXPECT_NE(command.find(" bench '" + here + "/my suites/it'\\''s one.yaml' --scene '" + here +
                         "/other house.glb' --trials 1"),
            std::string::npos)
      << command;
  EXPECT_TRUE(command.starts_with("'/")) << command;
}

TEST(Counted, OneIsNotMany) {
  EXPECT_EQ(counted(1, "run"), "1 run");
  EXPECT_EQ(counted(0, "run"), "0 runs");
  EXPECT_EQ(counted(2, "query", "queries"), "2 queries");
  EXPECT_EQ(counted(1, "query", "queries"), "1 query");
}

TEST(ResultsTable, HasThePapersFormAndMarksASaturatedTable) {
  Place place;
  place.suite.published = Published::kTable2;
  const std::string table = results_table(place.suite, place.run());
  for (const char* part :
       {"Reloc. success (%)", "Average distance (m)", "published, other data", "the paper's system",
        "79.25", "0.0512", "71.43", "0.0945", "exact labels", "labels from boxes",
        "held-out frames", "second tour", "saturated", "undecided; too few pairs"})
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  EXPECT_EQ(table.find("is better"), std::string::npos) << table;
  EXPECT_NE(table.find("base: ours"), std::string::npos) << table;
  SlamConfig slam;
  slam.relocalize.acceptance = Acceptance::kOrbSlam2;
  slam.relocalize.neighbor_scores = NeighborScores::kAsReleased;
  place.suite.slam = slam;
  const std::string other = results_table(place.suite, place.run());
  EXPECT_NE(other.find("base: orb_slam2"), std::string::npos) << other;
  EXPECT_NE(other.find("depend on the order of queries"), std::string::npos) << other;
  place.suite.published.reset();
  EXPECT_EQ(results_table(place.suite, place.run()).find("published"), std::string::npos)
      << "of a suite that reproduces no table of the paper";
}

}  // namespace
}  // namespace mh
