// SPDX-License-Identifier: Apache-2.0
// Results are stored under the digest of the inputs that were read, no matter what else works in
// the same folder or which files change meanwhile: each command is started as a user would start
// it, and then disturbed.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "tests/bench/cli/small_suite.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using test::content;

const std::string kRoom = MH_SOURCE_DIR "/bench/scenarios/room.yaml";

class ChangedInputs : public testing::Test {
 protected:
  /// A running command.
  struct Started {
    pid_t process;
    fs::path said;
  };

  Started start(const std::string& arguments) {
    const fs::path said = path("said" + std::to_string(++started_));
    const pid_t process = fork();
    if (process != 0) return {process, said};
    const int file = open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    setenv("XDG_CACHE_HOME", path("cache").c_str(), 1);
    execl("/bin/sh", "sh", "-c", ("exec " MH_EXECUTABLE " " + arguments).c_str(), nullptr);
    _exit(127);
  }
  static int end_of(const Started& command) {
    int status = 0;
    waitpid(command.process, &status, 0);
    return test::code_of(status);
  }
  /// Runs a command and calls `disturb` as soon as the output contains `moment`. @returns the
  /// output
  std::string disturbed(const std::string& arguments, const std::string& moment,
                        const std::function<void()>& disturb) {
    const Started command = start(arguments);
    while (content(command.said).find(moment) == std::string::npos && is_at_work(command))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_NE(content(command.said).find(moment), std::string::npos) << content(command.said);
    disturb();
    code_ = end_of(command);
    return content(command.said);
  }
  static bool is_at_work(const Started& command) {
    siginfo_t info{};
    waitid(P_PID, static_cast<id_t>(command.process), &info, WEXITED | WNOHANG | WNOWAIT);
    return info.si_pid == 0;
  }
  int run(const std::string& arguments) {
    const Started command = start(arguments);
    const int code = end_of(command);
    said_ = content(command.said);
    return code;
  }
  std::string path(const std::string& name) const { return (work_.path() / name).string(); }

  /// A suite with the room and a copy of it under a different name, so that the copy has its own
  /// keys.
  std::string two_rooms(const std::string& systems, const std::string& more = "") const {
    std::string other = content(kRoom);
    const auto at = other.find("name:");
    EXPECT_NE(at, std::string::npos);
    write_atomically(path("other.yaml"), other.replace(at, 5, "# of a copy\nname:") + "\n");
    test::SmallSuite{.systems = systems, .labels = "[exact]", .more = more}.write(path("two.yaml"));
    std::string suite = content(path("two.yaml"));
    const auto begin = suite.find("- {"), end = suite.find("robot:");
    std::string second = suite.substr(begin, end - begin);
    second.replace(second.find(kRoom), kRoom.size(), path("other.yaml"));
    second.replace(second.find("category: room"), 14, "category: room, name: other");
    suite.insert(end, second);
    write_atomically(path("two.yaml"), suite);
    return path("two.yaml");
  }
  void change(const std::string& name) const {
    std::ofstream(path(name), std::ios::app) << "# changed\n";
  }
  /// Replaces a file by another one and then puts the old one back, with its old modification time.
  void replace_for_a_moment(const std::string& name) const {
    const auto time = fs::last_write_time(path(name));
    fs::copy_file(path(name), path("kept"), fs::copy_options::overwrite_existing);
    change(name);
    fs::copy_file(path("kept"), path(name), fs::copy_options::overwrite_existing);
    fs::last_write_time(path(name), time);
  }
  void expect_refused(const std::string& said, const std::string& part) const {
    EXPECT_EQ(code_, 2) << said;
    const auto at = said.rfind("modelhouse: error: ");
    ASSERT_NE(at, std::string::npos) << said;
    EXPECT_NE(said.find(part, at), std::string::npos) << said;
  }
  std::int64_t stored(const std::string& file, const std::string& table) const {
    if (!fs::exists(path(file))) return 0;
    return SQLite::Database(path(file)).execAndGet("SELECT count(*) FROM " + table).getInt64();
  }

  TemporaryFolder work_{fs::temp_directory_path()};
  std::string said_;
  int code_ = -1, started_ = 0;
};

TEST_F(ChangedInputs, AnotherSuiteWaitsForTheOneInItsFolder) {
  // The first command's program keeps running until the second command has been tried.
  const std::string slow =
      "[{name: slow, protocol: conversation, command: 'until ls | grep -q ^g.$; do sleep 0.05; "
      "done; exit 3'}, plain]";
  test::SmallSuite{.systems = slow, .labels = "[exact]"}.write(path("first.yaml"));
  test::SmallSuite{.systems = slow, .labels = "[exact]", .more = "published: table2\n"}.write(
      path("second.yaml"));
  const std::string to = " --frames 45 --out " + path("out");
  const std::string said = disturbed("bench " + path("first.yaml") + to, "of them to do", [&] {
    EXPECT_EQ(run("bench " + path("second.yaml") + to), 2) << said_;
    EXPECT_NE(said_.find(path("out") + ": another command is at work in this folder"),
              std::string::npos)
        << said_;
    EXPECT_EQ(run("scene convert " + kRoom + " --format scannet --out " + path("out")), 2) << said_;
    EXPECT_NE(said_.find("another command is at work"), std::string::npos) << said_;
    change("first.yaml");  // an edited suite counts as a different suite, too
    EXPECT_EQ(run("bench " + path("first.yaml") + to), 2) << said_;
    std::ofstream(path("go"));
  });
  EXPECT_EQ(code_, 3) << said;  // its program failed, as intended
  EXPECT_EQ(content(path("out/table.txt")).find("published"), std::string::npos);
  // The suite stored with the results is the one that was run, not the changed one.
  EXPECT_EQ(SQLite::Database(path("out/results.sqlite"))
                .execAndGet("SELECT content FROM suite")
                .getString()
                .find("changed"),
            std::string::npos);
  EXPECT_EQ(run("bench " + path("second.yaml") + to), 3) << said_;
}

TEST_F(ChangedInputs, RunsThatDifferInNamesAloneAreOneRun) {
  test::SmallSuite{.systems = "[semantic]",
                   .labels =
                       "[{of: exact, name: one, confusion: 0.1}, {of: exact, name: two, "
                       "confusion: 0.1}]"}
      .write(path("suite.yaml"));
  code_ = run("bench " + path("suite.yaml") + " --frames 45 --out " + path("out"));
  expect_refused(said_, "runs 'semantic-one-pepper-0' and 'semantic-two-pepper-0' are equal");
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(ChangedInputs, AProgramThatIsReplacedDuringItsRunHasNoResult) {
  for (const char* name : {"run.sh", "words.txt"}) write_atomically(path(name), ": >\"$1\"\n");
  for (const std::string changes : {"run.sh", "words.txt"}) {
    test::SmallSuite{.systems =
                         "[{name: p, protocol: trajectory, inputs: [words.txt], command: "
                         "'sh run.sh {trajectory}; sh " +
                         path("then.sh") + "'}]",
                     .labels = "[exact]"}
        .write(path("suite.yaml"));
    // The program's file is replaced and put back with its old times: only the file system can
    // tell.
    write_atomically(path("then.sh"), "cd " + work_.path().string() + " && cp -p " + changes +
                                          " was && echo : >>" + changes + " && cp -p was " +
                                          changes + "\n");
    code_ = run("bench " + path("suite.yaml") + " --frames 45 --out " + path("out"));
    expect_refused(said_, changes + ": was changed while it was in use");
    EXPECT_EQ(stored("out/results.sqlite", "runs"), 0);
  }
}

// While it runs, the program makes what would have been found in its place, and what it would have
// read. Removed again, neither leaves a trace.
TEST_F(ChangedInputs, AProgramOrFileThatAppearsDuringARunLeavesNoResult) {
  for (const char* folder : {"before", "after"}) fs::create_directories(path(folder));
  write_atomically(path("after/mine"), "#!/bin/sh\n: >\"$1\"; sh \"$2\"\n");
  fs::permissions(path("after/mine"), fs::perms::owner_all);
  const std::string before = getenv("PATH");
  setenv("PATH", (path("before") + ":" + path("after") + ":" + before).c_str(), 1);
  test::SmallSuite{.systems =
                       "[{name: p, protocol: trajectory, inputs: [then.sh], command: 'mine "
                       "{trajectory} " +
                       path("then.sh") + " gain.cfg'}]",
                   .labels = "[exact]"}
      .write(path("suite.yaml"));
  for (const std::string appears : {"before/mine", "gain.cfg"}) {
    write_atomically(path("then.sh"),
                     "cp " + path("after/mine") + " " + path(appears) + "; rm " + path(appears));
    code_ = run("bench " + path("suite.yaml") + " --frames 45 --out " + path("out"));
    expect_refused(said_, appears + ": was changed while it was in use");
    EXPECT_EQ(stored("out/results.sqlite", "runs"), 0);
  }
  setenv("PATH", before.c_str(), 1);
}

// Another suite in the same folder leaves no chart of the first one, but whatever else is there.
TEST_F(ChangedInputs, ChartsOfAnEarlierSuiteAreRemoved) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is missing";
  const auto bench = [&](const std::string& more) {
    test::SmallSuite{.systems = "[plain]", .labels = "[none]", .more = more}.write(
        path("suite.yaml"));
    ASSERT_EQ(run("bench " + path("suite.yaml") + " --frames 45 --out " + path("out")), 0) << said_;
  };
  bench("parameters: {map: rebuilt, features.count: [500, 700]}\n");
  const std::string chart = "out/sweep-plain-none-pepper.png";
  ASSERT_TRUE(fs::exists(path(chart))) << said_;
  write_atomically(path("out/sweep-mine.png"), "not a chart of the bench");
  bench("");
  EXPECT_FALSE(fs::exists(path(chart)));
  EXPECT_TRUE(fs::exists(path("out/sweep-mine.png")));
}

// Files of a check that appear while it runs belong to somebody else.
TEST_F(ChangedInputs, ACheckReplacesNoFileThatAppeared) {
  test::SmallSuite{
      .systems = "[plain]", .labels = "[none]", .more = "check: {tolerances: {ate_rmse_m: 0.1}}\n"}
      .write(path("suite.yaml"));
  const std::string check = "check " + path("suite.yaml") + " --frames 45 --update --baseline " +
                            path("base.json") + " --junit " + path("junit.xml");
  for (const char* name : {"base.json", "junit.xml"}) {
    const std::string said =
        disturbed(check, "frame ", [&] { write_atomically(path(name), "somebody's"); });
    expect_refused(said, name);
    EXPECT_EQ(content(path(name)), "somebody's");
    fs::remove(path(name));
  }
}

/// Commands with their own vocabulary file, which is memory-mapped: its words change during a run
/// if the file is written in place.
class ChangedWords : public ChangedInputs {
 protected:
  ChangedWords() {
    const std::string shipped = MH_SOURCE_DIR "/assets/vocabulary.mhvoc";
    fs::copy_file(shipped, path("words.mhvoc"));
    test::SmallSuite{.systems = "[plain]", .labels = "[exact]"}.write(path("suite.yaml"));
    std::string suite = content(path("suite.yaml"));
    suite.replace(suite.find(shipped), shipped.size(), path("words.mhvoc"));
    write_atomically(path("suite.yaml"), suite);
  }
  void write_in_place() const {
    std::fstream file(path("words.mhvoc"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(100000).write("another word", 12);
  }
  void expect_changed(const std::string& said) const {
    expect_refused(said, "words.mhvoc: was changed while it was in use");
  }
};

TEST_F(ChangedWords, DuringARunLeaveNoResult) {
  expect_changed(disturbed("bench " + path("suite.yaml") + " --out " + path("out"), "frame 1",
                           [&] { write_in_place(); }));
  EXPECT_EQ(stored("out/results.sqlite", "runs"), 0);
}

TEST_F(ChangedWords, AreNoCrashWhereTheyAreCutOff) {
  expect_changed(disturbed("bench " + path("suite.yaml") + " --out " + path("out"), "frame 1",
                           [&] { fs::resize_file(path("words.mhvoc"), 4096); }));
  EXPECT_EQ(stored("out/results.sqlite", "runs"), 0);
}

TEST_F(ChangedWords, DuringAnAuditLeaveNone) {
  expect_changed(disturbed("audit " + path("suite.yaml") + " --out " + path("out"), ", audit",
                           [&] { write_in_place(); }));
  EXPECT_FALSE(fs::exists(path("out/audit.json")));
}

TEST_F(ChangedWords, DuringAReplayLeaveNoPages) {
  ASSERT_EQ(run("bench " + path("suite.yaml") + " --out " + path("out")), 0) << said_;
  expect_changed(disturbed("report " + path("out") + " --replay all --out " + path("pages"),
                           "runs again", [&] { write_in_place(); }));
  EXPECT_FALSE(fs::exists(path("pages/index.html")));
}

// The first run's program moves away a file that the second run reads.
TEST_F(ChangedInputs, AFileThatIsAwayForAMomentIsNoFailureOfItsRun) {
  const std::string suite =
      two_rooms("[{name: p, protocol: trajectory, command: 'echo {trajectory}; mv " +
                path("other.yaml") + " " + path("away") + "; exit 3'}]");
  code_ = run("bench " + suite + " --frames 45 --out " + path("out"));
  expect_refused(said_, "other-p-exact-pepper-0: a file that it reads was changed");
  EXPECT_EQ(stored("out/results.sqlite", "runs"), 1) << "the first one's failure";
}

TEST_F(ChangedInputs, AVariableThatACommandNamesIsAnInput) {
  test::SmallSuite{
      .systems =
          "[{name: p, protocol: trajectory, command: 'echo $GAIN >&2; exit 3; : {trajectory}'}]",
      .labels = "[exact]"}
      .write(path("suite.yaml"));
  const auto to_do = [&](const char* gain) {
    setenv("GAIN", gain, 1);
    run("bench " + path("suite.yaml") + " --frames 45 --out " + path("out"));
    return content(path("out/results.sqlite")).size() > 0 ? stored("out/results.sqlite", "runs")
                                                          : 0;
  };
  EXPECT_EQ(to_do("1"), 1);
  EXPECT_EQ(to_do("1"), 1);
  EXPECT_EQ(to_do("2"), 2) << "a key of its own";
  unsetenv("GAIN");
}

TEST_F(ChangedInputs, ARenderingIsOfTheLevelThatWasRead) {
  const std::string level = MH_SOURCE_DIR "/sim/sensors/levels/";
  fs::copy_file(level + "ideal.yaml", path("level.yaml"));
  const std::string command = "render " + kRoom + " --motion handheld:0:30 --level " +
                              path("level.yaml") + " --out " + path("out");
  const auto exchange = [&](const char* with) {
    fs::copy_file(level + with, path("level.yaml"), fs::copy_options::overwrite_existing);
  };
  disturbed(command, "scene ", [&] { exchange("pepper.yaml"); });
  ASSERT_EQ(code_, 0);
  EXPECT_EQ(run(command), 2) << said_;
  EXPECT_NE(said_.find("already contains a sequence with other settings"), std::string::npos);
  exchange("ideal.yaml");
  EXPECT_EQ(run(command), 0) << said_;
}

TEST_F(ChangedInputs, ASceneThatChangesBetweenEpisodesHasNone) {
  const std::string root = MH_SOURCE_DIR;
  fs::copy_file(kRoom, path("other.yaml"));
  const auto place = [&](const char* name, const std::string& scene) {
    return "- {category: room, name: " + std::string(name) + ", scene: " + scene +
           ", mapping_tour: " + root + "/bench/scenarios/tours/room.yaml}\n";
  };
  write_atomically(path("suite.yaml"),
                   "robot: " + root + "/robots/pepper/pepper.yaml\nenvironments:\n" +
                       place("first", kRoom) + place("second", path("other.yaml")) +
                       "vocabulary: " + root + "/assets/vocabulary.mhvoc\nlevels: [" + root +
                       "/sim/sensors/levels/ideal.yaml]\nsystems:\n- {name: p, protocol: "
                       "conversation, command: 'echo \"# x\" >>" +
                       path("other.yaml") +
                       "; exit 3'}\nlabels: [exact]\nprotocol: {test_interval: 0}\nepisodes: "
                       "{starts: 1, limit_s: 2, goals: [sofa]}\n");
  code_ = run("bench " + path("suite.yaml") + " --out " + path("out") + " --cache " MH_TEST_CACHE);
  expect_refused(said_, "second-p-exact-ideal-0: a file that it reads was changed");
  EXPECT_EQ(stored("out/results.sqlite", "episodes"), 0);
  EXPECT_FALSE(fs::exists(path("out/results.json")));
}

TEST_F(ChangedInputs, ASceneThatChangesDuringAnAuditHasNone) {
  const std::string suite = two_rooms("[plain]");
  const std::string said =
      disturbed("audit " + suite + " --frames 45 --no-cache --out " + path("out"),
                "run and audit of", [&] { change("other.yaml"); });
  expect_refused(said, "other-plain-pepper-0: a file that it reads was changed");
  EXPECT_FALSE(fs::exists(path("out/audit.json")));
}

TEST_F(ChangedInputs, ASceneThatChangesDuringACheckMakesNoBaseline) {
  const std::string suite = two_rooms("[plain]", "check: {tolerances: {completeness: 0.1}}\n");
  const std::string said = disturbed("check " + suite + " --frames 45 --update", "of them to do",
                                     [&] { change("other.yaml"); });
  expect_refused(said, "other-plain-pepper-0: a file that it reads was changed");
  EXPECT_FALSE(fs::exists(path("two.baseline.json")));
}

TEST_F(ChangedInputs, AReplayIsOfTheFilesOfItsResult) {
  fs::copy_file(kRoom, path("room.yaml"));
  test::SmallSuite{.scene = path("room.yaml"), .systems = "[plain]", .labels = "[exact]"}.write(
      path("suite.yaml"));
  ASSERT_EQ(run("bench " + path("suite.yaml") + " --frames 45 --out " + path("out") +
                " --cache " MH_TEST_CACHE),
            0)
      << said_;
  const std::string report = "report " + path("out") + " --replay all --cache " MH_TEST_CACHE;
  EXPECT_EQ(run(report + " --out " + path("pages")), 0) << said_;
  change("room.yaml");
  code_ = run(report + " --out " + path("other_pages"));
  expect_refused(said_, "plain-pepper-0: its 'scene' was changed since this result was made");
  EXPECT_FALSE(fs::exists(path("other_pages/index.html")));
}

/// Commands over a recording whose images are read on demand.
class ChangedRecording : public ChangedInputs {
 protected:
  void SetUp() override {
    ASSERT_EQ(
        run("render " + kRoom + " --motion handheld:0:60 --level ideal --out " + path("room")), 0)
        << said_;
  }
  /// Changes the first image, which has been read by the time a command reports progress.
  void change_image() const {
    replace_for_a_moment(
        (fs::path("room/rgb") / list_folder(path("room/rgb"), "*.png").front()).string());
  }
  void expect_nothing_of(const std::string& command, const std::string& result) {
    const std::string said =
        disturbed(command + " --out " + path("out"), " %", [&] { change_image(); });
    expect_refused(said, ".png: was changed while it was in use: start the command again");
    EXPECT_FALSE(fs::exists(path("out/" + result))) << command;
  }
};

TEST_F(ChangedRecording, OfARunOfSlamLeavesNoTrajectory) {
  expect_nothing_of("slam tum:" + path("room"), "estimate.tum");
}

TEST_F(ChangedRecording, OfAMapLeavesNoGrid) {
  expect_nothing_of("map build tum:" + path("room"), "map.bt");
}

TEST_F(ChangedRecording, OfATwinLeavesNoComparison) {
  expect_nothing_of(
      "twin tum:" + path("room") + " " + kRoom + " --level ideal --cache " MH_TEST_CACHE,
      "twin.json");
}

}  // namespace
}  // namespace mh
