// SPDX-License-Identifier: Apache-2.0
// 200 real Kinect frames as an environment of a suite, with the example odometry next to our
// system.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/results/rows.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/core/digest.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// Expects that two runs estimated the same trajectory and gave the same answers, to the bit.
void expect_same(const RunResult& a, const RunResult& b) {
  EXPECT_EQ(digest(a.estimate), digest(b.estimate));
  const std::vector<QueryScore>&x = a.points.front().held_out, &y = b.points.front().held_out;
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_EQ(x[i].answer.pose_digest, y[i].answer.pose_digest) << i;
}

class TumFr1RpySuite : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path source = MH_SOURCE_DIR;
    if (!fs::exists(source / "../shared/data/tum_fr1_rpy/associations.txt"))
      GTEST_SKIP() << "tum_fr1_rpy is not here";
    folder_ = fs::temp_directory_path() / fmt::format("mh_rpy_{}", getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }

  Suite suite(const std::string& systems, const std::string& more = "",
              const std::string& slam = "{}") const {
    const fs::path source = MH_SOURCE_DIR;
    std::ofstream(folder_ / "rpy.yaml")
        << "environments:\n- {category: desk, sequence: 'tum:${recordings}/tum_fr1_rpy', settings: "
        << (source / "assets/cameras/tum_freiburg1.yaml").string()
        << "}\nvocabulary: " << (source / "assets/vocabulary.mhvoc").string()
        << "\nlabels: [none]\nsystems: " << systems << "\nslam: " << slam << "\n"
        << more;
    return load_suite(folder_ / "rpy.yaml",
                      {.set = {{"recordings", (source / "../shared/data").string()}}});
  }
  RunResult run(const RunSpec& spec) const {
    const fs::path out = folder_ / spec.name;
    fs::create_directories(out);
    const World world = build_world(spec, 1, Cache(), [](std::string_view) {});
    return run_one(spec, world, {.folder = out, .occupancy = false});
  }

  fs::path folder_;
};

// The original ORB-SLAM2 tracks all 200 frames with an ATE of 0.0257 m.
TEST_F(TumFr1RpySuite, AllFramesAreMappedAsWellAsBySlam) {
  const Suite all = suite("[plain]", "protocol: {test_interval: 0}\n");
  const std::vector<RunSpec> specs = expand(all);
  ASSERT_EQ(specs.size(), 1U);
  EXPECT_EQ(specs[0].name, "plain-recorded-0");
  const RunResult result = run(specs[0]);
  EXPECT_EQ(result.trajectory.tracked, 200U);
  EXPECT_LE(result.trajectory.ate_rmse_m.value(), 0.0164);
  fmt::print("plain, all 200 frames: ATE {:.4f} m\n", *result.trajectory.ate_rmse_m);
}

TEST_F(TumFr1RpySuite, TheReadoutTimeOfTheShippedCalibrationCounts) {
  const auto ate_m = [&](const char* slam) {
    const std::vector<RunSpec> specs =
        expand(suite("[plain]", "protocol: {test_interval: 0}\n", slam));
    return run(specs.front()).trajectory.ate_rmse_m.value();
  };
  const double by_calibration = ate_m("{}"), off = ate_m("{track: {readout_s: 0}}");
  fmt::print("ATE {:.4f} m with the calibration's readout time, {:.4f} m without\n", by_calibration,
             off);
  EXPECT_EQ(by_calibration, ate_m("{track: {readout_s: 0.0261}}"));
  EXPECT_LT(by_calibration, off);
}

TEST_F(TumFr1RpySuite, HeldOutFramesAreFoundAndAnotherSystemStandsBesideInAllThreeWays) {
  const Suite all = suite("[plain, {name: vo, protocol: trajectory, command: 'exec " VO_RUN_DATASET
                          " {dataset} {associations} {settings} {trajectory}'}, "
                          "{name: vo_asked, protocol: conversation, command: 'exec " VO_CONVERSE
                          "'}, {name: vo_called, library: '" VO_LIBRARY "'}]");
  std::vector<RunResult> runs;
  for (const RunSpec& spec : expand(all)) runs.push_back(run(spec));
  ASSERT_EQ(runs.size(), 4U);
  for (const RunResult& run : runs) {
    const QuerySummary s = summarize(run.points.front().held_out);
    fmt::print(
        "{}: completeness {:.3f}, ATE {:.4f} m, {} queries: success {:.2f}, correct {:.2f}, "
        "mean {:.4f} m\n",
        run.spec.system.name, run.trajectory.completeness, run.trajectory.ate_rmse_m.value_or(-1),
        s.queries, s.success, s.correct.value_or(-1), s.distance_mean_m.value_or(-1));
    EXPECT_GT(run.trajectory.completeness, 0.9);
    EXPECT_LT(run.trajectory.ate_rmse_m.value(), 0.1);
  }
  const QuerySummary ours = summarize(runs[0].points.front().held_out);
  EXPECT_EQ(ours.queries, 6);
  EXPECT_GE(ours.correct.value(), 5.0 / 6);
  EXPECT_LT(ours.distance_mean_m.value(), 0.05);
  EXPECT_EQ(summarize(runs[1].points.front().held_out).queries, 0) << "a trajectory is not asked";
  EXPECT_EQ(summarize(runs[2].points.front().held_out).queries, 6);
  expect_same(runs[3], runs[2]);
}

}  // namespace
}  // namespace mh
