// SPDX-License-Identifier: Apache-2.0
// `modelhouse bench` with real processes over a small room: its promises about stores, shards,
// crashes, limits and signals.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "source_dir.hpp"
#include "tests/bench/cli/small_suite.hpp"

namespace {

namespace fs = std::filesystem;
using mh::test::content;

const fs::path& test_folder() {
  static const struct Folder {
    fs::path path = fs::temp_directory_path() / ("mh_process_" + std::to_string(getpid()));
    static fs::path shared() { return MH_TEST_CACHE "/modelhouse-cache"; }
    Folder() {
      // Baked light is shared by all tests (its key covers scene and code); maps and audits are
      // not.
      fs::create_directories(path / "cache");
      std::error_code none_yet;
      fs::copy(shared(), path / "cache" / shared().filename(), fs::copy_options::recursive,
               none_yet);
    }
    ~Folder() {
      const fs::path own = path / "cache" / shared().filename();
      for (const char* kind : {"map", "audit"}) fs::remove_all(own / kind);
      std::error_code no_matter;
      fs::create_directories(shared().parent_path(), no_matter);
      // Moved into place only when it is complete: other tests run at the same time.
      fs::rename(own, shared(), no_matter);
      for (const auto& entry : fs::directory_iterator(own / "light", no_matter))
        if (!fs::exists(shared() / "light" / entry.path().filename()))
          fs::rename(entry.path(), shared() / "light" / entry.path().filename(), no_matter);
      fs::remove_all(path);
    }
  } folder;
  return folder.path;
}

const std::string kRoom = MH_SOURCE_DIR "/bench/scenarios/room.yaml";

/// A suite of three short runs, or of the runs that `systems` defines.
fs::path write_suite(const std::string& name = "small",
                     const std::string& systems = "[semantic, plain]", const std::string& more = "",
                     const std::string& scene = kRoom, const std::string& labels = "[exact, boxes]",
                     const std::string& level = "pepper") {
  const fs::path file = test_folder() / (name + ".yaml");
  mh::test::SmallSuite{
      .scene = scene, .systems = systems, .labels = labels, .level = level, .more = more}
      .write(file);
  return file;
}

class Command {
 public:
  explicit Command(const std::string& arguments) {
    process_ = fork();
    if (process_ != 0) return;
    const int out = open((test_folder() / "stdout").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    const int err = open((test_folder() / "stderr").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", ("exec " MH_EXECUTABLE " " + arguments).c_str(), nullptr);
    _exit(127);
  }
  void signal(int number) const { kill(process_, number); }
  bool running() { return !ended_ && !(ended_ = waitpid(process_, &status_, WNOHANG) == process_); }
  int wait() {
    if (!ended_) waitpid(process_, &status_, 0);
    ended_ = true;
    return mh::test::code_of(status_);
  }
  /// Ids of the command's child processes.
  std::vector<pid_t> children() const {
    std::vector<pid_t> found;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      const std::string stat = content(entry.path() / "stat");
      const auto after = stat.rfind(')');
      if (after == std::string::npos) continue;
      std::istringstream fields(stat.substr(after + 2));
      char state = 0;
      pid_t parent = 0;
      fields >> state >> parent;
      if (parent == process_ && state != 'Z')
        found.push_back(std::stoi(entry.path().filename().string()));
    }
    return found;
  }

 private:
  pid_t process_ = -1;
  bool ended_ = false;
  int status_ = 0;
};

std::string bench_with_kept_maps(const fs::path& suite, const std::string& out,
                                 const std::string& more = "") {
  return "bench " + suite.string() + " --frames 45 --cache " + (test_folder() / "cache").string() +
         " --out " + (test_folder() / out).string() + " " + more;
}

/// Like bench_with_kept_maps(), but deletes the maps in the cache first, so that every run has to
/// map.
std::string bench(const fs::path& suite, const std::string& out, const std::string& more = "") {
  fs::remove_all(test_folder() / "cache" / "modelhouse-cache" / "map");
  return bench_with_kept_maps(suite, out, more);
}

int run(const std::string& arguments) {
  return Command(arguments).wait();
}

/// How many runs a results file holds.
int runs_in(const fs::path& folder) {
  if (!fs::exists(folder / "results.sqlite")) return 0;
  const fs::path list = test_folder() / "runs.csv";
  const std::string command = std::string(MH_EXECUTABLE) + " export " + folder.string() +
                              " --out " + list.string() + " 2> /dev/null";
  if (std::system(command.c_str()) != 0) return 0;
  const std::string text = content(list);
  return static_cast<int>(std::count(text.begin(), text.end(), '\n')) - 1;  // without the header
}

std::string errors() {
  return content(test_folder() / "stderr");
}

/// Everything that is exported and must not depend on how the work was split or interrupted.
std::string tables(const std::string& out) {
  const fs::path folder = test_folder() / out;
  EXPECT_EQ(run("export " + folder.string() + " --format json"), 0) << errors();
  return content(folder / "results.json") + content(folder / "table.txt") +
         content(test_folder() / "stdout");
}

/// The tables of an undisturbed run.
const std::string& undisturbed() {
  static const std::string kTables = [] {
    EXPECT_EQ(run(bench(write_suite(), "plain_run")), 0) << errors();
    return tables("plain_run");
  }();
  return kTables;
}

TEST(BenchProcess, JobsAndShardsChangeNoByte) {
  ASSERT_GT(undisturbed().size(), 10000u);
  EXPECT_EQ(run(bench(write_suite(), "two_jobs", "--jobs 2")), 0) << errors();
  EXPECT_EQ(tables("two_jobs"), undisturbed());
  std::string shards;
  for (const char* i : {"1", "2", "3"}) {
    const std::string out = std::string("shard") + i;
    EXPECT_EQ(run(bench(write_suite(), out, std::string("--shard ") + i + "/3")), 0) << errors();
    shards += " " + (test_folder() / out).string();
  }
  EXPECT_EQ(run("merge " + (test_folder() / "merged").string() + shards), 0) << errors();
  EXPECT_EQ(tables("merged"), undisturbed());
}

// Two trials of three combinations of system and labels, at a level with motion blur: first each
// run makes its own images, then the runs share images made by the first one that needs them.
TEST(BenchProcess, SharedImagesChangeNoByte) {
  const std::string root = MH_SOURCE_DIR;
  const fs::path suite = write_suite("blurred", "[semantic, plain]",
                                     "parameters: {map: fixed, semantics.gamma: [0, 1]}\n", kRoom,
                                     "[exact, annotated]", "handheld");
  const auto folders_of_work = [](const std::string& out) {
    return std::ranges::count_if(fs::directory_iterator(test_folder() / out), [](const auto& one) {
      return one.is_directory() && one.path().filename().string().starts_with(".");
    });
  };
  EXPECT_EQ(run(bench(suite, "own_images", "--images-limit 0")), 0) << errors();
  const std::string own = tables("own_images");
  EXPECT_EQ(run(bench(suite, "shared_images", "--jobs 2")), 0) << errors();
  EXPECT_EQ(tables("shared_images"), own);
  EXPECT_EQ(folders_of_work("shared_images"), 0);
  // The limit leaves room for only a few shared images.
  EXPECT_EQ(run(bench(suite, "few_images", "--images-limit 0.01")), 0) << errors();
  EXPECT_EQ(tables("few_images"), own);
}

TEST(BenchProcess, AFinishedRunIsNotRepeated) {
  undisturbed();
  EXPECT_EQ(run(bench(write_suite(), "plain_run")), 0);
  EXPECT_NE(errors().find("3 runs, 0 of them to do"), std::string::npos) << errors();
  EXPECT_EQ(tables("plain_run"), undisturbed());
}

// No part of a run's time is negative; together, the parts make up most of the run's time, but not
// more than it.
TEST(BenchProcess, ThePartsOfARunsTimeAddUp) {
  undisturbed();
  const SQLite::Database db((test_folder() / "plain_run" / "results.sqlite").string());
  SQLite::Statement times(db, "SELECT cpu_s, slam_s, frames_s, products_s FROM times");
  int runs = 0;
  for (; times.executeStep(); ++runs) {
    double sum_s = 0;
    for (int part = 1; part < 4; ++part) {
      const double part_s = times.getColumn(part).getDouble();
      EXPECT_GE(part_s, 0) << times.getColumnName(part);
      sum_s += part_s;
    }
    const double cpu_s = times.getColumn(0).getDouble();
    EXPECT_LE(sum_s, cpu_s);
    EXPECT_GE(sum_s, 0.75 * cpu_s);
  }
  EXPECT_EQ(runs, 3);
}

TEST(BenchProcess, KilledAtRandomMomentsItGoesOnAndLosesNothing) {
  std::mt19937 random(7);
  int kills = 0;
  for (int attempt = 0; attempt < 5; ++attempt) {
    Command command(bench(write_suite(), "killed", "--jobs 2"));
    std::this_thread::sleep_for(std::chrono::milliseconds(200 + random() % 1200));
    if (!command.running()) break;
    command.signal(SIGKILL);
    command.wait();
    ++kills;
  }
  EXPECT_GT(kills, 0);
  EXPECT_EQ(run(bench(write_suite(), "killed")), 0) << errors();
  EXPECT_EQ(tables("killed"), undisturbed());
}

TEST(BenchProcess, AMapFromTheCacheChangesNoByte) {
  EXPECT_EQ(run(bench(write_suite(), "mapped")), 0) << errors();
  EXPECT_EQ(run(bench_with_kept_maps(write_suite(), "cached")), 0) << errors();
  const auto maps_anew = [](const std::string& out) {
    return content(test_folder() / out / "times.json").find("\"track_ms\": null") ==
           std::string::npos;
  };
  EXPECT_TRUE(maps_anew("mapped"));
  EXPECT_FALSE(maps_anew("cached"));
  for (const char* out : {"mapped", "cached"}) EXPECT_EQ(tables(out), undisturbed()) << out;
  for (const char* file : {"map.bt", "map.pgm", "estimate.tum", "topdown.png"})
    EXPECT_EQ(content(test_folder() / "cached" / "semantic-exact-pepper-0" / file),
              content(test_folder() / "mapped" / "semantic-exact-pepper-0" / file))
        << file;
}

TEST(BenchProcess, TwoProcessesShareOneStore) {
  Command one(bench(write_suite(), "shared")), two(bench(write_suite(), "shared"));
  EXPECT_EQ(one.wait(), 0) << errors();
  EXPECT_EQ(two.wait(), 0) << errors();
  EXPECT_EQ(tables("shared"), undisturbed());
}

TEST(BenchProcess, ARunKilledFromOutsideIsTriedAgain) {
  Command command(bench(write_suite(), "outside"));
  bool killed = false;
  for (int i = 0; i < 400 && !killed && command.running(); ++i) {
    for (const pid_t child : command.children()) killed = kill(child, SIGKILL) == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(command.wait(), 0) << errors();
  EXPECT_TRUE(killed);
  EXPECT_NE(errors().find("was killed from outside"), std::string::npos) << errors();
  EXPECT_EQ(tables("outside"), undisturbed());
}

TEST(BenchProcess, CtrlCEndsEverythingAndKeepsWhatIsFinished) {
  Command command(bench(write_suite(), "stopped", "--jobs 2"));
  std::vector<pid_t> children;
  for (int i = 0; i < 500 && children.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    children = command.children();
  }
  ASSERT_FALSE(children.empty());
  command.signal(SIGINT);
  EXPECT_EQ(command.wait(), 130) << errors();
  for (const pid_t child : children) EXPECT_NE(kill(child, 0), 0) << "a process was left behind";
  EXPECT_EQ(run(bench(write_suite(), "stopped")), 0) << errors();
  EXPECT_EQ(tables("stopped"), undisturbed());
}

TEST(BenchProcess, AHangupIsAnInterruptUnlessItIsIgnored) {
  for (const bool ignored : {false, true}) {
    ASSERT_TRUE(fs::exists(test_folder()));
    const auto before = ::signal(SIGHUP, ignored ? SIG_IGN : SIG_DFL);  // as nohup does
    Command command("scene statistics model_house");
    ::signal(SIGHUP, before);
    std::this_thread::sleep_for(std::chrono::seconds(3));  // the command takes longer than this
    command.signal(SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_EQ(command.running(), ignored);
    if (ignored) command.signal(SIGTERM);
    EXPECT_EQ(command.wait(), 130) << errors();
    EXPECT_NE(errors().find("modelhouse: interrupted"), std::string::npos) << errors();
  }
}

TEST(BenchProcess, ARenderingThatIsInterruptedSaysWhetherItGoesOn) {
  const std::string mesh = (test_folder() / "floor.obj").string();
  std::ofstream(mesh) << "v 0 0 0\nv 5 0 0\nv 5 5 0\nv 0 5 0\no floor\nf 1 2 3 4\n";
  for (const bool one_file : {false, true}) {
    const fs::path out = test_folder() / (one_file ? "of_mcap" : "of_tum");
    const std::string render = "render " + mesh + " --motion handheld:0 --out " + out.string() +
                               (one_file ? " --format mcap" : "");
    Command command(render);
    for (int i = 0; i < 3000 && command.running() && !fs::exists(out / "render.json"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    command.signal(SIGINT);
    EXPECT_EQ(command.wait(), 130) << errors();
    EXPECT_NE(errors().find(one_file ? "nothing is kept" : "the same command resumes"),
              std::string::npos)
        << errors();
    EXPECT_FALSE(fs::exists(out / "rgb.txt"));
    EXPECT_FALSE(fs::exists(out / "of_mcap.mcap"));
    for (const auto& entry : fs::directory_iterator(out))
      EXPECT_FALSE(entry.path().filename().string().starts_with(".work.")) << entry.path();
  }
}

TEST(BenchProcess, EveryCommandThatIsInterruptedSaysSo) {
  ASSERT_TRUE(fs::exists(test_folder()));
  Command command("scene statistics model_house");
  std::this_thread::sleep_for(std::chrono::seconds(3));  // the command takes longer than this
  command.signal(SIGINT);
  EXPECT_EQ(command.wait(), 130) << errors();
  EXPECT_NE(errors().find("modelhouse: interrupted; nothing is kept"), std::string::npos)
      << errors();
}

TEST(BenchProcess, ACheckThatIsInterruptedGoesOn) {
  const fs::path place = test_folder() / "home" / "modelhouse" / "check";
  setenv("XDG_CACHE_HOME", (test_folder() / "home").c_str(), 1);
  const fs::path suite = write_suite("gate", "[semantic, plain]",
                                     "check: {tolerances: {completeness: 0.1}}\ntrials: 1\n");
  const std::string check = "check " + suite.string() + " --update";
  const auto interrupted = [&](int number) {
    Command command(check);
    for (int i = 0; i < 6000 && command.running(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      std::error_code none_yet;
      for (const auto& entry : fs::directory_iterator(place, none_yet))
        if (runs_in(entry.path()) > 0) {
          command.signal(number);
          return command.wait();
        }
    }
    return 0;
  };
  EXPECT_EQ(interrupted(SIGINT), 130);
  EXPECT_NE(errors().find("the same command resumes"), std::string::npos) << errors();
  const int finished = runs_in(fs::directory_iterator(place)->path());
  EXPECT_GE(finished, 1);
  ASSERT_LT(finished, 3);
  EXPECT_EQ(run(check), 0) << errors();
  EXPECT_NE(errors().find("3 runs, " + std::to_string(3 - finished) + " of them to do"),
            std::string::npos)
      << errors();
  EXPECT_TRUE(fs::is_empty(place)) << "it is removed once the check is done";
  const std::string baseline = content(fs::path(suite).replace_extension(".baseline.json"));

  // The next check starts over, and it resumes after SIGKILL, too.
  EXPECT_EQ(interrupted(SIGKILL), -SIGKILL);
  EXPECT_EQ(run(check), 0) << errors();
  EXPECT_EQ(errors().find("3 runs, 3 of them to do"), std::string::npos) << errors();
  EXPECT_EQ(content(fs::path(suite).replace_extension(".baseline.json")), baseline);
}

TEST(BenchProcess, ACheckWhoseRunsFailWritesThemIntoItsReport) {
  const fs::path xml = test_folder() / "check.xml";
  const fs::path suite = write_suite(
      "failing", "[{name: vo, protocol: conversation, command: 'echo no map >&2; exit 3'}]",
      "check: {tolerances: {completeness: 0.1}}\n");
  EXPECT_EQ(run("check " + suite.string() + " --update --junit " + xml.string()), 3);
  EXPECT_EQ(errors().find("--retry-failed"), std::string::npos) << errors();
  EXPECT_NE(errors().find("no map"), std::string::npos) << errors();
  EXPECT_NE(content(xml).find("<error message=\"outside program 'vo'"), std::string::npos)
      << content(xml);
}

TEST(BenchProcess, AnOutsideProgramThatIsRunAgainMeetsNeitherTruthNorLeavings) {
  const auto suite_that = [](const std::string& does) {
    return write_suite("again", "[{name: vo, protocol: trajectory, command: '" + does +
                                    "; find $(dirname $(dirname {trajectory})); touch $(dirname "
                                    "{trajectory})/leaving; echo \"#\" > {trajectory}'}]");
  };
  const fs::path run_folder = test_folder() / "again" / "vo-exact-pepper-0";
  EXPECT_EQ(run(bench(suite_that("true"), "again")), 0) << errors();
  EXPECT_TRUE(fs::exists(run_folder / "truth.tum"));
  EXPECT_TRUE(fs::exists(run_folder / "outside" / "leaving"));
  std::ofstream(run_folder / "outside" / "notes.txt") << "mine";
  EXPECT_EQ(run(bench(suite_that(":"), "again")), 0) << errors();
  const std::string seen = content(run_folder / "outside.log");
  EXPECT_NE(seen.find("/dataset/rgb.txt"), std::string::npos) << seen;
  for (const char* never : {"truth", "leaving", "notes", "estimate"})
    EXPECT_EQ(seen.find(never), std::string::npos) << never << " in " << seen;
  EXPECT_EQ(content(run_folder / "outside" / "notes.txt"), "mine");
  EXPECT_TRUE(fs::exists(run_folder / "outside.2" / "trajectory.txt"));
  for (const auto& entry : fs::directory_iterator(test_folder() / "again"))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".work.")) << entry.path();
}

// The program searches its own folder and the folders that it was given, and everything above and
// below them. Results of other systems contain the same ground truth, so they must be hidden from
// it while it runs.
TEST(BenchProcess, AnOutsideProgramFindsNoTruth) {
  const std::string finds =
      "find . $(dirname $(dirname $(dirname {dataset}))) -name truth.tum -o -name estimate.tum -o "
      "-name results.sqlite -o -name views.png; cat $(echo " +
      kRoom + "); echo; echo \"#\" > {trajectory}";
  const fs::path suite =
      write_suite("finds", "[plain, {name: vo, protocol: trajectory, command: '" + finds + "'}]",
                  "", kRoom, "[exact]");
  EXPECT_EQ(run(bench(write_suite("beside", "[plain]"), "beside")), 0) << errors();
  EXPECT_EQ(run(bench(suite, "finds")), 0) << errors();
  EXPECT_TRUE(fs::exists(test_folder() / "finds" / "plain-pepper-0" / "truth.tum"));
  const std::string log = content(test_folder() / "finds" / "vo-exact-pepper-0" / "outside.log");
  if (log.starts_with("modelhouse: nothing is hidden")) GTEST_SKIP() << log;
  EXPECT_TRUE(log.starts_with("modelhouse: hidden from the program by a mount namespace: ")) << log;
  EXPECT_EQ(log.find('\n'), log.size() - 2) << log;
}

TEST(BenchProcess, ASystemOfLasersAloneMapsAndRelocalizes) {
  const fs::path suite = test_folder() / "lasers.yaml";
  mh::test::SmallSuite{
      .systems = "[{name: laser, protocol: conversation, command: /usr/bin/python3 " MH_SOURCE_DIR
                 "/examples/laser_slam/laser_slam.py}]",
      .labels = "[none]",
      .robot = MH_SOURCE_DIR "/robots/turtlebot3/turtlebot3.yaml",
      .more = "senses: [laser, odometry]\n"}
      .write(suite);
  ASSERT_EQ(
      run("bench " + suite.string() + " --frames 120 --cache " +
          (test_folder() / "cache").string() + " --out " + (test_folder() / "lasers").string()),
      0)
      << errors();
  SQLite::Database db((test_folder() / "lasers/results.sqlite").string());
  const auto value = [&](const std::string& metric) {
    return db.execAndGet("SELECT value FROM metrics WHERE name = '" + metric + "'").getDouble();
  };
  EXPECT_LT(value("ate_rmse_m"), 0.05);
  EXPECT_EQ(value("completeness"), 1);
  EXPECT_GE(value("held_out.correct"), 0.9);
}

TEST(BenchProcess, AFolderThatWasDeletedIsToldOf) {
  const fs::path suite = write_suite("deleted", "[plain]");
  EXPECT_EQ(run(bench(suite, "deleted")), 0) << errors();
  EXPECT_EQ(errors().find("gone"), std::string::npos) << errors();
  fs::remove_all(test_folder() / "deleted" / "plain-pepper-0");
  fs::remove(test_folder() / "deleted" / "views.png");
  EXPECT_EQ(run(bench(suite, "deleted")), 0) << errors();
  EXPECT_NE(errors().find("warning: 1 folder of finished runs and 1 sheet of images are missing"),
            std::string::npos)
      << errors();
}

// Files that a scene names are part of the scene: if one of them is replaced, the results are
// computed again, in this folder and in others that share its cache, and no image of the old scene
// is kept.
TEST(BenchProcess, AReplacedMeshMakesResultsMapsAndImagesAnew) {
  const fs::path folder = test_folder() / "replaced_mesh";
  fs::create_directories(folder);
  for (const char* room : {"room", "room_evening"})
    ASSERT_EQ(run("scene convert " MH_SOURCE_DIR "/bench/scenarios/" + std::string(room) +
                  ".yaml --out " + (folder / room).string() + ".glb"),
              0)
        << errors();
  std::ofstream(folder / "scene.yaml") << "name: room\nobjects: [{file: mesh.glb}]\n";
  const fs::path suite = write_suite("replaced", "[semantic]", "", folder / "scene.yaml");
  const auto put = [&](const char* room) {
    fs::copy_file(folder / (std::string(room) + ".glb"), folder / "mesh.glb",
                  fs::copy_options::overwrite_existing);
  };
  const auto made_in = [&](const std::string& out, const std::string& to_do) {
    EXPECT_EQ(run(bench_with_kept_maps(suite, out)), 0) << errors();
    EXPECT_NE(errors().find("2 runs, " + to_do + " of them to do"), std::string::npos) << errors();
    std::string all = tables(out);
    for (const char* image : {"views.png", "semantic-exact-pepper-0/topdown.png"}) {
      EXPECT_TRUE(fs::exists(test_folder() / out / image)) << image;
      all += content(test_folder() / out / image);
    }
    return all;
  };
  put("room");
  const std::string before = made_in("replaced", "2");
  std::ofstream(test_folder() / "replaced/semantic-exact-pepper-0/notes.txt") << "mine";
  put("room_evening");
  const std::string after = made_in("replaced", "2");
  EXPECT_NE(after, before);
  EXPECT_EQ(made_in("replaced_elsewhere", "2"), after) << "a map of the old scene answered";
  fs::remove_all(test_folder() / "cache" / "map");
  EXPECT_EQ(made_in("replaced_without_maps", "2"), after);
  put("room");  // its results are stored, its images are not
  EXPECT_EQ(made_in("replaced", "2"), before);
  EXPECT_EQ(made_in("replaced", "0"), before);
  EXPECT_EQ(content(test_folder() / "replaced/semantic-exact-pepper-0/notes.txt"), "mine");
}

TEST(BenchProcess, AnEditedAnnotationOfAScanMakesItsRunsAnew) {
  const fs::path scan = test_folder() / "scan";
  ASSERT_EQ(run("scene convert " + kRoom + " --format scannet --out " + scan.string()), 0)
      << errors();
  const fs::path suite = write_suite("scanned", "[semantic]", "", scan / "scan_vh_clean_2.ply");
  EXPECT_EQ(run(bench_with_kept_maps(suite, "scanned")), 0) << errors();
  EXPECT_EQ(run(bench_with_kept_maps(suite, "scanned")), 0) << errors();
  EXPECT_NE(errors().find("2 runs, 0 of them to do"), std::string::npos) << errors();
  std::string text = content(scan / "scan.aggregation.json");
  const auto at = text.find("chair");
  ASSERT_NE(at, std::string::npos);
  std::ofstream(scan / "scan.aggregation.json") << text.replace(at, 5, "table");
  EXPECT_EQ(run(bench_with_kept_maps(suite, "scanned")), 0) << errors();
  EXPECT_NE(errors().find("2 runs, 2 of them to do"), std::string::npos) << errors();
  const std::string sheet = content(test_folder() / "scanned" / "reproduction.json");
  for (const char* file : {"scan_vh_clean_2.ply", "scan.aggregation.json", "room.yaml"})
    EXPECT_NE(sheet.find(file), std::string::npos) << file;
}

TEST(BenchProcess, AFileThatChangesDuringTheWorkEndsIt) {
  const fs::path scene = test_folder() / "changed_room.yaml";
  fs::copy_file(kRoom, scene);
  const fs::path began = test_folder() / "began", changed = test_folder() / "changed";
  const fs::path suite = write_suite("changing",
                                     "[{name: vo, protocol: conversation, command: 'touch " +
                                         began.string() + "; while ! test -e " + changed.string() +
                                         "; do sleep 0.1; done; exit 3'}, plain]",
                                     "", scene);
  Command command(bench(suite, "changing", "--jobs 1"));
  for (int i = 0; i < 6000 && command.running() && !fs::exists(began); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  std::ofstream(scene, std::ios::app) << "# x\n";
  std::ofstream(changed) << "";
  EXPECT_EQ(command.wait(), 2) << errors();
  EXPECT_NE(errors().find("a file that it reads was changed"), std::string::npos) << errors();
  EXPECT_EQ(errors().find("plain-pepper-0: failed"), std::string::npos) << errors();
}

TEST(BenchProcess, ACrashIsAFailureAndStaysOne) {
  const fs::path marks = test_folder() / "marks";
  const fs::path suite =
      write_suite("crash", "[plain, {name: crasher, protocol: conversation, command: 'echo x >>" +
                               marks.string() + "; kill -SEGV $$'}]");
  EXPECT_EQ(run(bench(suite, "crash")), 3);
  const std::string reported = errors();
  const std::string why = "was killed by signal 11";
  EXPECT_NE(reported.find("crasher-exact-pepper-0 and 1 more failed; why: see "), std::string::npos)
      << reported;
  std::size_t times = 0;
  for (auto at = reported.find(why); at != std::string::npos; at = reported.find(why, at + 1))
    ++times;
  EXPECT_EQ(times, 2u) << "once for each of the two runs: " << reported;
  const std::string once = content(marks);
  EXPECT_EQ(run(bench(suite, "crash")), 3);
  EXPECT_EQ(content(marks), once) << "a failed run was repeated";
  const std::string table = content(test_folder() / "crash" / "table.txt");
  EXPECT_NE(table.find("plain"), std::string::npos);
  EXPECT_NE(table.find("   failed\n"), std::string::npos) << table;
  EXPECT_NE(table.find("  crasher-exact-pepper-0: "), std::string::npos) << table;
  EXPECT_NE(content(test_folder() / "crash" / "results.json").find("\"status\": \"failed\""),
            std::string::npos);
  EXPECT_EQ(run("export " + (test_folder() / "crash").string() + " --format latex"), 0);
  const std::string latex = content(test_folder() / "stdout");
  EXPECT_NE(latex.find("crasher & 0 of 1, 1 failed & -- & -- & -- & -- & -- & -- & -- "),
            std::string::npos)
      << latex;
  EXPECT_EQ(run(bench(suite, "crash", "--retry-failed")), 3);
  EXPECT_NE(content(marks), once);
}

TEST(BenchProcess, ACrashOfALibraryIsAFailureOfItsRunAlone) {
  const fs::path library = test_folder() / "libtiny.so";
  fs::copy_file(TINY_LIBRARY, library);
  std::string systems = "[";
  for (const char* word : {"crash", "exit", "nan", "print"}) {
    std::ofstream(test_folder() / word) << word;
    systems += std::string("{name: ") + word + ", library: libtiny.so, settings: " + word + "}, ";
  }
  const fs::path suite = write_suite("libraries", systems + "plain]");
  EXPECT_EQ(run(bench(suite, "libraries")), 3);
  const std::string reported = errors();
  for (
      const char* line :
      {"crash-exact-pepper-0: failed: outside library 'crash' (libtiny.so) was killed by signal 6 "
       "during track (request 2)\n",
       "exit-exact-pepper-0: failed: outside library 'exit' (libtiny.so) exited with code 0 during "
       "track (request 2)\n",
       "nan-boxes-pepper-0: failed: outside library 'nan' (libtiny.so) reported an error: \"gave a "
       "pose of [nan, 0, 0, 0, 0, 0, 1]: a number is not finite\", replying to track (request "
       "2)\n"})
    EXPECT_NE(reported.find(line), std::string::npos) << line << reported;
  EXPECT_EQ(reported.find("nonsense"), std::string::npos) << reported;
  EXPECT_EQ(runs_in(test_folder() / "libraries"), 9);
  // What the library prints is neither shown nor mistaken for the bench's own output.
  const std::string said =
      content(test_folder() / "libraries" / "print-exact-pepper-0" / "outside.log");
  EXPECT_NE(said.find("0.5\n~nonsense\n0.5\n"), std::string::npos) << said;
  EXPECT_TRUE(said.ends_with("goodbye\n")) << said;

  // After the library is rebuilt, its runs are repeated.
  EXPECT_EQ(run(bench(suite, "libraries")), 3);
  EXPECT_NE(errors().find("9 runs, 0 of them to do"), std::string::npos) << errors();
  std::ofstream(library, std::ios::app) << "x";
  EXPECT_EQ(run(bench(suite, "libraries")), 3);
  EXPECT_NE(errors().find("9 runs, 8 of them to do"), std::string::npos) << errors();
}

TEST(BenchProcess, LimitsEndARun) {
  EXPECT_EQ(run(bench(write_suite("slow", "[plain]"), "slow", "--time-limit 0.05")), 3);
  EXPECT_NE(errors().find("took longer than the limit of 0.05 s"), std::string::npos) << errors();
  EXPECT_EQ(run(bench(write_suite("large", "[plain]"), "large", "--memory-limit 5")), 3);
  EXPECT_NE(errors().find("needed more memory than the limit of 5 MB"), std::string::npos)
      << errors();
}

TEST(BenchProcess, ASweepOverAFixedMapAnswersAsSeparateQueriesWould) {
  const fs::path sweep = write_suite(
      "sweep", "[semantic]",
      "parameters: {map: fixed, semantics.alpha: [0.8, 0.5], semantics.beta: [0.75, 0.9]}\n");
  EXPECT_EQ(run(bench(sweep, "sweep")), 0) << errors();
  // Two runs of a single point each: the first makes its own map, the second takes the sweep's map
  // from the cache.
  for (const auto& [alpha, beta, point, cache] :
       {std::tuple("0.8", "0.75", 0, "--no-cache"), std::tuple("0.5", "0.9", 3, "")}) {
    const std::string name = std::string("alone") + alpha;
    const fs::path alone = write_suite(name, "[semantic]",
                                       std::string("parameters: {map: fixed, semantics.alpha: [") +
                                           alpha + "], semantics.beta: [" + beta + "]}\n");
    EXPECT_EQ(run(bench_with_kept_maps(alone, name, cache)), 0) << errors();
    EXPECT_EQ(errors().find("baking the light of") != std::string::npos, *cache != '\0')
        << "whether it says what takes long: " << errors();
    const auto queries = [&](const std::string& out, int at) {
      EXPECT_EQ(run("export " + (test_folder() / out).string() + " --format csv"), 0);
      std::istringstream lines(content(test_folder() / "stdout"));
      std::string line, all;
      while (std::getline(lines, line))
        if (line.find("," + std::to_string(at) + ",1,0,1.5," + alpha + "," + beta) !=
            std::string::npos)  // the 0 is the requested label mass: none
          all += line.substr(line.find("," + std::string(alpha) + ",")) + "\n";
      return all;
    };
    EXPECT_EQ(run("export " + (test_folder() / "sweep").string() + " --format latex"), 0);
    const std::string latex = content(test_folder() / "stdout");
    EXPECT_NE(latex.find("semantic & " + std::string(alpha) + " & " + beta + " & 1 & "),
              std::string::npos)
        << latex;
    EXPECT_FALSE(queries("sweep", point).empty());
    EXPECT_EQ(queries("sweep", point), queries(name, 0));
  }
}

TEST(BenchProcess, ASweepOfTheCommandLineNamesItsPointsEverywhere) {
  const fs::path suite = write_suite("counts", "[plain]");
  EXPECT_EQ(run(bench(suite, "counts", "--vary features.count=500,600")), 0) << errors();
  EXPECT_EQ(run("export " + (test_folder() / "counts").string() + " --format csv"), 0) << errors();
  std::istringstream lines(content(test_folder() / "stdout"));
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_TRUE(all[0].ends_with(",features.count")) << all[0];
  EXPECT_TRUE(all[1].ends_with(",500")) << all[1];
  EXPECT_TRUE(all[2].ends_with(",600")) << all[2];
  const SQLite::Database results(test_folder() / "counts" / "results.sqlite");
  SQLite::Statement counts(
      results,
      "SELECT group_concat(json_extract(spec, '$.slam.features.count')) FROM (SELECT spec FROM "
      "runs ORDER BY name)");
  ASSERT_TRUE(counts.executeStep());
  EXPECT_EQ(counts.getColumn(0).getString(), "500,600");
  const std::string table = content(test_folder() / "counts" / "table.txt"),
                    times = content(test_folder() / "counts" / "times.txt");
  EXPECT_NE(table.find("features.count   ATE m"), std::string::npos) << table;
  for (const char* point : {"plain, features.count 500", "plain, features.count 600"})
    EXPECT_NE(times.find(point), std::string::npos) << times;
  EXPECT_EQ(run(bench(suite, "none", "--vary features.cuont=500")), 2);
  EXPECT_NE(errors().find("--vary:"), std::string::npos) << errors();
  EXPECT_NE(errors().find("did you mean 'features.count'?"), std::string::npos) << errors();
  EXPECT_EQ(run(bench(suite, "none", "--vary features.count")), 2);
  EXPECT_NE(errors().find("--vary features.count: is not NAME=VALUE"), std::string::npos)
      << errors();
}

TEST(BenchProcess, BadInputFoundInTheWorkIsNoFailureOfTheMachine) {
  const fs::path mesh = test_folder() / "sliver.ply";
  std::ofstream(mesh) << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty "
                         "float y\nproperty float z\nelement face 1\nproperty list uchar int "
                         "vertex_indices\nend_header\n0 0 0\n0.1 0 0\n0 0.1 0\n3 0 1 2\n";
  std::string suite = content(write_suite("late", "[plain]"));
  const std::string tour = MH_SOURCE_DIR "/bench/scenarios/tours/room.yaml";
  suite.replace(suite.find(tour), tour.size(), "generated:auto:0");
  std::ofstream(test_folder() / "late.yaml") << suite;
  EXPECT_EQ(run(bench(test_folder() / "late.yaml", "late", "--scene " + mesh.string())), 2);
  EXPECT_NE(errors().find("bad input: "), std::string::npos) << errors();
  EXPECT_EQ(errors().find("--retry-failed"), std::string::npos) << errors();
}

TEST(BenchProcess, AScannetFolderIsASceneAndItsWarningsAreToldOnce) {
  const fs::path scan = test_folder() / "scan0000_00";
  ASSERT_EQ(
      run("scene convert " MH_SOURCE_DIR "/bench/scenarios/room.yaml --format scannet --out " +
          scan.string()),
      0)
      << errors();
  fs::remove(scan / "scan0000_00.aggregation.json");
  const std::string warning = "has no scan0000_00.aggregation.json";
  const auto times_told = [&] {
    std::size_t count = 0;
    const std::string all = errors() + content(test_folder() / "stdout");
    for (auto at = all.find(warning); at != all.npos; at = all.find(warning, at + 1)) ++count;
    return count;
  };
  std::string suite = content(write_suite("scan", "[semantic]"));
  const std::string room = MH_SOURCE_DIR "/bench/scenarios/room.yaml";
  suite.replace(suite.find(room), room.size(), "scan0000_00");
  suite.replace(suite.find("[exact, boxes]"), 14, "[exact]");
  std::ofstream(test_folder() / "scan.yaml") << suite;
  EXPECT_EQ(run(bench(test_folder() / "scan.yaml", "scan", "--trials 2")), 0) << errors();
  EXPECT_EQ(times_told(), 1U) << errors();
  const std::string motion = " --motion handheld:0:30 --robot " MH_SOURCE_DIR
                             "/bench/scenarios/robot.yaml --out " +
                             (test_folder() / "out").string();
  for (const std::string& command :
       {"scene info " + scan.string(), "drive " + scan.string() + motion,
        "render " + scan.string() + motion,
        "verify " + (test_folder() / "scan.yaml").string() + " --frames 20"}) {
    EXPECT_EQ(run(command), 0) << command << errors();
    EXPECT_EQ(times_told(), 1U) << command << errors();
  }
  // Labels as boxes need to know which faces belong to which object, and this scan does not store
  // that.
  suite.replace(suite.find("[exact]"), 7, "[boxes]");
  std::ofstream(test_folder() / "scan.yaml") << suite;
  EXPECT_EQ(run(bench(test_folder() / "scan.yaml", "boxes")), 2);
  EXPECT_NE(errors().find("labels 'boxes' are boxes around objects"), std::string::npos)
      << errors();
}

TEST(BenchProcess, WhatIsRefusedLeavesNoFolder) {
  const fs::path out = test_folder() / "new" / "folder";
  EXPECT_EQ(run("bench " + write_suite().string() + " --out " + out.string() + " --scene " +
                (test_folder() / "small.yaml").string()),
            2);
  EXPECT_FALSE(fs::exists(test_folder() / "new")) << errors();
  const fs::path part = test_folder() / "part";
  fs::create_directories(part);
  std::ofstream(part / "results.sqlite") << std::string(5000, 'x');
  EXPECT_EQ(run("merge " + out.string() + " " + part.string()), 2);
  EXPECT_NE(errors().find("is damaged"), std::string::npos) << errors();
  EXPECT_FALSE(fs::exists(test_folder() / "new"));
}

TEST(BenchProcess, MergingAPartTwiceIsHarmless) {
  undisturbed();
  const std::string part = (test_folder() / "plain_run").string();
  EXPECT_EQ(run("merge " + (test_folder() / "twice").string() + " " + part + " " + part), 0)
      << errors();
  EXPECT_EQ(errors(), "merge: " + part + ": holds no new results: all of them are here already\n");
  EXPECT_EQ(tables("twice"), undisturbed());
}

TEST(BenchProcess, AnImageThatFoundNoRoomIsCopiedByTheNextMerge) {
  undisturbed();
  const fs::path part = test_folder() / "big_part", out = test_folder() / "limited";
  fs::copy(test_folder() / "plain_run", part, fs::copy_options::recursive);
  fs::resize_file(part / "views.png", 40'000'000);
  const std::string merge =
      " " MH_EXECUTABLE " merge " + out.string() + " " + part.string() + " >/dev/null 2>&1";
  // A file size limit of 20 MB stands in for a full disk.
  EXPECT_NE(std::system(("trap '' XFSZ; ulimit -f 40000; exec" + merge).c_str()), 0);
  for (const auto& entry : fs::directory_iterator(out))
    EXPECT_NE(entry.path().extension(), ".png") << entry.path();
  EXPECT_EQ(std::system(("exec" + merge).c_str()), 0);
  EXPECT_EQ(fs::file_size(out / "views.png"), 40'000'000u);
}

TEST(BenchProcess, PartsThatDoNotBelongTogetherAreRefusedAndLeaveNothing) {
  const std::string out = (test_folder() / "mixed").string();
  const std::string part = " " + (test_folder() / "f45").string();
  EXPECT_EQ(run(bench(write_suite(), "f45", "--shard 3/3")), 0) << errors();
  EXPECT_EQ(run("bench " + write_suite().string() + " --frames 46 --shard 3/3 --cache " +
                (test_folder() / "cache").string() + " --out " + (test_folder() / "f46").string()),
            0)
      << errors();
  EXPECT_EQ(run("merge " + out + part + " " + (test_folder() / "f46").string()), 2);
  EXPECT_NE(errors().find("made with settings, input or code different"), std::string::npos)
      << errors();
  EXPECT_EQ(run(bench(write_suite(), "trials", "--trials 2 --shard 6/6")), 0) << errors();
  EXPECT_EQ(run("merge " + out + part + " " + (test_folder() / "trials").string()), 2);
  EXPECT_NE(errors().find("trials/results.sqlite: was run with --trials 2, "), std::string::npos)
      << errors();
  EXPECT_NE(errors().find("f45/results.sqlite has 1: "), std::string::npos) << errors();
  EXPECT_EQ(run(bench(write_suite("second", "[plain]"), "second")), 0) << errors();
  EXPECT_EQ(run("merge " + out + part + " " + (test_folder() / "second").string()), 2);
  EXPECT_NE(errors().find("of the suite 'second'"), std::string::npos) << errors();
  EXPECT_FALSE(fs::exists(out));
}

TEST(BenchProcess, AnAuditLeavesItsTablesAndIsNotRepeated) {
  const fs::path out = test_folder() / "audited";
  const std::string command = "audit " + write_suite().string() + " --frames 45 --cache " +
                              (test_folder() / "cache").string() + " --out " + out.string();
  ASSERT_EQ(run(command), 0) << errors();
  EXPECT_NE(errors().find("run and audit of semantic-exact"), std::string::npos) << errors();
  const std::string table = content(test_folder() / "stdout");
  for (const char* part :
       {"first cause", "ceilings", "retrieval", "by words with every keyframe", "CPU time"})
    EXPECT_NE(table.find(part), std::string::npos) << part;
  const std::string csv = content(out / "audit.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * (4 + 4)) << csv;
  const std::string json = content(out / "audit.json");

  ASSERT_EQ(run(command + " --json"), 0) << errors();
  EXPECT_EQ(errors().find("run and audit of"), std::string::npos) << errors();
  EXPECT_EQ(content(test_folder() / "stdout"), json);
  EXPECT_EQ(content(out / "audit.csv"), csv);
}

TEST(BenchProcess, ABenchWithAnAuditGivesTheSameResultsAndTheSameAudit) {
  ASSERT_EQ(run(bench(write_suite(), "bench_and_audit", "--audit")), 0) << errors();
  EXPECT_NE(content(test_folder() / "stdout").find("ceilings"), std::string::npos);
  EXPECT_EQ(tables("bench_and_audit"), undisturbed());
  const std::string alone = (test_folder() / "audit_alone").string();
  ASSERT_EQ(run("audit " + write_suite().string() + " --frames 45 --no-cache --out " + alone), 0)
      << errors();
  EXPECT_EQ(content(test_folder() / "bench_and_audit" / "audit.csv"),
            content(fs::path(alone) / "audit.csv"));

  // An audit is kept next to the results that it belongs to, and removed when the results change.
  const fs::path audited = test_folder() / "bench_and_audit" / "audit.json";
  EXPECT_EQ(run(bench(write_suite(), "bench_and_audit")), 0) << errors();
  EXPECT_TRUE(fs::exists(audited));
  EXPECT_EQ(run(bench(write_suite("fewer", "[plain]"), "bench_and_audit")), 0) << errors();
  EXPECT_NE(errors().find("removed audit.json"), std::string::npos) << errors();
  EXPECT_FALSE(fs::exists(audited));
  const std::string out = (test_folder() / "bench_and_audit").string();
  EXPECT_EQ(run("audit " + write_suite().string() + " --frames 45 --no-cache --out " + out), 2);
  EXPECT_NE(errors().find("holds results of runs that"), std::string::npos) << errors();
  EXPECT_FALSE(fs::exists(audited));
  EXPECT_EQ(run(bench(write_suite(), "part", "--audit --shard 1/3")), 2);
  EXPECT_NE(errors().find("--audit: needs the whole suite"), std::string::npos) << errors();
}

TEST(BenchProcess, BadInputIsTold) {
  std::ofstream(test_folder() / "empty.yaml");
  EXPECT_EQ(run("bench " + (test_folder() / "empty.yaml").string()), 2);
  EXPECT_NE(errors().find("empty.yaml: the file is empty"), std::string::npos) << errors();
  EXPECT_EQ(run(bench(write_suite(), "bad", "--shard 4/3")), 2);
  EXPECT_NE(errors().find("shard '4/3'"), std::string::npos) << errors();
  EXPECT_EQ(run(bench(write_suite(), "bad", "--shard 1/-3")), 2);
  EXPECT_NE(errors().find("shard '1/-3'"), std::string::npos) << errors();
  EXPECT_EQ(run("scene info generated:cave:0"), 2);
  EXPECT_NE(errors().find("cave"), std::string::npos) << errors();
  EXPECT_EQ(run("export " + (test_folder() / "nowhere").string()), 2);
  EXPECT_EQ(run("merge " + (test_folder() / "m").string() + " " + test_folder().string()), 2);
}

}  // namespace
