// SPDX-License-Identifier: Apache-2.0
// How an episode that ended in a given state is judged.
#include "bench/protocol/episodes/judge.hpp"

#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kArrival_m = 1.0;

/// A sofa from x = 6 to 8 and y = 4 to 6 m; the path to it from (1, 5) is 4 m long.
EpisodeStart to_the_sofa() {
  return {.index = 3,
          .place_m = {1, 5},
          .heading_rad = 90 * kDegree,
          .goal = "sofa",
          .boxes = {{{6, 4}, {8, 6}}},
          .walls = std::make_shared<const TrueWalls>(test::empty_room(), 1.21),
          .shortest_m = 4};
}

EpisodeScore judged(const EpisodeEnd& end, std::optional<double> located_s = 2.0,
                    const EpisodeStart& start = to_the_sofa()) {
  EpisodeScore score = score_at_start("dim", start);
  score.located_s = located_s;
  judge(end, start, kArrival_m, score);
  return score;
}

/// An episode that ended with a reported arrival at a place and a correct belief about the pose.
EpisodeEnd arrived_at(double x_m, double y_m, double length_m = 5) {
  const Pose2 at{{x_m, y_m}, 0};
  return {.state = NavigatorState::kArrived, .truth = at, .belief = at, .length_m = length_m};
}

TEST(ScoreAtStart, HoldsWhereTheRobotIsPutAndWhatItIsToFind) {
  const EpisodeScore score = score_at_start("dim", to_the_sofa());
  EXPECT_EQ(score.variant, "dim");
  EXPECT_EQ(score.start, 3U);
  EXPECT_EQ(score.goal, "sofa");
  EXPECT_EQ(score.start_x_m, 1);
  EXPECT_EQ(score.start_y_m, 5);
  EXPECT_DOUBLE_EQ(score.start_heading_deg, 90);
  EXPECT_EQ(score.shortest_m, 4);
  EXPECT_EQ(score.end_distance_m, 5);
  EXPECT_FALSE(score.success || score.said_arrived || score.wrong_arrival);
  EXPECT_EQ(score.spl, 0);
}

TEST(Judge, SplIsTheShortestWayByTheDrivenOne) {
  EXPECT_DOUBLE_EQ(judged(arrived_at(5.5, 5, 5)).spl, 0.8);
  EXPECT_DOUBLE_EQ(judged(arrived_at(5.5, 5, 16)).spl, 0.25);
  EXPECT_EQ(judged(arrived_at(5.5, 5, 3.5)).spl, 1) << "a shorter way than the shortest is no gain";
  EpisodeEnd stuck = arrived_at(5.5, 5, 5);
  stuck.state = NavigatorState::kStuck;
  EXPECT_EQ(judged(stuck).spl, 0);
  EXPECT_EQ(judged(stuck).length_m, 5);
}

TEST(Judge, ASuccessIsAnArrivalThatItSaidNoFartherThanArrival) {
  const EpisodeScore near = judged(arrived_at(5, 5));  // 1 m from the sofa
  EXPECT_TRUE(near.success && near.said_arrived);
  EXPECT_FALSE(near.wrong_arrival);
  EXPECT_EQ(near.reason, "");
  EXPECT_EQ(near.end_distance_m, 1);

  const EpisodeScore far = judged(arrived_at(4.99, 5));
  EXPECT_FALSE(far.success);
  EXPECT_TRUE(far.said_arrived && far.wrong_arrival);
  EXPECT_EQ(far.reason, "wrong_arrival");
  EXPECT_EQ(far.spl, 0);
  EXPECT_DOUBLE_EQ(far.end_distance_m, 1.01);

  EpisodeEnd silent = arrived_at(5.5, 5);
  silent.state = NavigatorState::kDriving;
  const EpisodeScore score = judged(silent);
  EXPECT_FALSE(score.success || score.said_arrived || score.wrong_arrival);
  EXPECT_EQ(score.reason, "time_out");
}

TEST(Judge, BehindAWallNobodyHasArrived) {
  EpisodeStart start = to_the_sofa();
  Scene scene = test::empty_room();
  test::add_box(scene, "wall between", {5.5F, 3, 0}, {5.6F, 7, 2.5F});
  for (std::size_t f = scene.class_of.size() - 12; f < scene.class_of.size(); ++f)
    scene.class_of[f] = *class_by_name("wall");
  start.walls = std::make_shared<const TrueWalls>(scene, 1.21);
  const EpisodeScore score = judged(arrived_at(5.2, 5), 2.0, start);
  EXPECT_EQ(score.reason, "wrong_arrival");
  EXPECT_DOUBLE_EQ(score.end_distance_m, 0.8);
}

TEST(Judge, TheNearestOfSeveralThingsCounts) {
  EpisodeStart start = to_the_sofa();
  start.boxes.push_back({{0, 0}, {1, 1}});
  const EpisodeScore score = judged(arrived_at(1.5, 1), 2.0, start);
  EXPECT_TRUE(score.success);
  EXPECT_EQ(score.end_distance_m, 0.5);
}

TEST(Judge, OfContactsTheWorstIsToldAndTheFastAreCollisions) {
  const std::vector<Bump> bumps{{.speed_m_per_s = 0.05},
                                {.speed_m_per_s = 0.3},
                                {.speed_m_per_s = 0.1},
                                {.speed_m_per_s = 0.101}};
  EpisodeEnd end = arrived_at(5.5, 5);
  end.bumps = bumps;
  const EpisodeScore score = judged(end);
  EXPECT_EQ(score.contacts, 4);
  EXPECT_EQ(score.collisions, 2) << "0.1 m/s is none yet";
  EXPECT_EQ(score.worst_contact_m_per_s, 0.3);
  EXPECT_TRUE(score.success) << "a success all the same";
  EXPECT_EQ(judged(arrived_at(5.5, 5)).worst_contact_m_per_s, 0);
}

TEST(Judge, ABeliefIsFalseIfItIsTooFarOffOrTurnedTooMuch) {
  const Pose2 truth{{3, 3}, 170 * kDegree};
  const auto reason = [&](double x_m, double turned_deg) {
    EpisodeEnd end{.state = NavigatorState::kStuck, .truth = truth, .length_m = 1};
    end.belief = Pose2{{3 + x_m, 3}, truth.heading_rad + turned_deg * kDegree};
    return judged(end).reason;
  };
  EXPECT_EQ(reason(0, 0), "stuck");
  EXPECT_EQ(reason(0.5, 0), "stuck");
  EXPECT_EQ(reason(0.51, 0), "false_pose");  // one of the two errors is enough
  EXPECT_EQ(reason(-0.51, 0), "false_pose");
  EXPECT_EQ(reason(0, 19.9), "stuck") << "across the full circle";
  EXPECT_EQ(reason(0, 20.1), "false_pose");
  EXPECT_EQ(reason(0, -20.1), "false_pose");
  EXPECT_EQ(reason(0.51, 20.1), "false_pose");
}

TEST(Judge, TheErrorOfTheLastBeliefIsTold) {
  EpisodeEnd end = arrived_at(5.5, 5);
  end.belief->place_m += Eigen::Vector2d(0.3, 0.4);
  end.belief->heading_rad = 15 * kDegree;
  EXPECT_DOUBLE_EQ(*judged(end).last_error_m, 0.5);
  EXPECT_DOUBLE_EQ(error_of(*end.belief, end.truth).turned_rad, 15 * kDegree);
  end.belief.reset();
  EXPECT_FALSE(judged(end).last_error_m.has_value());
}

TEST(Judge, EachFailureHasItsReason) {
  const auto reason = [](NavigatorState state, std::optional<double> located_s) {
    EpisodeEnd end = arrived_at(2, 5);
    end.state = state;
    return judged(end, located_s).reason;
  };
  using enum NavigatorState;
  EXPECT_EQ(reason(kArrived, 2.0), "wrong_arrival");
  EXPECT_EQ(reason(kNoPath, 2.0), "no_path");
  EXPECT_EQ(reason(kStuck, 2.0), "stuck");
  EXPECT_EQ(reason(kStuck, {}), "stuck");
  EXPECT_EQ(reason(kCollided, 2.0), "collision_stop");
  EXPECT_EQ(reason(kDriving, 2.0), "time_out");
  EXPECT_EQ(reason(kLooking, 2.0), "time_out") << "lost again";
  EXPECT_EQ(reason(kExploring, {}), "never_relocalized");
  // A false belief is the reason for everything that follows from it.
  EpisodeEnd misled = arrived_at(2, 5);
  misled.belief->place_m.x() = 5.5;
  EXPECT_EQ(judged(misled).reason, "false_pose");
  EXPECT_TRUE(judged(misled).wrong_arrival);
}

}  // namespace
}  // namespace mh
