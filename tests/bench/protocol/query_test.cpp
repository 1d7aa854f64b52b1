// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/query.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "bench/protocol/query_means.hpp"
#include "bench/protocol/run_result.hpp"
#include "bench/protocol/score.hpp"
#include "tests/bench/protocol/fake_system.hpp"

namespace mh {
namespace {

FakeSystem mapped() {
  FakeSystem system([](Stamp, int) { return true; });
  map_sequence(system, fake_frames(300), {}, RandomStream(1));
  system.freeze();
  return system;
}

TEST(TestFrames, AreTheLastOfEveryThirty) {
  EXPECT_EQ(test_frames(100, {}), (std::vector<std::size_t>{29, 59, 89}));
}

TEST(Query, StopsAtTheFirstPoseThatComesBack) {
  FakeSystem system = mapped();
  system.answers_at = [](Stamp) { return 3; };
  const QueryAnswer answer = query(system, 59, fake_frames(300), {}, RandomStream(1));
  ASSERT_TRUE(answer.world_from_camera);
  EXPECT_EQ(answer.attempts, 3);
  EXPECT_EQ(answer.blank_frames, 1);
  EXPECT_EQ(answer.stage, RelocalizationStage::kVerified);
  EXPECT_EQ(answer.candidates.c2, 4);
}

/// The noise and the random draws that a system sees in two queries of five attempts each, if it
/// answers none.
struct Streams {
  std::set<std::uint64_t> noise, draws;
};
Streams streams_of(Attempts attempts) {
  FakeSystem system = mapped();
  system.answers_at = [](Stamp) { return 0; };
  Streams seen;
  const MadeSequence spy(
      300,
      [&](std::size_t index, RandomStream stream) {
        seen.noise.insert(stream.key());
        return fake_frame(index, stream);
      },
      fake_camera());
  system.on_query = [&](RandomStream stream) { seen.draws.insert(stream.key()); };
  ProtocolConfig config;
  config.attempts = attempts;
  for (const std::size_t index : {29, 59}) query(system, index, spy, config, RandomStream(1));
  return seen;
}

TEST(Query, AttemptsRepeatTheSameFrameAndOnlyTheDrawsDiffer) {
  const Streams seen = streams_of(ProtocolConfig{}.attempts);
  EXPECT_EQ(seen.noise.size(), 2u);        // one for each query
  EXPECT_EQ(seen.draws.size(), 10u + 2u);  // for each attempt and each query's blank frame
}

TEST(Query, WithNewNoiseEachAttemptAtEachFrameHasItsOwnNoiseAndDraws) {
  const Streams seen = streams_of(Attempts::kNewNoise);
  EXPECT_EQ(seen.noise.size(), 10u);
  EXPECT_EQ(seen.draws.size(), 10u + 2u);
}

TEST(Query, TheFirstAttemptIsTheSameWithNewNoiseAndWithout) {
  const FakeSystem system = mapped();
  ProtocolConfig config;
  const auto first = [&](Attempts attempts) {
    config.attempts = attempts;
    return query(system, 59, fake_frames(300), config, RandomStream(1)).image_digest;
  };
  EXPECT_EQ(first(Attempts::kSameFrame), first(Attempts::kNewNoise));
}

TEST(Query, GivesUpAfterFiveAttemptsAndNamesTheStage) {
  FakeSystem system = mapped();
  system.answers_at = [](Stamp) { return 6; };
  const QueryAnswer answer = query(system, 59, fake_frames(300), {}, RandomStream(1));
  EXPECT_FALSE(answer.world_from_camera);
  EXPECT_EQ(answer.attempts, 5);
  EXPECT_EQ(answer.stage, RelocalizationStage::kMatches);
}

TEST(Query, CandidatesAreThoseOfTheFirstAttemptAndPairsAreSummed) {
  FakeSystem system = mapped();
  system.answers_at = [](Stamp) { return 3; };
  system.on_report = [](int attempt, SystemReport& report) {
    report.candidates.final = 10 + attempt;
    report.matches.emplace();
    (*report.matches)[2].compared = attempt;
  };
  const QueryAnswer answer = query(system, 59, fake_frames(300), {}, RandomStream(1));
  EXPECT_EQ(answer.candidates.final, 11);
  ASSERT_TRUE(answer.matches);
  EXPECT_EQ((*answer.matches)[2].compared, 1 + 2 + 3);
  // If the first attempt reports no candidates, the query has none.
  system.on_report = [](int attempt, SystemReport& report) {
    if (attempt == 1) report.candidates = {};
  };
  EXPECT_EQ(query(system, 59, fake_frames(300), {}, RandomStream(1)).candidates, Candidates{});
}

TEST(Query, TheDigestOfMatchingIsOfEveryAttempt) {
  FakeSystem system = mapped();
  system.answers_at = [](Stamp) { return 3; };
  std::set<std::uint64_t> seen;
  for (const int changed : {0, 1, 2, 3}) {  // 0: no attempt is changed
    system.on_report = [&](int attempt, SystemReport& report) {
      if (attempt != changed) return;
      report.matches.emplace();
      (*report.matches)[0].compared = 1;
    };
    seen.insert(query(system, 59, fake_frames(300), {}, RandomStream(1)).matching_digest);
  }
  EXPECT_EQ(seen.size(), 4u);
}

TEST(Query, TheDigestsOfPosesAndImagesAreOfEveryAttempt) {
  FakeSystem system = mapped();
  system.answers_at = [](Stamp) { return 3; };
  ProtocolConfig new_noise;
  new_noise.attempts = Attempts::kNewNoise;
  std::set<std::uint64_t> poses, images;
  for (const int changed :
       {0, 1, 2}) {  // 0: no attempt is changed; the pose of a lost system counts, too
    system.on_report = [&](int attempt, SystemReport& report) {
      if (attempt == changed) report.world_from_camera = SE3();
    };
    poses.insert(query(system, 59, fake_frames(300), {}, RandomStream(1)).pose_digest);
    int shown = 0;
    const MadeSequence tampered(
        300,
        [&](std::size_t index, RandomStream noise) {
          RgbdFrame frame = fake_frame(index, noise);
          if (++shown == changed) frame.color(0, 0).b = 255;
          return frame;
        },
        fake_camera());
    images.insert(query(system, 59, tampered, new_noise, RandomStream(1)).image_digest);
  }
  EXPECT_EQ(poses.size(), 3u);
  EXPECT_EQ(images.size(), 3u);
}

TEST(Query, ShowsBlankFramesUntilLost) {
  FakeSystem system = mapped();
  system.believes_blanks = 4;
  EXPECT_EQ(query(system, 59, fake_frames(300), {}, RandomStream(1)).blank_frames, 5);
  system.believes_blanks = 1000;
  EXPECT_EQ(query(system, 59, fake_frames(300), {}, RandomStream(1)).blank_frames, 30);
}

TEST(Query, PermutingTheQueriesChangesNothing) {
  FakeSystem system = mapped();
  system.answers_at = [](Stamp frame) { return static_cast<int>(frame / 30 % 6); };
  const auto ask = [&](std::vector<std::size_t> order) {
    std::map<std::size_t, std::pair<std::uint64_t, std::uint64_t>> answers;
    for (const std::size_t index : order) {
      const QueryAnswer a = query(system, index, fake_frames(300), {}, RandomStream(9));
      answers[index] = {a.pose_digest, a.image_digest};
    }
    return answers;
  };
  std::vector<std::size_t> order = test_frames(300, {});
  const auto forwards = ask(order);
  std::reverse(order.begin(), order.end());
  EXPECT_EQ(forwards, ask(order));
  std::rotate(order.begin(), order.begin() + 3, order.end());
  EXPECT_EQ(forwards, ask(order));
  // The comparison could fail: different queries do get different answers.
  EXPECT_NE(forwards.at(29), forwards.at(59));
}

/// A pose 1 m above the origin's plane, with this heading.
SE3 at(double x, double y, double yaw) {
  return {Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
          Eigen::Vector3d(x, y, 1.0)};
}

TEST(LocalTruth, ADriftOfTheWholeMapIsNoError) {
  const SE3 drift = at(3.0, -2.0, 0.4);
  const SE3 anchor = at(1, 2, 0.3), query_truth = at(1.1, 2.0, 0.35);
  const SE3 expected = local_truth({drift * anchor, anchor, 0}, query_truth);
  const SE3 error = expected.inverse() * (drift * query_truth);
  EXPECT_LT(error.log().norm(), 1e-12);
}

TEST(NearestMapped, IsNextInTimeOrNextInPlaceAndHeading) {
  const Trajectory truth = {
      {0, at(0, 0, 0)}, {10, at(1, 0, 0)}, {20, at(0.1, 0, 3.0)}, {30, at(5, 0, 0)}};
  const Trajectory estimate = {truth[0], truth[1], truth[2]};  // frame 30 was never mapped
  const TimedPose query{26, at(0.2, 0, 0)};
  EXPECT_EQ(nearest_mapped(estimate, truth, query, NearestBy::kTime)->stamp_ns, 20);
  // Frame 20 is nearest in place but faces away (3 rad count as 3 m); frame 0 is 0.2 m off.
  EXPECT_EQ(nearest_mapped(estimate, truth, query, NearestBy::kPlace)->stamp_ns, 0);
  EXPECT_FALSE(nearest_mapped({}, truth, query, NearestBy::kTime));
}

TEST(NearestMapped, IsTheSameWhereverTheWorldHasItsOrigin) {
  for (const double east : {0.0, 7.0, -7.0})
    for (const double north : {0.0, 40.0, -40.0})
      for (const double turn : {0.0, 1.0, -2.5}) {
        const SE3 world = at(east, north, turn);
        const Trajectory truth = {{0, world * at(-1, 0, 0)},
                                  {10, world * at(0.5, 0, 0)},
                                  {20, world * at(0, 0.4, 0)},
                                  {30, world * at(0, 0, 0.45)}};
        const auto nearest = [&](const SE3& query) {
          return nearest_mapped(truth, truth, {99, world * query}, NearestBy::kPlace)->stamp_ns;
        };
        EXPECT_EQ(nearest(at(0, 0, 0)), 20) << "0.4 m before 0.45 rad";
        EXPECT_EQ(nearest(at(0, 0, 0.1)), 30) << "0.35 rad before 0.4 m and 0.1 rad";
        EXPECT_EQ(nearest(at(-0.6, 0, 0)), 0);
        EXPECT_EQ(nearest(at(0.6, 0.1, 0)), 10);
      }
}

TEST(NearestMapped, OfEquallyNearFramesTheEarlierIsTakenAndBeforeIsAsNearAsAfter) {
  const Trajectory truth = {
      {100, at(1, 0, 0)}, {200, at(-1, 0, 0)}, {300, at(0, 0, 2)}, {400, at(0, -1, 0)}};
  const auto in_time = [&](Stamp stamp_ns) {
    return nearest_mapped(truth, truth, {stamp_ns, SE3()}, NearestBy::kTime)->stamp_ns;
  };
  // Exactly at a frame, exactly between two, a nanosecond to either side, before all, after all.
  for (const auto& [asked, expected] : std::map<Stamp, Stamp>{{-5, 100},
                                                              {0, 100},
                                                              {100, 100},
                                                              {150, 100},
                                                              {151, 200},
                                                              {249, 200},
                                                              {250, 200},
                                                              {251, 300},
                                                              {350, 300},
                                                              {400, 400},
                                                              {9000, 400}})
    EXPECT_EQ(in_time(asked), expected) << asked;
  // Three of the frames are equally near, 1 m away: the first of them is taken.
  EXPECT_EQ(nearest_mapped(truth, truth, {250, at(0, 0, 0)}, NearestBy::kPlace)->stamp_ns, 100);
}

TEST(InterpolatedPose, LiesBetweenItsNeighborsInTime) {
  constexpr Stamp kMs = 1'000'000;
  const Trajectory estimate = {
      {0, at(0, 0, 0)}, {100 * kMs, at(1, 2, 0.4)}, {700 * kMs, at(5, 5, 1.0)}};
  const auto quarter = interpolated_pose(estimate, 25 * kMs);
  ASSERT_TRUE(quarter);
  EXPECT_LT((quarter->inverse() * at(0.25, 0.5, 0.1)).log().norm(), 1e-12);
  const auto exact = interpolated_pose(estimate, 100 * kMs);
  ASSERT_TRUE(exact);
  EXPECT_LT((exact->inverse() * at(1, 2, 0.4)).log().norm(), 1e-12);
  EXPECT_FALSE(interpolated_pose(estimate, 300 * kMs)) << "neighbors 0.6 s apart";
  EXPECT_FALSE(interpolated_pose(estimate, 701 * kMs)) << "nothing after it";
  EXPECT_FALSE(interpolated_pose({}, 0));
}

TEST(FindAnchor, ComparesWithWhatTheProtocolAsksFor) {
  constexpr Stamp kMs = 1'000'000;
  // The robot speeds up: halfway in time, it has moved only 0.2 m. The map as a whole is 10 m off.
  const Trajectory truth = {{0, at(0, 0, 0)}, {50 * kMs, at(0.2, 0, 0)}, {100 * kMs, at(1, 0, 0)}};
  const Trajectory estimate = {{0, at(10, 0, 0)}, {100 * kMs, at(11, 0, 0)}};
  const auto expected = [&](NearestBy by, QueryTruth what) {
    ProtocolConfig config;
    config.truth = what;
    const auto anchor = find_anchor(estimate, truth, truth[1], by, config);
    return local_truth(*anchor, truth[1].world_from_camera).translation().x();
  };
  EXPECT_NEAR(expected(NearestBy::kTime, QueryTruth::kLocal), 10.2, 1e-12);
  EXPECT_NEAR(expected(NearestBy::kTime, QueryTruth::kInterpolated), 10.5, 1e-12);
  EXPECT_NEAR(expected(NearestBy::kPlace, QueryTruth::kInterpolated), 10.2, 1e-12);
  ProtocolConfig config;
  config.truth = QueryTruth::kInterpolated;
  const TimedPose beyond{120 * kMs, at(1.1, 0, 0)};
  const auto anchor = find_anchor(estimate, truth, beyond, NearestBy::kTime, config);
  ASSERT_TRUE(anchor) << "without a neighbor after it: the local truth";
  EXPECT_NEAR(local_truth(*anchor, beyond.world_from_camera).translation().x(), 11.1, 1e-12);
}

TEST(Score, ADriftedMapIsRightWhereItIsRightLocally) {
  const SE3 drift = at(3.0, -2.0, 0.4);
  const TimedPose truth{0, at(1.1, 2.0, 0.35)};
  const Anchor anchor{drift * at(1, 2, 0.3), at(1, 2, 0.3), 0};
  QueryAnswer answer;
  answer.world_from_camera = drift * truth.world_from_camera;
  const QueryScore s = score(answer, truth, anchor, SE3(), {});
  EXPECT_TRUE(s.correct);
  EXPECT_NEAR(s.distance_m.value(), 0, 1e-12);
  EXPECT_GT(s.aligned_distance_m.value(), 1.0);  // no global alignment undoes the drift here
}

// Worked out by hand. The anchor's estimate is at (10, 0) and looks along y; in truth it was at the
// origin and looked along x. From there the query is 2 m ahead: (10, 2) in the map. The answer is
// 0.12 m to the side of that and 0.16 m above. The alignment shifts everything by -9 in x: the
// answer moves to (1.12, 2), which is sqrt(0.88^2 + 2^2 + 0.16^2) from the true (2, 0).
TEST(Score, DistanceAngleAndAlignedDistanceAreThoseWorkedByHand) {
  const double right_angle = std::numbers::pi / 2;
  const Anchor anchor{at(10, 0, right_angle), at(0, 0, 0), 0};
  const TimedPose truth{0, at(2, 0, 0)};
  QueryAnswer answer;
  answer.world_from_camera =
      SE3(at(10.12, 2, right_angle + 0.05).rotation(), Eigen::Vector3d(10.12, 2, 1.16));
  const SE3 truth_from_estimate(Eigen::Matrix3d::Identity(), Eigen::Vector3d(-9, 0, 0));
  const QueryScore s = score(answer, truth, anchor, truth_from_estimate, {});
  EXPECT_NEAR(s.distance_m.value(), 0.2, 1e-12);
  EXPECT_NEAR(s.angle_deg.value(), 0.05 * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(s.aligned_distance_m.value(), std::sqrt(0.88 * 0.88 + 4 + 0.16 * 0.16), 1e-12);
  EXPECT_TRUE(s.correct);
}

// Only the largest map is aligned with the truth: an answer in another map has only a local
// distance.
TEST(Score, OnlyAnswersInTheLargestMapHaveAnAlignedDistance) {
  RunResult run;
  run.alignment.truth_from_estimate = SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(-9, 0, 0));
  run.estimate = {{0, at(9, 0, 0), 2}, {1, at(10, 0, 0), 2}};
  run.elsewhere = {{5, at(0, 0, 0), 1}};
  QueryAnswer answer;
  answer.world_from_camera = at(9.5, 0, 0);
  for (const std::uint32_t map : {2, 1}) {
    answer.map = map;
    const Anchor anchor{at(9.5, 0, 0), at(0.5, 0, 0), 0};
    const QueryScore s = score(run, answer, {0, at(0.5, 0, 0)}, anchor);
    EXPECT_TRUE(s.correct);
    EXPECT_EQ(s.distance_m.value(), 0);
    EXPECT_EQ(s.aligned_distance_m.has_value(), map == 2);
  }
}

// Both limits are inclusive.
TEST(Score, AnAnswerAtExactlyTheLimitsIsCorrect) {
  ProtocolConfig config;
  config.correct_distance_m = 0.25;
  const Anchor anchor{SE3(), SE3(), 0};
  QueryAnswer answer;
  const auto correct = [&](double x_m) {
    answer.world_from_camera = SE3(Eigen::Matrix3d::Identity(), Eigen::Vector3d(x_m, 0, 0));
    return score(answer, {0, SE3()}, anchor, SE3(), config).correct;
  };
  config.correct_angle_deg = 0;
  EXPECT_TRUE(correct(0.25));
  EXPECT_FALSE(correct(std::nextafter(0.25, 1.0)));
}

TEST(Score, TellsCorrectFromWrong) {
  const ProtocolConfig config;
  const TimedPose truth{0, at(0, 0, 0)};
  const Anchor anchor{at(0, 0, 0), at(0, 0, 0), 0};
  const auto with = [&](std::optional<SE3> estimate) {
    QueryAnswer answer;
    answer.world_from_camera = estimate;
    return score(answer, truth, anchor, SE3(), config);
  };
  const QueryScore good = with(at(0.2, 0, 0.1));
  EXPECT_TRUE(good.success && good.correct && !good.false_positive);
  EXPECT_NEAR(good.distance_m.value(), 0.2, 1e-12);
  EXPECT_NEAR(good.angle_deg.value(), 5.7296, 1e-3);
  const QueryScore far = with(at(0.3, 0, 0));
  EXPECT_TRUE(far.success && !far.correct && far.false_positive);
  const QueryScore turned = with(at(0, 0, 0.2));
  EXPECT_TRUE(turned.success && !turned.correct && turned.false_positive);
  const QueryScore none = with(std::nullopt);
  EXPECT_TRUE(!none.success && !none.correct && !none.false_positive);
}

TEST(InterpolatedPose, OfTheTruthIsNotThatOfAFrameWhosePoseIsInvalid) {
  constexpr Stamp kMs = 1'000'000;
  // 100 Hz as from a tracking system, then 30 Hz without the frame at 133 ms.
  const Trajectory truth = {{0, at(0, 0, 0)},
                            {10 * kMs, at(1, 0, 0)},
                            {100 * kMs, at(2, 0, 0)},
                            {166 * kMs, at(3, 0, 0)}};
  ASSERT_TRUE(moment_of(4 * kMs, &truth).true_world_from_camera);
  EXPECT_NEAR(moment_of(4 * kMs, &truth).true_world_from_camera->translation().x(), 0.4, 1e-12);
  EXPECT_TRUE(moment_of(100 * kMs, &truth).true_world_from_camera);
  EXPECT_FALSE(moment_of(133 * kMs, &truth).true_world_from_camera);
  EXPECT_FALSE(moment_of(0, nullptr).true_world_from_camera);
}

TEST(NearestMapped, AsksTheTruthBetweenItsOwnMoments) {
  constexpr Stamp kMs = 1'000'000;
  const Trajectory truth = {{0, at(0, 0, 0)}, {10 * kMs, at(1, 0, 0)}, {20 * kMs, at(2, 0, 0)}};
  const Trajectory estimate = {{5 * kMs, at(7, 0, 0)}, {300 * kMs, at(9, 0, 0)}};
  const auto anchor = nearest_mapped(estimate, truth, {16 * kMs, at(1.6, 0, 0)}, NearestBy::kTime);
  ASSERT_TRUE(anchor);
  EXPECT_EQ(anchor->stamp_ns, 5 * kMs);
  EXPECT_NEAR(local_truth(*anchor, at(1.6, 0, 0)).translation().x(), 8.1, 1e-12);
}

TEST(Score, WithoutATruthAnAnswerIsASuccessAndNothingElse) {
  QueryAnswer answer;
  answer.world_from_camera = at(5, 5, 0);
  const QueryMoment unknown(50'000'000, std::nullopt);
  const Trajectory estimate = {{0, at(5, 4.9, 0)}, {100'000'000, at(5, 5.1, 0)}};
  ProtocolConfig config;
  EXPECT_FALSE(find_anchor(estimate, {}, unknown, NearestBy::kTime, config));
  const QueryScore s = score(answer, unknown, std::nullopt, SE3(), config);
  EXPECT_TRUE(s.success && !s.correct && !s.false_positive && !is_judged(s));
  EXPECT_FALSE(s.distance_m || s.angle_deg || s.aligned_distance_m);
  // The paper's own method needs no ground truth.
  config.truth = QueryTruth::kInterpolated;
  const auto anchor = find_anchor(estimate, {}, unknown, NearestBy::kTime, config);
  const QueryScore judged = score(answer, unknown, anchor, SE3(), config);
  EXPECT_TRUE(judged.correct && is_judged(judged));
  EXPECT_NEAR(judged.distance_m.value(), 0, 1e-12);
  EXPECT_FALSE(judged.aligned_distance_m);
}

TEST(Score, AnAnswerWithoutAnyMapIsFalseAndItsDistanceUnknown) {
  QueryAnswer answer;
  answer.world_from_camera = at(5, 5, 0);
  const QueryScore s = score(answer, {0, at(0, 0, 0)}, std::nullopt, SE3(), {});
  EXPECT_TRUE(s.success && !s.correct && s.false_positive);
  EXPECT_FALSE(s.distance_m || s.angle_deg || s.aligned_distance_m);
}

TEST(QueryScore, APlaceIsInTheMapWhereAFrameWasMapped) {
  const auto at = [](Stamp stamp, double x, double turn) {
    return TimedPose{stamp, {so3_exp({0, 0, turn}), Eigen::Vector3d(x, 0, 0)}};
  };
  const Trajectory truth{at(0, 0, 0), at(10, 5, 0), at(20, 10, 1)};
  // The map may lie anywhere; only which frames it contains matters.
  const Trajectory estimate{at(0, 70, 2), at(20, 90, 2)};
  const auto is = [&](const TimedPose& query) {
    return is_in_map(estimate, truth, query).value_or(false);
  };
  EXPECT_TRUE(is(at(5, 0.99, 0)));
  EXPECT_FALSE(is(at(5, 1.01, 0)));
  EXPECT_FALSE(is(at(10, 5, 0))) << "this frame was not mapped";
  EXPECT_TRUE(is(at(15, 10, 1.5)));
  EXPECT_FALSE(is(at(15, 10, 1.6)));
  EXPECT_FALSE(is_in_map({}, truth, at(0, 0, 0)).value());
  EXPECT_FALSE(is_in_map(estimate, truth, QueryMoment(0, std::nullopt)).has_value());
}

TEST(QueryScore, SuccessInTheMapIsAmongThoseWhosePlaceIsThere) {
  std::vector<QueryScore> queries(5);
  queries[0].in_map = queries[1].in_map = queries[2].in_map = true;
  queries[3].in_map = false;  // it stays unknown for the fifth query
  queries[0].success = queries[3].success = queries[4].success = true;
  const QuerySummary s = summarize(queries);
  EXPECT_DOUBLE_EQ(s.in_map.value(), 0.75);
  EXPECT_DOUBLE_EQ(s.success_in_map.value(), 1.0 / 3);
  EXPECT_FALSE(summarize(std::vector<QueryScore>(2)).in_map);
}

}  // namespace
}  // namespace mh
