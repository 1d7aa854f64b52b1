// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bench/protocol/metrics/alignment.hpp"
#include "bench/protocol/metrics/errors.hpp"
#include "bench/protocol/metrics/evaluate.hpp"
#include "slam/core/random.hpp"
#include "slam/io/error.hpp"

namespace mh {
namespace {

constexpr Stamp kSecond = 1'000'000'000;
constexpr Stamp kMillisecond = 1'000'000;

TimedPose at(Stamp stamp_ns, double x, double y = 0, double z = 0, double yaw_deg = 0) {
  const double yaw = yaw_deg * std::numbers::pi / 180.0;
  return {stamp_ns, SE3(so3_exp({0, 0, yaw}), Eigen::Vector3d(x, y, z))};
}

/// One pose per second.
Trajectory every_second(std::vector<TimedPose> poses) {
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i].stamp_ns = static_cast<Stamp>(i) * kSecond;
  return poses;
}

Trajectory winding(std::size_t count) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = 0.1 * static_cast<double>(i);
    trajectory.push_back({static_cast<Stamp>(i) * kSecond / 10,
                          SE3(so3_exp({0.2 * std::sin(t), t, 0.1 * t}),
                              Eigen::Vector3d(std::cos(t), 0.3 * std::sin(2 * t), t))});
  }
  return trajectory;
}

const Similarity kSomewhereElse{
    .scale = 1, .rotation = so3_exp({0.4, -1.2, 0.7}), .translation_m = {3, -2, 0.5}};

TEST(ErrorStatistics, WorkedByHand) {
  const std::vector<double> errors = {3, 1, 2, 6};
  const ErrorStatistics s = error_statistics(errors);
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.sse, 50.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(3.5));  // mean of the squares (0 + 4 + 1 + 9) / 4
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 6.0);
  EXPECT_EQ(error_statistics({}).count, 0U);
  EXPECT_DOUBLE_EQ(error_statistics(std::vector<double>{5, 7, 6}).median, 6.0);
}

TEST(MatchByStamp, TakesTheNearestWithinTheLimit) {
  const Trajectory truth = {at(0, 0), at(10 * kMillisecond, 1), at(30 * kMillisecond, 2),
                            at(40 * kMillisecond, 3), at(100 * kMillisecond, 4)};
  const Trajectory estimate = {at(4 * kMillisecond, 10), at(35 * kMillisecond, 11),
                               at(110 * kMillisecond, 12), at(111 * kMillisecond, 13)};
  const MatchedTrajectories matched = match_by_stamp(truth, estimate);
  // 4 matches 0; 35 lies between 30 and 40 and matches the earlier of them; 110 is just near enough
  // to 100, 111 is not.
  ASSERT_EQ(matched.size(), 3U);
  ASSERT_EQ(matched.estimate.size(), 3U);
  const double truth_x[] = {0, 2, 4};
  const double estimate_x[] = {10, 11, 12};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(matched.truth[i].world_from_camera.translation().x(), truth_x[i]);
    EXPECT_EQ(matched.estimate[i].world_from_camera.translation().x(), estimate_x[i]);
  }
}

TEST(MatchByStamp, GivesNoPoseTwice) {
  // Estimates 5 ms apart all have the same nearest true pose: only the nearest of them is matched.
  const Trajectory truth = {at(0, 0), at(100 * kMillisecond, 1), at(200 * kMillisecond, 2),
                            at(300 * kMillisecond, 3)};
  const Trajectory estimate = {at(96 * kMillisecond, 10), at(101 * kMillisecond, 11),
                               at(106 * kMillisecond, 12)};
  const MatchedTrajectories matched = match_by_stamp(truth, estimate);
  ASSERT_EQ(matched.size(), 1U);
  EXPECT_EQ(matched.estimate[0].stamp_ns, 101 * kMillisecond);
}

TEST(MatchByStamp, WalksThroughTheShorterOne) {
  const Trajectory truth = {at(0, 0), at(100 * kMillisecond, 1)};
  const Trajectory estimate = {at(1 * kMillisecond, 10), at(99 * kMillisecond, 11),
                               at(200 * kMillisecond, 12)};
  const MatchedTrajectories matched = match_by_stamp(truth, estimate);
  ASSERT_EQ(matched.size(), 2U);
  EXPECT_EQ(matched.truth[1].stamp_ns, 100 * kMillisecond);
  EXPECT_EQ(matched.estimate[1].stamp_ns, 99 * kMillisecond);
  EXPECT_EQ(match_by_stamp(truth, {}).size(), 0U);
  EXPECT_EQ(match_by_stamp({}, estimate).size(), 0U);
}

TEST(Align, RecoversATransformExactly) {
  const Trajectory truth = winding(50);
  for (const double scale : {1.0, 0.25}) {
    Similarity moved = kSomewhereElse;
    moved.scale = scale;
    // truth = moved * estimate, so the estimate is made with the inverse.
    const Similarity inverse{
        .scale = 1 / scale,
        .rotation = moved.rotation.transpose(),
        .translation_m = -(moved.rotation.transpose() * moved.translation_m) / scale};
    const MatchedTrajectories matched{truth, transformed(inverse, truth)};
    const auto found = align(matched, Alignment::kSim3);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->scale, scale, 1e-12);
    EXPECT_LT((found->rotation - moved.rotation).norm(), 1e-12);
    EXPECT_LT((found->translation_m - moved.translation_m).norm(), 1e-12);
    const MatchedTrajectories aligned{truth, transformed(*found, matched.estimate)};
    EXPECT_LT(error_statistics(ape_translation_m(aligned)).max, 1e-12);
    EXPECT_LT(error_statistics(ape_rotation_deg(aligned)).max, 1e-6);  // limited by rounding in log
  }
}

TEST(Align, IsTheLeastSquaresMinimum) {
  const Trajectory truth = winding(40);
  Trajectory estimate = transformed(kSomewhereElse, truth);
  const RandomStream noise(3);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const Eigen::Vector3d shift(noise.normal(3 * i), noise.normal(3 * i + 1),
                                noise.normal(3 * i + 2));
    estimate[i].world_from_camera = SE3(estimate[i].world_from_camera.rotation(),
                                        estimate[i].world_from_camera.translation() + 0.1 * shift);
  }
  const MatchedTrajectories matched{truth, estimate};
  const auto sse = [&](const Similarity& s) {
    return error_statistics(ape_translation_m({truth, transformed(s, estimate)})).sse;
  };
  const Similarity rigid = *align(matched, Alignment::kSe3);
  const Similarity scaled = *align(matched, Alignment::kSim3);
  EXPECT_EQ(rigid.scale, 1.0);
  EXPECT_NEAR(rigid.rotation.determinant(), 1.0, 1e-12);
  EXPECT_LT(sse(scaled), sse(rigid));
  for (int k = 0; k < 3; ++k)
    for (const double h : {-1e-4, 1e-4}) {
      Similarity other = rigid;
      other.translation_m[k] += h;
      EXPECT_GT(sse(other), sse(rigid));
      other = rigid;
      other.rotation = so3_exp(h * Eigen::Vector3d::Unit(k)) * rigid.rotation;
      EXPECT_GT(sse(other), sse(rigid));
      other = scaled;
      other.scale += h;
      EXPECT_GT(sse(other), sse(scaled));
    }
}

TEST(Align, NeverMirrors) {
  const Trajectory truth = winding(30);
  Trajectory mirrored = truth;
  for (TimedPose& pose : mirrored) {
    Eigen::Vector3d t = pose.world_from_camera.translation();
    t.x() = -t.x();
    pose.world_from_camera = SE3(pose.world_from_camera.rotation(), t);
  }
  const auto found = align({truth, mirrored}, Alignment::kSe3);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->rotation.determinant(), 1.0, 1e-12);
}

TEST(Align, HasNoAnswerForPointsOnALine) {
  const Trajectory line = every_second({at(0, 0), at(0, 1), at(0, 2), at(0, 5)});
  const Trajectory still = every_second({at(0, 1), at(0, 1), at(0, 1)});
  EXPECT_FALSE(align({line, line}, Alignment::kSe3));
  EXPECT_FALSE(align({still, still}, Alignment::kSim3));
  EXPECT_FALSE(align({}, Alignment::kNone));
  EXPECT_TRUE(align({line, line}, Alignment::kOrigin));
  EXPECT_EQ(ape_translation(line, line, Alignment::kSe3).count, 0U);
  EXPECT_EQ(ape_translation(line, line, Alignment::kNone).count, 4U);
}

TEST(Ape, WorkedByHand) {
  // A square; the estimate is shifted by (3, 4, 0) at one corner and turned by 10 degrees at
  // another.
  const Trajectory truth = every_second({at(0, 0), at(0, 10), at(0, 10, 10), at(0, 0, 10)});
  const Trajectory estimate =
      every_second({at(0, 0), at(0, 13, 4), at(0, 10, 10, 0, 10), at(0, 0, 10)});
  const ErrorStatistics translation = ape_translation(truth, estimate, Alignment::kNone);
  EXPECT_DOUBLE_EQ(translation.max, 5.0);
  EXPECT_DOUBLE_EQ(translation.sse, 25.0);
  EXPECT_DOUBLE_EQ(translation.mean, 1.25);
  const ErrorStatistics rotation = ape_rotation(truth, estimate, Alignment::kNone);
  EXPECT_NEAR(rotation.max, 10.0, 1e-12);
  EXPECT_NEAR(rotation.mean, 2.5, 1e-12);
}

TEST(Ape, IsBlindToTheFrameAfterAlignment) {
  const Trajectory truth = winding(60);
  Trajectory estimate = winding(60);
  const RandomStream noise(5);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    Vector6d step;
    for (int k = 0; k < 6; ++k)
      step[k] = 0.02 * noise.normal(6 * i + static_cast<std::uint64_t>(k));
    estimate[i].world_from_camera = SE3::exp(step) * estimate[i].world_from_camera;
  }
  const Trajectory moved = transformed(kSomewhereElse, estimate);
  const ErrorStatistics a = ape_translation(truth, estimate, Alignment::kSe3);
  const ErrorStatistics b = ape_translation(truth, moved, Alignment::kSe3);
  EXPECT_GT(a.rmse, 0.01);
  EXPECT_NEAR(a.rmse, b.rmse, 1e-12);
  EXPECT_NEAR(ape_rotation(truth, estimate, Alignment::kSe3).rmse,
              ape_rotation(truth, moved, Alignment::kSe3).rmse, 1e-9);
  // Relative errors do not depend on the alignment.
  const RelativeErrors c = rpe({truth, estimate}, {.value = 2});
  const RelativeErrors d = rpe({truth, moved}, {.value = 2});
  ASSERT_EQ(c.translation_m.size(), 29U);
  for (std::size_t i = 0; i < 29; ++i) {
    EXPECT_NEAR(c.translation_m[i], d.translation_m[i], 1e-12);
    EXPECT_NEAR(c.rotation_deg[i], d.rotation_deg[i], 1e-9);
  }
}

TEST(DeltaPairs, WorkedByHand) {
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  const Trajectory t = every_second({at(0, 0), at(0, 1), at(0, 3), at(0, 6), at(0, 7)});
  EXPECT_EQ(delta_pairs(t, {.value = 2}), (Pairs{{0, 2}, {2, 4}}));
  EXPECT_EQ(delta_pairs(t, {.value = 2, .all_pairs = true}), (Pairs{{0, 2}, {1, 3}, {2, 4}}));
  EXPECT_EQ(delta_pairs(t, {.value = 3}), (Pairs{{0, 3}}));
  EXPECT_EQ(delta_pairs(t, {.value = 5}), Pairs{});
  // 3 m apart: 0 and 2. From 1, no pose is within the tolerance: 2 m is off by 1 m, 5 m by 2 m.
  // Then 2 and 3; from 3, only 1 m is left.
  EXPECT_EQ(delta_pairs(t, {.value = 3, .unit = DeltaUnit::kMeters}), (Pairs{{0, 2}, {2, 3}}));
  // 1.5 m apart, to within a third: 0 and 1 (1 m is nearest), 1 and 2 (2 m), 3 and 4 (1 m).
  EXPECT_EQ(delta_pairs(t, {.value = 1.5, .unit = DeltaUnit::kMeters, .tolerance = 0.34}),
            (Pairs{{0, 1}, {1, 2}, {3, 4}}));
  EXPECT_EQ(delta_pairs(t, {.value = 2, .unit = DeltaUnit::kSeconds}),
            (Pairs{{0, 2}, {1, 3}, {2, 4}}));
  // 1.5 s is equally far from 1 s and 2 s: the earlier pose is taken, provided that the tolerance
  // allows it.
  EXPECT_EQ(delta_pairs(t, {.value = 1.5, .unit = DeltaUnit::kSeconds, .tolerance = 0.4}),
            (Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}}));
  EXPECT_EQ(delta_pairs(t, {.value = 1.5, .unit = DeltaUnit::kSeconds}), Pairs{});
  EXPECT_EQ(delta_pairs({}, {.value = 1}), Pairs{});
  EXPECT_EQ(delta_pairs({}, {.value = 1, .unit = DeltaUnit::kMeters}), Pairs{});
  EXPECT_THROW(delta_pairs(t, {.value = 1.5}), InputError);
  EXPECT_THROW(delta_pairs(t, {.value = 0}), InputError);
  EXPECT_THROW(delta_pairs(t, {.value = -1, .unit = DeltaUnit::kSeconds}), InputError);
}

TEST(DeltaPairs, StandingStillTakesTheFirstPoseThatIsFarEnough) {
  const Trajectory t = every_second({at(0, 0), at(0, 1), at(0, 1), at(0, 1), at(0, 2)});
  const auto pairs = delta_pairs(t, {.value = 1, .unit = DeltaUnit::kMeters});
  ASSERT_EQ(pairs.size(), 4U);
  EXPECT_EQ(pairs[0].second, 1U);
  EXPECT_EQ(pairs[1].second, 4U);
}

TEST(Rpe, WorkedByHand) {
  // The true path goes 1 m per step along x; the estimate goes 1.1 m per step and turns by 2
  // degrees in place, so that its next meter has a different direction.
  const Trajectory truth = every_second({at(0, 0), at(0, 1), at(0, 2)});
  Trajectory estimate = every_second({at(0, 0), at(0, 0), at(0, 0)});
  const SE3 step = SE3(so3_exp({0, 0, 2 * std::numbers::pi / 180}), Eigen::Vector3d(1.1, 0, 0));
  for (std::size_t i = 1; i < 3; ++i)
    estimate[i].world_from_camera = estimate[i - 1].world_from_camera * step;
  const RelativeErrors one = rpe({truth, estimate}, {.value = 1});
  ASSERT_EQ(one.translation_m.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(one.translation_m[i], 0.1, 1e-12);
    EXPECT_NEAR(one.rotation_deg[i], 2.0, 1e-9);
  }
  const RelativeErrors two = rpe({truth, estimate}, {.value = 2});
  const double a = 2 * std::numbers::pi / 180;
  ASSERT_EQ(two.translation_m.size(), 1U);
  EXPECT_NEAR(two.translation_m[0], std::hypot(1.1 + 1.1 * std::cos(a) - 2.0, 1.1 * std::sin(a)),
              1e-12);
  EXPECT_NEAR(two.rotation_deg[0], 4.0, 1e-9);
}

TEST(Evaluate, ReportsAPerfectEstimate) {
  const Trajectory truth = winding(100);
  const Evaluation report = evaluate(truth, transformed(kSomewhereElse, truth));
  EXPECT_EQ(report.pairs, 100U);
  EXPECT_EQ(report.truth_poses, 100U);
  EXPECT_LT(report.ape_translation_m.max, 1e-12);
  EXPECT_GT(report.ape_unaligned_m.min, 0.5);
  EXPECT_NEAR(report.truth_path_m, report.estimate_path_m, 1e-10);
  EXPECT_GT(report.truth_path_m, 10.0);
  ASSERT_EQ(report.rpe.size(), 2U);
  EXPECT_EQ(report.rpe[0].translation_m.count, 99U);
  EXPECT_GE(report.rpe[1].translation_m.count,
            90U);  // the 91st pair is 0.9 s apart, exactly at the tolerance
  EXPECT_LT(report.rpe[1].translation_m.max, 1e-12);
}

TEST(Evaluate, ReportsAnEstimateThatMatchesNothing) {
  const Trajectory truth = winding(10);
  for (const Trajectory& estimate : {Trajectory{}, Trajectory{at(kSecond * 100, 1)}}) {
    const Evaluation report = evaluate(truth, estimate);
    EXPECT_EQ(report.pairs, 0U);
    EXPECT_EQ(report.ape_translation_m.count, 0U);
    EXPECT_FALSE(report.truth_from_estimate);
    ASSERT_EQ(report.rpe.size(), 2U);
    EXPECT_EQ(report.rpe[0].translation_m.count, 0U);
  }
}

}  // namespace
}  // namespace mh
