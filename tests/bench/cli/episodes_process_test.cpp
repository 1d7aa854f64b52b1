// SPDX-License-Identifier: Apache-2.0
// `modelhouse bench` on a suite with episodes and `modelhouse episode`, as a user starts them.
#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/io/temporary_folder.hpp"
#include "tests/bench/cli/small_suite.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::content;

class EpisodeCommands : public testing::Test {
 protected:
  EpisodeCommands() { write_suite("sofa"); }

  void write_suite(const std::string& goal, const std::string& systems = "[plain]") const {
    const std::string root = MH_SOURCE_DIR;
    std::ofstream(suite()) << "robot: " << root << "/robots/pepper/pepper.yaml\nenvironments:\n"
                           << "- {category: room, scene: " << root
                           << "/bench/scenarios/room.yaml, mapping_tour: " << root
                           << "/bench/scenarios/tours/room.yaml}\nvocabulary: " << root
                           << "/assets/vocabulary.mhvoc\nlevels: [" << root
                           << "/sim/sensors/levels/pepper.yaml]\nsystems: " << systems
                           << "\nlabels: "
                              "[exact]\nprotocol: {test_interval: 0}\nepisodes: {starts: 2, "
                              "limit_s: 25, goals: ["
                           << goal << "]}\n";
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
  const std::string cache = " --cache " MH_TEST_CACHE;
  ASSERT_EQ(run("bench " + suite().string() + " --jobs 2 --out " + out("all") + cache), 0)
      << said();
  EXPECT_NE(content(out("all") + "/table.txt").find("2 kidnappings"), std::string::npos);
  const std::string text = content(out("all") + "/episodes.json");
  ASSERT_FALSE(text.empty());

  ASSERT_EQ(run("episode " + suite().string() + " --start 1 --json --out " + out("one") + cache), 0)
      << said();
  const json one = json::parse(content(work_.path() / "stdout"));
  const std::string digest = one.at("digest").dump();
  EXPECT_NE(text.find(digest), std::string::npos) << "another episode than the suite's: " << digest;
  EXPECT_EQ(json::parse(content(out("one") + "/episode.json")), one);
  EXPECT_NE(content(out("one") + "/log.txt").find("s  "), std::string::npos);
  EXPECT_TRUE(content(out("one") + "/strip.png").starts_with("\x89PNG"));

  // Done once: the second time nothing is driven.
  ASSERT_EQ(run("bench " + suite().string() + " --out " + out("all") + cache), 0) << said();
  EXPECT_EQ(content(out("all") + "/episodes.json"), text);
}

TEST_F(EpisodeCommands, ACrashOfALibraryEndsItsEpisodesAlone) {
  fs::copy_file(TINY_LIBRARY, work_.path() / "libtiny.so");
  for (const char* word : {"crash", "exit"}) std::ofstream(work_.path() / word) << word;
  write_suite("sofa",
              "[{name: crash, library: libtiny.so, settings: crash}, {name: exit, library: "
              "libtiny.so, settings: exit}, {name: still, library: libtiny.so}, plain]");
  const std::string bench =
      "bench " + suite().string() + " --out " + out("all") + " --cache " MH_TEST_CACHE;
  for (int attempt = 0; attempt < 2; ++attempt) {
    EXPECT_EQ(run(bench), 3);
    EXPECT_NE(
        said().find("crash-exact-pepper-0: outside library 'crash' (libtiny.so) was killed by "
                    "signal 6 during track (request 2)\n"),
        std::string::npos)
        << said();
    EXPECT_NE(said().find("exit-exact-pepper-0: outside library 'exit' (libtiny.so) exited with "
                          "code 0 during track (request 2)\n"),
              std::string::npos)
        << said();
    const json all = json::parse(content(out("all") + "/episodes.json"));
    for (const json& system : all.at("runs")) {
      const bool crashes = system.at("system") == "crash" || system.at("system") == "exit";
      const json& episodes = system.at("episodes");
      EXPECT_EQ(episodes.at(0).at("reason") == "system_failed", crashes) << episodes.dump();
      EXPECT_EQ(episodes.at(1).at("reason") == "not_run", crashes) << episodes.dump();
      EXPECT_GT(episodes.at(1).at("shortest_m"), 0) << episodes.dump();
    }
    ASSERT_EQ(all.at("runs").size(), 4U);
    EXPECT_EQ(all.at("runs")[2].at("episodes").size(), 2U);
  }
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
  refused(episode + " --variant= --start 1", "'--variant=': the value is missing");
  refused(episode + " one two", "unexpected argument 'one'");
  refused("episode " + std::string(MH_SOURCE_DIR) + "/bench/suites/ci.yaml --out " + out("none"),
          "episodes");
  for (const std::string command : {"verify ", "check ", "audit "})
    refused(command + suite().string(), "a suite with `episodes`");
  for (const std::string option : {"--time-limit 5", "--images-limit 1", "--retry-failed"})
    refused("bench " + suite().string() + " " + option, option.substr(0, option.find(' ')));
  write_suite("toilet");  // a room without one: nothing is left there
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
