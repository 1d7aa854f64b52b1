// SPDX-License-Identifier: Apache-2.0
#include "bench/results/graded.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/bench/results/made_up_results.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

TEST(GradedSpec, BinsContainTheirLowerEdge) {
  const std::vector<double> edges{0, 0.4, 1.2};
  EXPECT_EQ(bins(edges), 2u);
  EXPECT_EQ(bin_of(edges, 0), 0u);
  EXPECT_EQ(bin_of(edges, 0.39), 0u);
  EXPECT_EQ(bin_of(edges, 0.4), 1u);
  EXPECT_EQ(bin_of(edges, 1.2), 2u) << "in none";
  EXPECT_EQ(bin_of(edges, -0.1), 2u);
  EXPECT_EQ(bin_of(edges, 7), 2u);
}

// Computed by hand from (p + z^2/2n +- z sqrt(p (1-p) / n + z^2/4n^2)) / (1 + z^2/n).
TEST(Wilson, IsTheScoreInterval) {
  const auto [low, high] = wilson(8, 10);
  EXPECT_NEAR(low, 0.4902, 1e-4);
  EXPECT_NEAR(high, 0.9433, 1e-4);
  EXPECT_NEAR(wilson(0, 10).first, 0, 1e-12);
  EXPECT_NEAR(wilson(0, 10).second, 0.2775, 1e-4);
  EXPECT_NEAR(wilson(10, 10).second, 1, 1e-12);
  EXPECT_EQ(wilson(0, 0), std::pair(0.0, 1.0));
}

class GradedCurves : public testing::Test {
 protected:
  GradedCurves() : folder_(fs::temp_directory_path() / ("mh_graded_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    suite_ = made_up_suite(folder_, {"den", "nook"});
    suite_.environments[1].category = "nooks";
    suite_.graded = GradedSpec{.distance_m = {0, 1, 2}, .angle_deg = {0, 60}, .per_bin = 4};
  }
  ~GradedCurves() override { fs::remove_all(folder_); }

  /// Eight queries, the first four of them near. Answers `near` of the near ones and `far` of the
  /// others.
  RunResult run(const RunSpec& spec, int near, int far, double speed = 0) const {
    RunResult made = made_up_run(spec, {});
    made.points = {{}};
    for (int i = 0; i < 8; ++i) {
      QueryScore q;
      q.answer.index = static_cast<std::size_t>(i);
      q.grade.mapped_m = i < 4 ? 0.5 : 1.5;
      q.grade.mapped_deg = 10;
      q.grade.shown = 0.9;
      if (speed > 0) q.grade.speed = speed;
      q.success = i < 4 ? i < near : i - 4 < far;
      q.correct = q.success && i != 0;
      q.false_positive = q.success && i == 0;
      made.points[0].graded.push_back(q);
    }
    made.place.graded = {{0, 0, 4, 3}, {1, 0, 2, 1}};
    return made;
  }
  std::vector<RunResult> runs(double speed = 0) const {
    std::vector<RunResult> all;
    for (const RunSpec& spec : expand(suite_)) {
      const bool semantic = spec.system.kind == SystemKind::kSemantic;
      const bool den = spec.environment.name == "den";
      all.push_back(run(spec, 4, semantic ? 3 : den ? 1 : 2, speed));
    }
    return all;
  }

  fs::path folder_;
  Suite suite_;
};

TEST_F(GradedCurves, AreOverTheSameQueriesOfAllScenes) {
  const std::vector<RunResult> all = runs();
  const std::vector<Row> rows = make_rows(suite_, all);
  const std::vector<GradedCurve> curves = graded_curves(suite_, rows);
  ASSERT_EQ(curves.size(),
            5u);  // over distance, angle and share shown; over distance in each category
  const GradedCurve& distance = curves[0];
  EXPECT_EQ(distance.by, "distance");
  ASSERT_EQ(distance.bins.size(), 2u);
  const GradedBin& near = distance.bins[0];
  EXPECT_EQ(near.queries, 8u);
  EXPECT_EQ(near.systems[0]->success, 1);
  EXPECT_EQ(near.systems[0]->correct, 0.75);
  EXPECT_EQ(near.systems[0]->false_positive, 0.25);
  EXPECT_EQ(near.difference->difference, 0);
  const GradedBin& far = distance.bins[1];
  EXPECT_EQ(far.systems[0]->success, 6.0 / 8);
  EXPECT_EQ(far.systems[1]->success, 3.0 / 8);
  EXPECT_EQ(far.systems[1]->low, wilson(3, 8).first);
  EXPECT_DOUBLE_EQ(far.difference->difference, 3.0 / 8);
  EXPECT_EQ(curves[1].by, "angle");
  EXPECT_EQ(curves[1].bins[0].queries, 16u);
  ASSERT_EQ(curves[2].bins.size(), 1u) << "bins without queries are left out";
  EXPECT_EQ(curves[4].category, "rooms");
  EXPECT_EQ(curves[4].bins[1].systems[1]->success, 1.0 / 4);
}

TEST_F(GradedCurves, OverSpeedAreThereOnlyWhereSpeedsDiffer) {
  suite_.graded->speed = {1, 2, 3};
  const std::vector<RunResult> all = runs(3);
  const std::vector<GradedCurve> curves = graded_curves(suite_, make_rows(suite_, all));
  ASSERT_EQ(curves.size(), 6u);
  ASSERT_EQ(curves[3].by, "speed");
  ASSERT_EQ(curves[3].bins.size(), 1u);
  EXPECT_EQ(curves[3].bins[0].low, 2.5);
  EXPECT_EQ(curves[3].bins[0].high, 3.5);
}

TEST_F(GradedCurves, CountWhatTheMapCannotShowOncePerScene) {
  const std::vector<RunResult> all = runs();
  const GradedDraws draws = graded_draws(suite_, make_rows(suite_, all));
  EXPECT_EQ(draws.asked, 2 * 6u);
  EXPECT_EQ(draws.hidden, 2 * 4u);
  EXPECT_EQ(draws.cells, 4u);
  EXPECT_EQ(draws.short_cells, 2u);
}

TEST_F(GradedCurves, AreNoneWithoutGradedQueries) {
  suite_.graded.reset();
  const std::vector<RunResult> all = runs();
  EXPECT_TRUE(graded_curves(suite_, make_rows(suite_, all)).empty());
}

}  // namespace
}  // namespace mh
