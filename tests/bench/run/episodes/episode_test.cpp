// SPDX-License-Identifier: Apache-2.0
// Kidnappings from start to end, in a small room.
#include "bench/run/episodes/episode.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/run/episodes/report.hpp"
#include "bench/run/episodes/run_episodes.hpp"
#include "bench/run/episodes/strip.hpp"
#include "bench/run/run_one.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

Suite small_suite(const std::string& robot = "pepper",
                  const std::string& systems = "[semantic, plain]",
                  const std::string& more = "labels: [exact]\n") {
  const std::string root = MH_SOURCE_DIR;
  return parse_suite("name: small\nrobot: " + root + "/robots/" + robot + "/" + robot + R"(.yaml
environments:
- {category: room, scene: )" +
                         root + "/bench/scenarios/room.yaml, mapping_tour: " + root +
                         R"(/bench/scenarios/tours/room.yaml}
vocabulary: )" + root + R"(/assets/vocabulary.mhvoc
levels: [)" + root + R"(/sim/sensors/levels/pepper.yaml]
episodes: {starts: 2, limit_s: 90, goals: [sofa]}
systems: )" + systems + "\n" +
                         more,
                     fs::path(root) / "small.yaml");
}

TEST(Episodes, TheSameBitsAtOneAndAtTwoJobsAndResumed) {
  const Suite suite = small_suite();
  const TemporaryFolder work(fs::temp_directory_path());
  EpisodeOptions options;
  options.cache = work.path() / "cache";
  const auto run = [&](const char* name, int jobs, std::optional<std::size_t> starts) {
    options.out = work.path() / name;
    fs::create_directories(options.out);
    options.jobs = jobs;
    options.starts = starts;
    return run_episodes(suite, options);
  };
  const std::vector<EpisodeRun> once = run("one", 1, {});
  ASSERT_EQ(once.size(), 2U);
  run("two", 1, 1);  // the first start alone; the same command then resumes
  const std::vector<EpisodeRun> again = run("two", 2, {});
  EXPECT_EQ(episodes_json(suite, once).dump(), episodes_json(suite, again).dump());
  for (const EpisodeRun& r : once)
    for (const EpisodeScore& score : r.scores) {
      EXPECT_NE(score.digest, 0U);
      EXPECT_EQ(score.collisions, 0);
      EXPECT_EQ(score.success, score.reason.empty());
      EXPECT_LE(score.spl, 1.0);
    }
  // Semantic and plain are put at the same places.
  for (std::size_t s = 0; s < 2; ++s)
    EXPECT_EQ(once[0].scores[s].start_x_m, once[1].scores[s].start_x_m);
  EXPECT_TRUE(std::ranges::any_of(once[0].scores, &EpisodeScore::success))
      << episodes_table(suite, once);
  EXPECT_NE(episodes_table(suite, once).find("semantic"), std::string::npos);
}

TEST(Episodes, AProgramThatEndsFailsAloneAndIsTriedAgain) {
  const Suite suite =
      small_suite("pepper", "[{name: broken, protocol: conversation, command: 'exit 7'}, plain]");
  const TemporaryFolder work(fs::temp_directory_path());
  EpisodeOptions options;
  options.cache = work.path() / "cache";
  options.out = work.path();
  options.starts = 1;
  for (int attempt = 0; attempt < 2; ++attempt) {
    const std::vector<EpisodeRun> runs = run_episodes(suite, options);
    ASSERT_EQ(runs.size(), 2U);
    EXPECT_NE(runs[0].failure.find("exited with code 7"), std::string::npos) << runs[0].failure;
    ASSERT_EQ(runs[0].scores.size(), 1U);
    EXPECT_EQ(runs[0].scores[0].reason, "system_failed");
    EXPECT_EQ(runs[1].failure, "");
    EXPECT_NE(runs[1].scores.at(0).digest, 0U);
    EXPECT_NE(episodes_table(suite, runs).find("1 system_failed"), std::string::npos);
  }
}

TEST(Episodes, AnExitCodeAtTheEndOfAConversationIsReported) {
  // Lost in every frame, and not content with that in the end.
  const Suite suite = small_suite("pepper", R"y([{name: sulking, protocol: conversation, command: "
    sed -u -E 's/^.\"id\":([0-9]+),\"do\":\"hello.*/{\"id\":\\1,\"protocol\":1}/; t;
    s/^.\"id\":([0-9]+),\"do\":\"(freeze|rewind|reset).*/{\"id\":\\1}/; t;
    s/^.\"id\":([0-9]+).*/{\"id\":\\1,\"pose\":null}/'; exit 5"}])y");
  const TemporaryFolder work(fs::temp_directory_path());
  EpisodeOptions options;
  options.out = work.path();
  const std::vector<EpisodeRun> runs = run_episodes(suite, options);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_NE(runs[0].failure.find("exited with code 5"), std::string::npos) << runs[0].failure;
  ASSERT_EQ(runs[0].scores.size(), 2U);
  for (const EpisodeScore& score : runs[0].scores) EXPECT_EQ(score.reason, "no_map");
}

TEST(Episodes, WhatCanOnlyFailIsRefusedBeforeTheWork) {
  const auto expect_refused = [](const Suite& suite, const char* why) {
    try {
      episode_runs(suite);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  Suite suite = small_suite();
  suite.episodes->goals = {"sofa", "wall"};
  expect_refused(suite, "'wall' is never an object");
  expect_refused(small_suite("pepper", "[plain]", "labels: [none]\n"), "labels: 'none'");
  expect_refused(small_suite("pepper", "[plain]", "labels: [exact]\ntrials: 2\n"), "trials: 2");
  expect_refused(
      small_suite("pepper", "[{name: paths, protocol: trajectory, command: 'cp x {trajectory}'}]"),
      "only returns a trajectory");
  suite = small_suite();
  suite.levels.push_back(suite.levels.front());
  expect_refused(suite, "levels: 2");
  suite = small_suite();
  suite.sweep.points.assign(2, suite.slam);
  expect_refused(suite, "parameters:");
  suite = small_suite();
  suite.environments.front().mapping_tour = "handheld:0:30";
  expect_refused(suite, "mapping_tour: 'handheld:0:30' is not driven by a robot");
}

TEST(Episodes, WithoutAMapEachFailsAndSaysSo) {
  const Suite suite = small_suite();
  const RunSpec run = labeled(episode_runs(suite).front(), suite);
  const EpisodeWorld world = build_episode_world(run, *suite.episodes, 2, Cache(), {});
  const Trajectory nothing;
  MappedSystem mapped;  // as a system leaves it that tracked no frame
  mapped.map = build_robot_map({.frames = *world.mapping,
                                .estimate = nothing,
                                .robot = world.world.simulated->robot,
                                .noise = RandomStream(0)});
  ASSERT_TRUE(mapped.map.empty());
  mapped.system = make_system(run, world.world, {});
  const EpisodeStart& start = world.variants.front().starts.front();
  const EpisodeScore score = run_episode(episode_place(run, world, world.variants.front(), mapped),
                                         *suite.episodes, start);
  EXPECT_FALSE(score.success);
  EXPECT_EQ(score.reason, "no_map");
  EXPECT_GT(EpisodeRecord(mapped.map, start).strip("plain, start 0", score).total(), 0U);
}

TEST(Episodes, ARobotWithoutLasersOrWheelsIsRefused) {
  Suite suite = small_suite();
  const TemporaryFolder work(fs::temp_directory_path());
  const fs::path pepper = suite.environments.front().robot;
  const std::string text = read_file(pepper);
  const auto replaced = [](std::string in, const std::string& old, const std::string& by) {
    return in.replace(in.find(old), old.size(), by);
  };
  const std::string wheels =
      "  wheels:\n    joints: [WheelFL, WheelFR, WheelB]\n    radius_m: 0.07 ";
  const std::string afoot = replaced(replaced(text, wheels, " "), "urdf: pepper.urdf",
                                     "urdf: " + (pepper.parent_path() / "pepper.urdf").string());
  for (const auto& [robot, lacks] :
       {std::pair(text.substr(0, text.find("equipment:")), "lasers"), std::pair(afoot, "wheels")}) {
    write_atomically(work.path() / "robot.yaml", robot);
    suite.environments.front().robot = work.path() / "robot.yaml";
    try {
      build_episode_world(labeled(episode_runs(suite).front(), suite), *suite.episodes, 2, Cache(),
                          {});
      ADD_FAILURE() << "was taken without " << lacks;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("has no ") + lacks), std::string::npos)
          << error.what();
    }
  }
}

TEST(Episodes, GoalsThatNoPlaceHasAreRefusedBeforeTheWork) {
  Suite suite = small_suite("pepper", "[plain]");
  suite.environments.push_back(suite.environments.front());
  suite.environments.back().name = "bathroom";
  suite.environments.back().scene = "generated:bathroom:0";
  const TemporaryFolder work(fs::temp_directory_path());
  EpisodeOptions options;
  options.out = work.path();
  options.say = [](std::string_view stage) {
    EXPECT_EQ(stage.find("maps the tour"), std::string_view::npos) << stage;
  };
  try {
    run_episodes(suite, options);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bathroom-0: has none of the goals"),
              std::string::npos)
        << error.what();
  }
}

TEST(Episodes, MappingIsALiveFeed) {
  EXPECT_EQ(small_suite().protocol, live_feed());
  EXPECT_EQ(small_suite("pepper", "[plain]", "labels: [exact]\nprotocol: {on_failure: rewind}\n")
                .protocol.on_failure,
            OnFailure::kRewind);
}

TEST(Episodes, ASuiteWithoutThemIsRefused) {
  Suite suite = small_suite();
  suite.episodes.reset();
  EXPECT_THROW(episode_runs(suite), InputError);
}

TEST(GoalsNamed, AnUnknownNameGetsASuggestion) {
  RobotMap map;
  map.objects = {{.name = "bed 1", .class_id = *class_by_name("bed"), .score = 0.9},
                 {.name = "desk 1", .class_id = *class_by_name("desk"), .score = 0.8}};
  map.footprints_m = {{{1, 1}}, {{2, 2}}};
  EXPECT_EQ(goals_named(map, "desk").at(0).name, "desk 1");
  try {
    goals_named(map, "dexk");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("desk"), std::string::npos) << error.what();
  }
  EXPECT_THROW(goals_named(map, "toilet"), InputError);  // not in this map
}

TEST(GoalsNamed, TheBestScoredComesFirst) {
  RobotMap map;
  map.objects = {{.name = "bed 1", .class_id = *class_by_name("bed"), .score = 0.7},
                 {.name = "bed 2", .class_id = *class_by_name("bed"), .score = 0.9}};
  map.footprints_m = {{{1, 1}}, {{2, 2}}};
  const std::vector<NavigatorGoal> goals = goals_named(map, "bed");
  ASSERT_EQ(goals.size(), 2U);
  EXPECT_EQ(goals[0].name, "bed 2");
  EXPECT_EQ(goals[1].places_m, map.footprints_m[0]);
}

}  // namespace
}  // namespace mh
