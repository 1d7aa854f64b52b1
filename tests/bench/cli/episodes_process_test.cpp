// SPDX-License-Identifier: Apache-2.0
// `modelhouse bench` on a suite with episodes and `modelhouse episode`, as a user starts them.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "tests/bench/cli/small_suite.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::content;

const std::string kCache = " --cache " MH_TEST_CACHE;

class EpisodeCommands : public testing::Test {
 protected:
  EpisodeCommands() { write_suite("sofa"); }

  void write_suite(const std::string& goal, const std::string& systems = "[plain]",
                   const std::string& settings = "starts: 2, limit_s: 25") const {
    const std::string root = MH_SOURCE_DIR;
    std::ofstream(suite()) << "robot: " << test::write_small_pepper(work_.path() / "robot.yaml")
                           << "\nenvironments:\n"
                           << "- {category: room, scene: " << root
                           << "/bench/scenarios/room.yaml, mapping_tour: " << root
                           << "/bench/scenarios/tours/room.yaml}\nvocabulary: " << root
                           << "/assets/vocabulary.mhvoc\nlevels: [" << root
                           << "/sim/sensors/levels/pepper.yaml]\nsystems: " << systems
                           << "\nlabels: "
                              "[exact]\nprotocol: {test_interval: 0}\nepisodes: {"
                           << settings << ", goals: [" << goal << "]}\n";
  }
  int run(const std::string& arguments) const {
    const std::string to = work_.path().string();
    return test::code_of(std::system(("XDG_CACHE_HOME=" MH_TEST_CACHE " " MH_EXECUTABLE " " +
                                      arguments + " >" + to + "/stdout 2>" + to + "/stderr")
                                         .c_str()));
  }
  std::string said() const { return content(work_.path() / "stderr"); }
  fs::path suite() const { return work_.path() / "small.yaml"; }
  std::string out(const char* name) const { return (work_.path() / name).string(); }

  TemporaryFolder work_{fs::temp_directory_path()};
};

TEST_F(EpisodeCommands, OneEpisodeIsTheOneThatTheSuiteScored) {
  const std::string bench = "bench " + suite().string() + " --jobs 2" + kCache + " --out ";
  ASSERT_EQ(run(bench + out("all")), 0) << said();
  EXPECT_NE(content(out("all") + "/table.txt").find("2 kidnappings"), std::string::npos);
  const std::string text = content(out("all") + "/results.json");
  const json episodes = json::parse(text).at("runs").at(0).at("episodes");
  EXPECT_FALSE(fs::exists(out("all") + "/plain-pepper-0/episodes")) << "they are in the results";

  ASSERT_EQ(run("episode " + suite().string() + " --start 1 --json --out " + out("one") + kCache),
            0)
      << said();
  const json one = json::parse(content(work_.path() / "stdout"));
  EXPECT_EQ(episodes.at(1), one) << "another episode than the suite's";
  EXPECT_EQ(json::parse(content(out("one") + "/episode.json")), one);
  EXPECT_NE(content(out("one") + "/log.txt").find("s  "), std::string::npos);
  EXPECT_TRUE(content(out("one") + "/strip.png").starts_with("\x89PNG"));

  // A finished episode is not driven a second time.
  ASSERT_EQ(run(bench + out("all")), 0) << said();
  EXPECT_NE(said().find("1 run, 0 of them to do"), std::string::npos) << said();
  EXPECT_EQ(content(out("all") + "/results.json"), text);
}

TEST_F(EpisodeCommands, SharesTogetherAreTheWhole) {
  write_suite("sofa", "[semantic, plain]");
  const std::string bench = "bench " + suite().string() + kCache + " --out ";
  ASSERT_EQ(run(bench + out("all") + " --jobs 2"), 0) << said();
  for (const std::string share : {"1", "2"})
    ASSERT_EQ(run(bench + out(("part" + share).c_str()) + " --shard " + share + "/2"), 0) << said();
  ASSERT_EQ(run("merge " + out("merged") + " " + out("part1") + " " + out("part2")), 0) << said();
  for (const char* file : {"/table.txt", "/results.json"})
    EXPECT_EQ(content(out("merged") + file), content(out("all") + file)) << file;
  EXPECT_EQ(run("check " + suite().string() + " --update"), 2) << "no tolerances";
  for (const char* format : {"csv", "json", "latex"})
    EXPECT_EQ(run("export " + out("all") + " --format " + format), 0) << said();
  EXPECT_EQ(run("report " + out("all") + " --out " + out("pages")), 0) << said();
}

TEST_F(EpisodeCommands, ARunThatIsKilledGoesOnWithTheNextEpisode) {
  const std::string program = "XDG_CACHE_HOME=" MH_TEST_CACHE " exec " MH_EXECUTABLE " bench " +
                              suite().string() + kCache + " --out ";
  ASSERT_EQ(run("bench " + suite().string() + kCache + " --out " + out("once")), 0) << said();
  const pid_t bench = fork();
  if (bench == 0) {
    execl("/bin/sh", "sh", "-c", (program + out("killed") + " 2>/dev/null >/dev/null").c_str(),
          nullptr);
    _exit(127);
  }
  const fs::path kept = out("killed") + "/plain-pepper-0/episodes/modelhouse-cache/episode";
  for (int i = 0; i < 6000 && list_folder(kept, "*").empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  kill(bench, SIGKILL);
  waitpid(bench, nullptr, 0);
  ASSERT_EQ(list_folder(kept, "*").size(), 1U);
  EXPECT_EQ(run("bench " + suite().string() + kCache + " --out " + out("killed")), 0) << said();
  EXPECT_EQ(content(out("killed") + "/results.json"), content(out("once") + "/results.json"));
  EXPECT_FALSE(fs::exists(kept));
}

TEST_F(EpisodeCommands, ACrashOfALibraryFailsItsRunAlone) {
  fs::copy_file(TINY_LIBRARY, work_.path() / "libtiny.so");
  for (const char* word : {"crash", "exit"}) std::ofstream(work_.path() / word) << word;
  write_suite("sofa",
              "[{name: crash, library: libtiny.so, settings: crash}, {name: exit, library: "
              "libtiny.so, settings: exit}, {name: still, library: libtiny.so}]",
              "starts: 1, limit_s: 3");
  const std::string bench = "bench " + suite().string() + " --out " + out("all") + kCache;
  for (const char* again : {"", " --retry-failed"}) {
    EXPECT_EQ(run(bench + again), 3);
    const std::string table = content(out("all") + "/table.txt");
    EXPECT_NE(table.find("crash-exact-pepper-0: outside library 'crash' (libtiny.so) was killed by "
                         "signal 6 during track (request 2)\n"),
              std::string::npos)
        << table;
    EXPECT_NE(table.find("exit-exact-pepper-0: outside library 'exit' (libtiny.so) exited with "
                         "code 0 during track (request 2)\n"),
              std::string::npos)
        << table;
    const json all = json::parse(content(out("all") + "/results.json"));
    ASSERT_EQ(all.at("runs").size(), 3U);
    for (const json& one : all.at("runs")) {
      const bool crashes = one.at("system") == "crash" || one.at("system") == "exit";
      EXPECT_EQ(one.at("status"), crashes ? "failed" : "done");
      EXPECT_EQ(crashes ? 1U : one.at("episodes").size(), 1U) << one.dump();
    }
  }
}

TEST_F(EpisodeCommands, ARunHasATimeLimitThatItsEpisodesAddTo) {
  write_suite("sofa", "[plain]", "starts: 1, limit_s: 1.1");
  EXPECT_EQ(run("bench " + suite().string() + " --no-cache --time-limit 0.1 --out " + out("late")),
            3);
  EXPECT_NE(content(out("late") + "/table.txt").find("took longer than the limit of 1.2 s"),
            std::string::npos)
      << content(out("late") + "/table.txt");
}

TEST_F(EpisodeCommands, WhatCannotBeMeantIsOneClearError) {
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    EXPECT_EQ(run(arguments), 2) << said();
    const std::string all = said();
    const auto at = all.find("modelhouse: error: ");
    ASSERT_NE(at, std::string::npos) << all;
    EXPECT_NE(all.find(part, at), std::string::npos) << all;
    EXPECT_EQ(std::ranges::count(all.substr(at), '\n'), 1) << all;
  };
  const std::string episode = "episode " + suite().string() + " --out " + out("none");
  refused(episode + " --system semantik", "'semantik' is not in");
  refused(episode + " --start x", "--start");
  refused(episode + " --variant= --start 1", "'--variant=': its value is missing");
  refused(episode + " one two", "unexpected argument 'one'");
  refused("episode " + std::string(MH_SOURCE_DIR) + "/bench/suites/ci.yaml --out " + out("none"),
          "episodes");
  for (const std::string command : {"audit ", "bench --audit "})
    refused(command + suite().string() + " --out " + out("none"), "an audit examines queries");
  write_suite("toilet");  // a room without a toilet: no episode is left there
  refused("bench " + suite().string() + " --out " + out("none"), "toilet");
  EXPECT_FALSE(fs::exists(out("none")));
  write_suite("soaf");
  refused(episode, "soaf");
  write_suite("sofa, sofa");
  refused(episode, "'sofa' is listed twice");
  EXPECT_FALSE(fs::exists(out("none") + "/episode.json"));
}

}  // namespace
}  // namespace mh
