// SPDX-License-Identifier: Apache-2.0
#include "bench/protocol/episodes/starts.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "bench/suite/suite.hpp"
#include "scenes/load.hpp"
#include "slam/io/error.hpp"
#include "tests/sim/boxes.hpp"

namespace mh {
namespace {

constexpr const char* kSuite = R"(
name: k
robot: pepper
environments: [{category: bathroom, scene: "generated:bathroom:0"}]
vocabulary: vocabulary
levels: [pepper]
systems: [plain]
labels: [exact]
episodes:
)";

std::string refusal(const std::string& episodes) {
  try {
    parse_suite(kSuite + episodes, "k.yaml", {}, false);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(EpisodesSpec, IsReadAndItsMistakesAreNamed) {
  const Suite suite = parse_suite(std::string(kSuite) +
                                      "  starts: 3\n  goals: [refrigerator, bed]\n  variants:\n"
                                      "  - {name: as_mapped}\n  - {name: dim, level: ideal}\n",
                                  "k.yaml", {}, false);
  ASSERT_TRUE(suite.episodes);
  EXPECT_EQ(suite.episodes->starts, 3U);
  EXPECT_EQ(suite.episodes->goals, (std::vector<std::string>{"refrigerator", "bed"}));
  ASSERT_EQ(suite.episodes->variants.size(), 2U);
  EXPECT_TRUE(suite.episodes->variants[1].level);

  const std::string typo = refusal("  goals: [refrigratr]\n");
  EXPECT_NE(typo.find("'refrigratr' is not a class of objects"), std::string::npos) << typo;
  EXPECT_NE(typo.find("did you mean 'refrid"), std::string::npos) << typo;
  EXPECT_NE(refusal("  goals: []\n").find("at least one"), std::string::npos);
  EXPECT_NE(refusal("  goals: [bed]\n  starts: 0\n").find("starts"), std::string::npos);
  EXPECT_NE(refusal("  goals: [bed]\n  variants: [{name: a}, {name: a}]\n").find("is listed twice"),
            std::string::npos);
  EXPECT_NE(refusal("  goals: [bed]\n  limit_s: 5\n  dark_s: 5\n").find("leaves nothing of"),
            std::string::npos);
  EXPECT_NE(refusal("  goals: [bed]\n  sleep: 1\n").find("sleep"), std::string::npos);
}

Scene room_with_a_bed() {
  Scene scene = test::empty_room();
  test::add_box(scene, "bed", {7, 7, 0}, {9, 9, 0.5F});
  for (std::size_t f = scene.class_of.size() - 12; f < scene.class_of.size(); ++f)
    scene.class_of[f] = *class_by_name("bed");
  scene.instances.back().class_id = *class_by_name("bed");
  return scene;
}

TEST(DrawStarts, AreOnTheFloorAndKnowTheShortestWay) {
  const Scene scene = room_with_a_bed();
  const Robot robot = test::pepper();
  const EpisodesSpec spec{.goals = {"toilet", "bed"}, .starts = 12};
  const std::vector<EpisodeStart> starts = draw_starts(spec, scene, robot);
  ASSERT_EQ(starts.size(), 12U);
  for (const EpisodeStart& start : starts) {
    EXPECT_EQ(start.goal, "bed");  // there is no toilet
    const double away_m = distance_to(start.boxes, start.place_m);
    EXPECT_GE(away_m, 0.3);
    EXPECT_GE(start.shortest_m, away_m - spec.arrival_m - 0.06);
    EXPECT_LE(start.shortest_m, 1.15 * (away_m - spec.arrival_m) + 2.0);
  }
  EXPECT_GT((starts[0].place_m - starts[1].place_m).norm(), 0.05);
  const std::vector<EpisodeStart> fewer =
      draw_starts({.goals = {"toilet", "bed"}, .starts = 3}, scene, robot);
  for (std::size_t i = 0; i < fewer.size(); ++i) EXPECT_EQ(fewer[i].place_m, starts[i].place_m);
  EXPECT_THROW(draw_starts({.goals = {"toilet"}, .starts = 1}, scene, robot), InputError);
}

/// A bed and a sideboard are flush against the two sides of a 10 cm wall that ends before x = 8 m.
Scene room_with_a_bed_behind_a_wall() {
  Scene scene = test::empty_room();
  const auto add = [&](const char* name, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
    test::add_box(scene, name, low, high);
    scene.instances.back().class_id = *class_by_name(name);
    std::fill(scene.class_of.end() - 12, scene.class_of.end(), *class_by_name(name));
  };
  add("wall", {0, 5, 0}, {8, 5.1F, 2.5F});
  add("bed", {3, 5.1F, 0}, {5, 7, 0.5F});
  add("cabinet", {3, 4.6F, 0}, {5, 5, 0.8F});
  return scene;
}

TEST(DrawStarts, NobodyArrivesThroughAWall) {
  const std::vector<EpisodeStart> starts = draw_starts(
      {.goals = {"bed"}, .starts = 40}, room_with_a_bed_behind_a_wall(), test::pepper());
  const EpisodeStart& start = starts.front();
  EXPECT_FALSE(is_arrival(start, {4, 4.2}, 1.0));  // 0.9 m away, behind the sideboard and the wall
  EXPECT_FALSE(is_arrival(start, {2.6, 4.7}, 1.0));
  EXPECT_TRUE(is_arrival(start, {4, 7.9}, 1.0));
  EXPECT_TRUE(is_arrival(start, {2.6, 5.4}, 1.0));  // beside the bed, along the wall
  EXPECT_FALSE(is_arrival(start, {4, 8.1}, 1.0));
  int behind = 0;
  for (const EpisodeStart& drawn : starts)
    if (drawn.place_m.y() < 5) {
      ++behind;  // around the end of the wall, then to 1 m beside the bed
      const double to_gap_m = (drawn.place_m - Eigen::Vector2d(8, 5)).norm();
      EXPECT_GE(drawn.shortest_m, to_gap_m + 2.0 - 0.1);
    }
  EXPECT_GT(behind, 5);
}

TEST(DrawStarts, NobodyArrivesFromAnotherRoomOfTheModelHouse) {
  const Scene scene = load_scene(MH_SOURCE_DIR "/scenes/model_house/house.yaml");
  const auto room_of = [&](const Eigen::Vector2d& place_m) {
    return std::ranges::find_if(scene.rooms,
                                [&](const Room& room) { return room.contains(place_m); });
  };
  for (const char* goal : {"refrigerator", "sofa", "bed", "desk"}) {
    const EpisodeStart start =
        draw_starts({.goals = {goal}, .starts = 1}, scene, test::pepper()).front();
    ASSERT_EQ(start.boxes.size(), 1U) << goal;
    const auto own = room_of(0.5 * (start.boxes[0].first + start.boxes[0].second));
    ASSERT_NE(own, scene.rooms.end()) << goal;
    int arrived = 0;
    for (double y_m = 0.05; y_m < 8; y_m += 0.1)
      for (double x_m = 0.05; x_m < 10; x_m += 0.1) {
        const Eigen::Vector2d place_m(x_m, y_m);
        const auto room = room_of(place_m);
        if (room == scene.rooms.end() || distance_to(start.boxes, place_m) > 1) continue;
        arrived += is_arrival(start, place_m, 1.0) ? 1 : 0;
        EXPECT_TRUE(room == own || !is_arrival(start, place_m, 1.0)) << goal << x_m << " " << y_m;
        EXPECT_TRUE(room != own || is_arrival(start, place_m, 1.0)) << goal << x_m << " " << y_m;
      }
    EXPECT_GT(arrived, 50) << goal;
  }
}

}  // namespace
}  // namespace mh
