// SPDX-License-Identifier: Apache-2.0
// Kidnapping episodes from start to end in a small room.
#include "bench/run/one/ask_episodes.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/report/episode_record.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/run/plan_runs.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/suite/run_key.hpp"
#include "bench/suite/run_spec.hpp"
#include "bench/systems/outside_error.hpp"
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

/// The first run of a suite and its world.
struct Place {
  explicit Place(const Suite& suite) : spec(expand(suite).front()) {}
  RunSpec spec;
  World world = build_world(spec, 2, Cache(MH_TEST_CACHE), {});
};

TEST(Episodes, WhatHasEndedIsNotRepeated) {
  const Place place(small_suite());
  const TemporaryFolder work(fs::temp_directory_path());
  const auto run = [&](const char* key) {
    return run_one(place.spec, place.world,
                   {.folder = work.path(),
                    .maps = Cache(work.path() / "maps"),
                    .episodes = {.ended = Cache(work.path() / "ended"), .key = key}});
  };
  const auto text = [](const RunResult& result) { return json_of(result.episodes).dump(); };
  const RunResult once = run("0a");
  ASSERT_EQ(once.episodes.size(), 2U);
  for (const EpisodeScore& score : once.episodes) {
    EXPECT_NE(score.digest, 0U);
    EXPECT_EQ(score.collisions, 0);
    EXPECT_EQ(score.success, score.reason.empty());
    EXPECT_LE(score.spl, 1.0);
  }
  EXPECT_TRUE(std::ranges::any_of(once.episodes, &EpisodeScore::success)) << text(once);
  const RunResult again = run("0a");
  EXPECT_EQ(text(again), text(once));
  EXPECT_TRUE(again.times.relocalize_ms.empty()) << "it was kidnapped again";
  const RunResult other = run("0b");  // of a different run
  EXPECT_EQ(text(other), text(once));
  EXPECT_FALSE(other.times.relocalize_ms.empty());
}

TEST(Episodes, EverySystemIsPutAtTheSamePlaces) {
  const std::vector<RunSpec> runs = expand(small_suite());
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[1].labels, Labels());
  EXPECT_EQ(runs[1].map_labels, Labels(LabelMode::kExact));
  const World one = build_world(runs[0], 2, Cache(MH_TEST_CACHE), {}),
              two = build_world(runs[1], 2, Cache(MH_TEST_CACHE), {});
  for (std::size_t s = 0; s < 2; ++s)
    EXPECT_EQ(one.variants[0].starts[s].place_m, two.variants[0].starts[s].place_m);
  EXPECT_FALSE(two.mapping->frame(0, RandomStream(0)).semantics.index.empty())
      << "of the robot's map";
}

TEST(Episodes, AnotherNumberOfStartsIsAnotherRunOnTheSameMap) {
  RunSpec few = expand(small_suite()).front(), many = few;
  many.episodes->starts = 3;
  EXPECT_NE(run_key(few, {}), run_key(many, {}));
  EXPECT_EQ(map_key(few, {}), map_key(many, {}));
  many.episodes->ticks_per_frame = 1;
  EXPECT_NE(map_key(few, {}), map_key(many, {}));
  many = run_spec_from_json(to_json(few));
  EXPECT_EQ(many.episodes, few.episodes);
  EXPECT_EQ(many.map_labels, few.map_labels);
}

std::string outside_error(const std::string& systems) {
  const Place place(small_suite("pepper", systems));
  const TemporaryFolder work(fs::temp_directory_path());
  try {
    run_one(place.spec, place.world, {.folder = work.path()});
  } catch (const OutsideError& error) {
    return error.what();
  }
  return "none";
}

TEST(Episodes, AProgramThatEndsEarlyOrBadlyIsReported) {
  const std::string ended =
      outside_error("[{name: broken, protocol: conversation, command: 'exit 7'}]");
  EXPECT_NE(ended.find("exited with code 7"), std::string::npos) << ended;
  // A program that is lost in every frame and ends with an error code.
  const std::string sulked = outside_error(R"y([{name: sulking, protocol: conversation, command: "
    sed -u -E 's/^.\"id\":([0-9]+),\"do\":\"hello.*/{\"id\":\\1,\"protocol\":1}/; t;
    s/^.\"id\":([0-9]+),\"do\":\"(freeze|rewind|reset).*/{\"id\":\\1}/; t;
    s/^.\"id\":([0-9]+).*/{\"id\":\\1,\"pose\":null}/'; exit 5"}])y");
  EXPECT_NE(sulked.find("exited with code 5"), std::string::npos) << sulked;
}

TEST(Episodes, WhatCanOnlyFailIsRefusedBeforeTheWork) {
  const auto expect_refused = [](const Suite& suite, const char* why) {
    try {
      check_episodes(suite);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  Suite suite = small_suite();
  suite.episodes->goals = {"sofa", "wall"};
  expect_refused(suite, "'wall' is never an object");
  expect_refused(small_suite("pepper", "[plain]", "labels: [none]\n"), "labels: 'none'");
  expect_refused(small_suite("pepper", "[plain]", "labels: [exact, boxes]\n"), "labels: 2");
  expect_refused(small_suite("pepper", "[plain]",
                             "labels: [exact]\ngraded: {distance_m: [0, 1], angle_deg: [0, 9]}\n"),
                 "graded:");
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
  const Place place(small_suite());
  const auto system = make_system(place.spec, place.world, {});
  const std::vector<EpisodeScore> scores = ask_episodes(
      place.spec, place.world, *system, {}, SE3(), RandomStream(0), {});  // it has tracked no frame
  ASSERT_EQ(scores.size(), 2U);
  EXPECT_FALSE(scores[0].success);
  EXPECT_EQ(scores[0].reason, "no_map");
  EXPECT_GT(EpisodeRecord({}, place.world.variants.front().starts.front())
                .strip("plain, start 0", scores[0])
                .total(),
            0U);
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
      build_world(expand(suite).front(), 2, Cache(MH_TEST_CACHE), {});
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
  InputReader inputs;
  const std::vector<Job> jobs = plan_runs(suite, inputs, [](std::string_view) {});
  try {
    validate_inputs(jobs, inputs, [](std::string_view) {});
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
  EXPECT_THROW(goals_named(map, "toilet"), InputError);  // the map has none
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
