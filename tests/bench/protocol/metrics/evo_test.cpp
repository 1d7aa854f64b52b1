// SPDX-License-Identifier: Apache-2.0
// Our figures against those that `evo` computed for a real estimate on a real sequence. The data
// are not part of the project; without them the test is skipped.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/protocol/metrics/errors.hpp"
#include "bench/protocol/metrics/evaluate.hpp"
#include "slam/core/trajectory_io.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

class EvoReference : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path data = std::filesystem::path(MH_SOURCE_DIR) / ".." / "shared/data";
    const auto reference = data / "evo_reference/reference.json";
    if (!std::filesystem::exists(reference)) GTEST_SKIP() << "no " << reference;
    std::ifstream(reference) >> json_;
    truth_ = read_trajectory(data / "tum_fr1_rpy/groundtruth.txt");
    estimate_ = read_trajectory(data / "evo_reference/estimate.txt");
    matched_ = match_by_stamp(truth_, estimate_);
  }

  void expect_equal(const ErrorStatistics& ours, const std::string& name) {
    const nlohmann::json& evo = json_.at(name);
    ASSERT_EQ(evo.size(), 7U);
    const auto check = [&](double value, const char* field) {
      const double expected = evo.at(field);
      // 1e-15 allows for a rounding error of ours where evo has an exact zero.
      EXPECT_NEAR(value, expected, 1e-9 * std::abs(expected) + 1e-15) << name << ' ' << field;
    };
    check(ours.rmse, "rmse");
    check(ours.mean, "mean");
    check(ours.median, "median");
    check(ours.std, "std");
    check(ours.min, "min");
    check(ours.max, "max");
    check(ours.sse, "sse");
  }

  nlohmann::json json_;
  Trajectory truth_, estimate_;
  MatchedTrajectories matched_;
};

TEST_F(EvoReference, Association) {
  EXPECT_EQ(matched_.size(), json_.at("pairs").get<std::size_t>());
}

TEST_F(EvoReference, AbsoluteErrors) {
  expect_equal(ape_translation(truth_, estimate_, Alignment::kSe3), "ape_trans_se3");
  expect_equal(ape_translation(truth_, estimate_, Alignment::kSim3), "ape_trans_sim3");
  expect_equal(ape_translation(truth_, estimate_, Alignment::kNone), "ape_trans_none");
  expect_equal(ape_translation(truth_, estimate_, Alignment::kOrigin), "ape_trans_origin");
  expect_equal(ape_rotation(truth_, estimate_, Alignment::kSe3), "ape_rot_deg_se3");
}

TEST_F(EvoReference, RelativeErrors) {
  const RelativeErrors frame = rpe(matched_, {.value = 1, .unit = DeltaUnit::kFrames});
  expect_equal(error_statistics(frame.translation_m), "rpe_trans_1frame");
  expect_equal(error_statistics(frame.rotation_deg), "rpe_rot_deg_1frame");
  const RelativeErrors thirty =
      rpe(matched_, {.value = 30, .unit = DeltaUnit::kFrames, .all_pairs = true});
  expect_equal(error_statistics(thirty.translation_m), "rpe_trans_30frames_all_pairs");
  const RelativeErrors meters = rpe(matched_, {.value = 0.2, .unit = DeltaUnit::kMeters});
  expect_equal(error_statistics(meters.translation_m), "rpe_trans_0.2m_all_pairs");
}

TEST_F(EvoReference, TheReportHoldsTheSameFigures) {
  const Evaluation report = evaluate(truth_, estimate_);
  EXPECT_EQ(report.pairs, 200U);
  expect_equal(report.ape_translation_m, "ape_trans_se3");
  expect_equal(report.ape_rotation_deg, "ape_rot_deg_se3");
  expect_equal(report.ape_unaligned_m, "ape_trans_none");
  ASSERT_EQ(report.rpe.size(), 2U);
  expect_equal(report.rpe[0].translation_m, "rpe_trans_1frame");
  EXPECT_GT(report.rpe[1].translation_m.count, 150U);
}

}  // namespace
}  // namespace mh
