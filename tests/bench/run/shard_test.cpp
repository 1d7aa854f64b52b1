// SPDX-License-Identifier: Apache-2.0
#include "bench/run/shard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/run/slurm.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

TEST(Shard, IsOneOfSoMany) {
  const auto read = [](const char* text) {
    const Shard shard = parse_shard(text);
    return std::pair(shard.index, shard.of);
  };
  EXPECT_EQ(read("1/1"), std::pair(std::size_t{1}, std::size_t{1}));
  EXPECT_EQ(read("2/3"), std::pair(std::size_t{2}, std::size_t{3}));
  EXPECT_EQ(read("10/10"), std::pair(std::size_t{10}, std::size_t{10}));
}

TEST(Shard, OfAnythingElseIsRefused) {
  for (const char* text : {"", "1", "/", "1/", "/3", "0/3", "4/3", "0/0", "-1/3", "1/-3", "1:3",
                           "1/3x", "1/3/5", "1.5/3", "a/b"})
    EXPECT_THROW(parse_shard(text), InputError) << text;
}

/// `runs` runs for each of `places` places whose images they see.
std::vector<PredictedCost> runs_in(int places, int runs, double images_s, double own_s) {
  std::vector<PredictedCost> all;
  for (int place = 0; place < places; ++place)
    for (int i = 0; i < runs; ++i) all.push_back({fmt::format("{}", place), images_s, own_s});
  return all;
}

/// Places with random numbers of runs and random costs.
std::vector<PredictedCost> random_runs(std::mt19937& random) {
  std::vector<PredictedCost> all;
  for (int place = 0; place < 4; ++place) {
    const double images_s = static_cast<double>(random() % 60);
    for (unsigned i = 0; i <= random() % 4; ++i)
      all.push_back({fmt::format("{}", place), images_s, 1.0 + static_cast<double>(random() % 20)});
  }
  return all;
}

double cost_s(const std::vector<PredictedCost>& runs, std::size_t begin, std::size_t end) {
  double sum_s = 0;
  for (std::size_t i = begin; i < end; ++i)
    sum_s +=
        runs[i].own_s + (i == begin || runs[i].images != runs[i - 1].images ? runs[i].images_s : 0);
  return sum_s;
}

/// The smallest sum of eighth powers over all splits of the runs from `begin` on, by exhaustive
/// search.
double least_sum(const std::vector<PredictedCost>& runs, std::size_t begin, std::size_t parts) {
  if (parts == 0) return begin == runs.size() ? 0 : std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t end = begin + 1; end <= runs.size(); ++end)
    least =
        std::min(least, std::pow(cost_s(runs, begin, end), 8) + least_sum(runs, end, parts - 1));
  return least;
}

std::vector<std::size_t> sizes(const std::vector<PredictedShare>& shares) {
  std::vector<std::size_t> found;
  for (const PredictedShare& share : shares) found.push_back(share.end - share.begin);
  return found;
}

TEST(Shares, HoldEveryRunExactlyOnceWhateverTheirNumber) {
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    const std::vector<PredictedCost> runs = random_runs(random);
    for (std::size_t parts = 1; parts <= runs.size() + 3; ++parts) {
      const std::vector<PredictedShare> shares = split_runs(runs, parts);
      ASSERT_EQ(shares.size(), parts);
      std::size_t next = 0;
      for (std::size_t i = 0; i < parts; ++i) {
        EXPECT_EQ(shares[i].begin, next);
        EXPECT_EQ(shares[i].end > shares[i].begin, i < runs.size()) << "none is empty needlessly";
        EXPECT_NEAR(shares[i].predicted_s, cost_s(runs, shares[i].begin, shares[i].end), 1e-9);
        next = shares[i].end;
      }
      EXPECT_EQ(next, runs.size());
    }
  }
  EXPECT_EQ(sizes(split_runs(std::vector<PredictedCost>{}, 2)), (std::vector<std::size_t>{0, 0}));
}

TEST(Shares, AreTheBestOfAllSplits) {
  std::mt19937 random(6);
  for (int round = 0; round < 20; ++round) {
    const std::vector<PredictedCost> runs = random_runs(random);
    for (std::size_t parts = 1; parts <= std::min<std::size_t>(5, runs.size()); ++parts) {
      double sum = 0;
      for (const PredictedShare& share : split_runs(runs, parts))
        sum += std::pow(share.predicted_s, 8);
      const double least = least_sum(runs, 0, parts);
      EXPECT_NEAR(sum, least, 1e-9 * least) << "sums in another order: rounding only";
    }
  }
}

TEST(Shares, OfEqualRunsHaveEqualNumbers) {
  for (const std::size_t parts : {2, 3, 5, 7, 24}) {
    const std::vector<std::size_t> numbers = sizes(split_runs(runs_in(1, 24, 50, 10), parts));
    const auto [least, most] = std::ranges::minmax(numbers);
    EXPECT_LE(most - least, 1u) << parts;
  }
}

TEST(Shares, KeepRunsOfTheSameImagesTogetherWhereTheyCan) {
  EXPECT_EQ(sizes(split_runs(runs_in(4, 6, 50, 10), 2)), (std::vector<std::size_t>{12, 12}));
  EXPECT_EQ(sizes(split_runs(runs_in(4, 6, 50, 10), 4)), (std::vector<std::size_t>{6, 6, 6, 6}));
  // Seven runs at the first place cost as much as one run and the images of the second place.
  std::vector<PredictedCost> uneven = runs_in(2, 7, 60, 10);
  uneven.resize(8);
  EXPECT_EQ(sizes(split_runs(uneven, 2)), (std::vector<std::size_t>{7, 1}));
  // With more shares than places, a place is split, and its images are made twice.
  const std::vector<PredictedShare> split = split_runs(runs_in(1, 8, 50, 10), 2);
  EXPECT_EQ(sizes(split), (std::vector<std::size_t>{4, 4}));
  EXPECT_DOUBLE_EQ(split[0].predicted_s, 90);
  EXPECT_DOUBLE_EQ(split[1].predicted_s, 90);
}

/// A run with at most 20 queries that maps along the tour.
RunSpec run_along(const std::string& tour) {
  RunSpec run;
  run.environment = {.name = tour,
                     .category = "room",
                     .scene = {},
                     .robot = {},
                     .mapping_tour = tour,
                     .query_tour = {}};
  run.points.resize(1);
  return run;
}

TEST(Shares, FollowTheLengthsOfTheTours) {
  const PredictedCost whole = predicted_cost(run_along("handheld:3:400"));
  EXPECT_NEAR(predicted_cost(run_along("handheld:3:800")).images_s, 2 * whole.images_s, 1e-9);
  EXPECT_NEAR(predicted_cost(run_along("handheld:3:800")).own_s, 2 * whole.own_s, 1e-9);
  EXPECT_NE(predicted_cost(run_along("handheld:4:400")).images, whole.images);
  RunSpec cut = run_along("handheld:3:400");
  cut.max_frames = 100;
  EXPECT_NEAR(predicted_cost(cut).own_s, whole.own_s / 4, 1e-9);
  RunSpec graded = run_along("handheld:3:400");
  graded.graded = GradedSpec{.distance_m = {0, 1, 2}, .angle_deg = {0, 30}, .per_bin = 100};
  EXPECT_NEAR(predicted_cost(graded).images_s, 1.5 * whole.images_s, 1e-9) << "200 of them";
  EXPECT_GT(predicted_cost(graded).own_s, whole.own_s);
  RunSpec recorded = run_along("");
  recorded.environment.sequence = "tum:somewhere";
  EXPECT_EQ(predicted_cost(recorded).images_s, 0);
  EXPECT_GT(predicted_cost(recorded).own_s, 0);
}

/// Cost of the most expensive share divided by that of the least expensive one.
double imbalance(const std::vector<std::string>& tours, int runs_of_each, std::size_t parts) {
  std::vector<RunSpec> runs;
  for (const std::string& tour : tours)
    for (int i = 0; i < runs_of_each; ++i) runs.push_back(run_along(tour));
  const std::vector<PredictedShare> shares = split_runs(runs, parts);
  const auto [least, most] = std::ranges::minmax(shares, {}, &PredictedShare::predicted_s);
  return most.predicted_s / least.predicted_s;
}

TEST(PredictedCost, ImagesAreThoseOfThePlaceWhateverTheLabels) {
  const RunSpec exact = run_along("handheld:3");
  RunSpec dose = exact;
  dose.labels = {LabelMode::kExact, LabelNoiseConfig{.enabled = true, .confusion = 0.25}, "dose"};
  EXPECT_EQ(images_of(dose), images_of(exact));
  dose.level.doses = {{"lens_blur.sigma_px", 1}};
  EXPECT_NE(images_of(dose), images_of(exact));
  dose.level = {.file = "another.yaml"};
  EXPECT_NE(images_of(dose), images_of(exact));
}
// Tests only numbers of shares into which the runs can be split evenly: images cost as much as four
// runs, and a share consists of whole runs.

TEST(Shares, OfTwentyFourRunsDifferByLessThanATenth) {
  for (const std::size_t parts : {2, 3, 4, 6, 8, 12})
    EXPECT_LT(imbalance({"handheld"}, 24, parts), 1.1) << parts;
  for (const std::size_t parts : {2, 4, 6})
    EXPECT_LT(imbalance({"handheld:0:430", "handheld:1:400"}, 12, parts), 1.1) << parts;
  for (const std::size_t parts : {2, 4, 8})
    EXPECT_LT(imbalance({"handheld:0", "handheld:1", "handheld:2", "handheld:3"}, 6, parts), 1.1)
        << parts;
}

TEST(SlurmTask, QuotesWhatTheShellWouldSplit) {
  const SlurmOptions slurm{.shares = 4, .sbatch = {}, .arguments = {"bench", "my suite.yaml"}};
  const std::string script = task_script("/opt/model house/modelhouse", "/data/it's mine", slurm);
  EXPECT_NE(script.find("'/opt/model house/modelhouse' 'bench' 'my suite.yaml' "
                        "--shard \"$share/4\" --out '/data/it'\\''s mine/slurm'\"/$share\"\n"),
            std::string::npos)
      << script;
}

}  // namespace
}  // namespace mh
