// SPDX-License-Identifier: Apache-2.0
#include "bench/store/store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/report/export.hpp"
#include "bench/report/results_json.hpp"
#include "bench/run/pool.hpp"
#include "bench/run/run_process.hpp"
#include "bench/run/run_suite.hpp"
#include "bench/suite/json_fields.hpp"
#include "bench/suite/run_spec.hpp"
#include "slam/io/file_errors.hpp"
#include "slam/io/files.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;

/// A run that contains everything once: a tracked and an untracked frame, an answered and an
/// unanswered query, unknown scores, numbers that decimal text would round.
RunResult some_run(const std::string& name, double shift_m = 0.0) {
  const auto pose = [&](double x) {
    return SE3(Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3), Eigen::Vector3d(x / 3.0 + shift_m, 0.1, 2));
  };
  RunResult run;
  run.spec.name = name;
  run.spec.environment = {.name = "room",
                          .category = "rooms",
                          .scene = "a/room.yaml",
                          .robot = "a/robot.yaml",
                          .mapping_tour = "a/tour.yaml",
                          .query_tour = {}};
  run.spec.level.file = "levels/pepper.yaml";
  run.spec.points = {SemanticConfig{}};
  run.place.scene = "room";
  run.place.scene_digest = 0xfedcba9876543210;
  run.place.mapping.contact_time_s = std::nan("");
  run.place.inputs = {{"scene", 7}};
  run.truth = {{0, pose(0)}, {33, pose(1)}};
  run.estimate = {{33, pose(1.1)}};
  run.mapping.calls = {
      {.index = 0, .stamp_ns = 0, .restart = 0, .status = TrackStatus::kLost, .inliers = {}},
      {.index = 1,
       .stamp_ns = 33,
       .restart = 1,
       .status = TrackStatus::kTracked,
       .inliers = 12,
       .keyframe_added = true,
       .image_digest = 1,
       .matching_digest = 0xffffffffffffffff,
       .pose_digest = 3}};
  run.mapping.dropped = {5};
  run.mapping.matches.emplace()[0].compared = 9;
  run.trajectory.completeness = 1.0 / 3.0;
  run.trajectory.rpe_frame_rmse_m = 0.1;
  QueryScore answered, unanswered;
  answered.answer.index = 29;
  answered.success = answered.correct = true;
  answered.true_world_from_camera = pose(6);
  answered.distance_m = 1.0 / 7.0;
  answered.answer.world_from_camera = pose(5);
  answered.answer.stage = RelocalizationStage::kVerified;
  answered.answer.candidates = {.keyframes = 3,
                                .c1 = 2,
                                .c2 = {},
                                .c3 = 0,
                                .final = 1,
                                .label_mass = 0.3,
                                .gamma = 1.25,
                                .unscored = 0.5,
                                .stale = 0.25,
                                .stale_weight = 0.125,
                                .stale_age = 3};
  answered.answer.matches.emplace()[3].penalized = 4;
  unanswered.answer.index = 59;
  unanswered.answer.stage = RelocalizationStage::kPnp;
  run.points = {{.held_out = {answered, unanswered}, .second_tour = {unanswered}}};
  run.episodes = {{.variant = "moved",
                   .start = 4,
                   .goal = "bed",
                   .reason = "stuck",
                   .time_s = 12.5,
                   .located_s = 1.0 / 3.0,
                   .length_m = 7,
                   .collisions = 1,
                   .digest = 0xfedcba9876543210},
                  {.variant = "as_mapped", .start = 2, .success = true, .spl = 0.1}};
  run.map_digest = 77;
  run.times.track_ms = {1.25};
  return run;
}

class StoreFile : public testing::Test {
 protected:
  StoreFile() : folder_(fs::temp_directory_path() / ("mh_store_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~StoreFile() override { fs::remove_all(folder_); }
  std::string error_of_opening(const fs::path& file) const {
    try {
      Store store(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  Suite suite() const {
    Suite s;
    s.name = "s";
    s.file = folder_ / "suite.yaml";
    s.text = whole_suite().text;
    return s;
  }

  /// A suite with one system, which can be read back from the text that a store keeps of it.
  Suite whole_suite() const {
    const fs::path file = folder_ / "suite.yaml";
    std::ofstream(file) << "environments: [{category: room, scene: r.yaml, mapping_tour: t.yaml}]\n"
                           "robot: robot.yaml\nvocabulary: v.mhvoc\nlevels: [pepper.yaml]\n"
                           "systems: [plain]\nlabels: [exact]\ntrials: 3\n";
    return parse_suite(read_file(file), file, {}, false);
  }
  /// A finished run, a failed one and a missing one.
  void write_results(const fs::path& file) const {
    const Suite s = whole_suite();
    const auto specs = expand(s);
    Store store(file);
    store.plan(s, {}, {{specs[0].name, "k0"}, {specs[1].name, "k1"}, {specs[2].name, "k2"}});
    RunResult run = some_run(specs[0].name);
    for (int i = 2; i < 60; ++i) run.truth.push_back({33 * i, run.truth[1].world_from_camera});
    store.put("k0", run, {.wall_s = 2, .max_rss_mb = 12});
    store.put_failure("k1", some_run(specs[1].name).spec, "ended by signal 11", {});
  }
  /// What a user gets from a file: its exports and the data of the table.
  static std::string exports(const fs::path& file) {
    const Store store = Store::open_to_read(file);
    const Suite planned = store.planned_suite();
    const BenchResults results = load_results(store, planned);
    return export_json(store) + export_csv(store) + export_latex(store) +
           results_json(planned, results.runs, results.failed, results.missing).dump();
  }
  /// A pool whose runs execute this shell script.
  PoolOptions pool_of(const std::string& script) const {
    const fs::path program = folder_ / "program";
    std::ofstream(program) << "#!/bin/sh\n" << script;
    fs::permissions(program, fs::perms::owner_all);
    PoolOptions options;
    options.executable = program;
    options.work_folder = folder_;
    options.arguments = [](const Job&) { return std::vector<std::string>(); };
    return options;
  }
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_))
      found[entry.path().filename().string()] = read_file(entry.path());
    return found;
  }

  fs::path folder_;
};

// The results include what the patterns matched and what --set gave, so they can be read on
// machines without the scans.
TEST_F(StoreFile, ASuiteOfRecordingsIsReadBackWhereTheRecordingsAreNot) {
  for (const char* name : {"scene0000_00", "scene0001_00"}) {
    fs::create_directories(folder_ / "scans" / name / "color");
    fs::create_directories(folder_ / "scans" / name / "depth");
  }
  write_atomically(folder_ / "words", "x");
  write_atomically(folder_ / "suite.yaml",
                   "environments:\n- {sequences: '${scans}/scene*', category: scan}\n"
                   "vocabulary: words\nsystems: [plain]\nlabels: [none]\n");
  SuiteOverrides overrides;
  overrides.set["scans"] = (folder_ / "scans").string();
  const Suite suite = load_suite(folder_ / "suite.yaml", overrides);
  Store store(folder_ / "results.sqlite");
  store.plan(suite, overrides, {{"run", "key"}});
  fs::remove_all(folder_ / "scans");
  const Suite again = store.planned_suite();
  ASSERT_EQ(again.environments.size(), 2U);
  EXPECT_EQ(again.environments[1].sequence, suite.environments[1].sequence);
  EXPECT_EQ(again.set, overrides.set);
  EXPECT_EQ(again.found, suite.found);
}

TEST_F(StoreFile, NoFlippedByteChangesWhatIsExported) {
  const fs::path good = folder_ / "good.sqlite", bad = folder_ / "bad.sqlite";
  write_results(good);
  ASSERT_FALSE(fs::exists(good.string() + "-wal")) << "the file holds all";
  const std::string bytes = read_file(good), expected = exports(good);
  ASSERT_NE(expected.find("ended by signal 11"), std::string::npos);
  std::mt19937 random(18);
  int refused = 0;
  for (int flip = 0; flip < 500; ++flip) {
    const std::size_t at = random() % bytes.size();
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 + random() % 255));
    std::ofstream(bad, std::ios::binary) << damaged;
    try {
      EXPECT_EQ(exports(bad), expected) << "byte " << at << " was flipped";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(bad.string()), 0u) << error.what();
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "byte " << at << ": no InputError: " << error.what();
    }
    fs::remove(bad.string() + "-wal");
    fs::remove(bad.string() + "-shm");
  }
  EXPECT_GT(refused, 100);
}

TEST_F(StoreFile, AChangedValueOfAnyTableIsNamed) {
  const fs::path file = folder_ / "r.sqlite";
  for (const std::string change :
       {"UPDATE suite SET name = 'other'", "UPDATE plan SET position = 7 WHERE position = 2",
        "UPDATE runs SET seed = 5 WHERE status = 'done'", "UPDATE points SET alpha = 0.125",
        "UPDATE metrics SET value = value + 1 WHERE name = 'completeness'",
        "UPDATE calls SET status = 'lost' WHERE call = 1",
        "UPDATE frames SET estimate_tx = 0 WHERE frame = 1",
        "UPDATE queries SET correct = 0 WHERE correct = 1", "UPDATE times SET wall_s = 1"}) {
    fs::remove(file);
    write_results(file);
    EXPECT_NO_THROW(exports(file));
    SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec(change);
    const std::string table = change.substr(7, change.find(' ', 7) - 7);
    try {
      exports(file);
      ADD_FAILURE() << change;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("of its table '" + table + "'"), std::string::npos)
          << error.what();
    }
    EXPECT_THROW(Store(folder_ / "all.sqlite").merge(file), InputError);
  }
}

TEST_F(StoreFile, ALostRowOfAnyTableIsNamed) {
  const fs::path file = folder_ / "r.sqlite";
  for (const auto& [table, named] : std::map<std::string, std::string>{
           {"plan", "its table 'plan' has 0 of 3 rows"},
           {"runs", "belong to a run that its table 'runs' has lost"},
           {"points", "run '"},
           {"metrics", "run '"},
           {"calls", "run '"},
           {"frames", "run '"},
           {"queries", "run '"},
           {"times", "run '"}}) {
    fs::remove(file);
    write_results(file);
    SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec("DELETE FROM " + table);
    try {
      exports(file);
      ADD_FAILURE() << table;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("is damaged: "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
    EXPECT_THROW(Store(folder_ / "all.sqlite").merge(file), InputError);
  }
}

/// Runs as a user other than root during its lifetime; root may write everywhere.
class AsNobody {
 public:
  AsNobody() { failed_ = geteuid() == 0 && seteuid(65534) != 0; }
  ~AsNobody() {
    if (getuid() == 0 && seteuid(0) != 0) std::abort();
  }
  bool failed() const { return failed_; }

 private:
  bool failed_;
};

TEST_F(StoreFile, AFileThatMayOnlyBeReadIsExportedAndMerged) {
  const fs::path file = folder_ / "sealed" / "r 100%?.sqlite";
  fs::create_directories(file.parent_path());
  write_results(file);
  const std::string expected = exports(file), bytes = read_file(file);
  fs::permissions(folder_, fs::perms::all);
  const auto try_it = [&] {
    fs::permissions(file, fs::perms(0444));
    fs::permissions(file.parent_path(), fs::perms(0555));
    const AsNobody nobody;
    ASSERT_FALSE(nobody.failed());
    EXPECT_EQ(exports(file), expected);
    Store all(folder_ / "all.sqlite");
    EXPECT_EQ(all.merge(file), 2u);
    EXPECT_EQ(exports(folder_ / "all.sqlite"), expected);
  };
  try_it();
  EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), {}), 1) << "nothing beside";
  EXPECT_EQ(read_file(file), bytes);

  // The same file as left by a process that was killed: part of its content is in the write-ahead
  // log.
  for (const char* name : {"all.sqlite", "all.sqlite-wal", "all.sqlite-shm"})
    fs::remove(folder_ / name);
  fs::permissions(file.parent_path(), fs::perms::all);
  fs::remove(file);
  if (const pid_t writer = fork(); writer == 0) {
    write_results(file);
    Store store(file);
    store.put_failure("k9", some_run("x").spec, "in the log", {});
    kill(getpid(), SIGKILL);
  } else {
    waitpid(writer, nullptr, 0);
  }
  const fs::path log = file.string() + "-wal";
  ASSERT_GT(fs::file_size(log), 0u);
  fs::remove(file.string() + "-shm");
  fs::permissions(log, fs::perms(0444));
  fs::permissions(file, fs::perms(0444));
  fs::permissions(file.parent_path(), fs::perms(0555));
  {
    const AsNobody nobody;
    EXPECT_EQ(Store::open_to_read(file).error("k9"), "in the log");
    EXPECT_EQ(Store(folder_ / "all.sqlite").merge(file), 3u);
  }
  fs::permissions(file.parent_path(), fs::perms::all);
}

TEST_F(StoreFile, ARunComesBackAsItWas) {
  Store store(folder_ / "r.sqlite");
  const RunResult run = some_run("a");
  store.put("k", run, {.wall_s = 2});
  EXPECT_EQ(store.status("k"), RunStatus::kDone);
  const RunResult once = store.load("k", run.spec);
  EXPECT_EQ(once.place.scene_digest, run.place.scene_digest);
  EXPECT_TRUE(std::isnan(once.place.mapping.contact_time_s));
  EXPECT_EQ(once.place.inputs, run.place.inputs);
  ASSERT_EQ(once.mapping.calls.size(), 2u);
  EXPECT_EQ(once.mapping.calls[1].matching_digest, 0xffffffffffffffff);
  EXPECT_EQ(once.mapping.calls[1].status, TrackStatus::kTracked);
  EXPECT_EQ(once.mapping.dropped, run.mapping.dropped);
  ASSERT_TRUE(once.mapping.matches);
  EXPECT_EQ((*once.mapping.matches)[0].compared, 9);
  EXPECT_EQ(json_of(once.episodes).dump(), json_of(run.episodes).dump());
  EXPECT_EQ(once.trajectory.completeness, 1.0 / 3.0);
  EXPECT_FALSE(once.trajectory.ate_rmse_m);
  EXPECT_EQ(once.estimate.size(), 1u);
  EXPECT_EQ(once.estimate[0].stamp_ns, 33);
  EXPECT_EQ(once.estimate[0].world_from_camera.translation(),
            run.estimate[0].world_from_camera.translation());
  const PointResult& p = once.points.at(0);
  ASSERT_EQ(p.held_out.size(), 2u);
  EXPECT_EQ(p.held_out[0].distance_m, 1.0 / 7.0);
  EXPECT_EQ(p.held_out[0].answer.candidates, run.points[0].held_out[0].answer.candidates);
  ASSERT_TRUE(p.held_out[0].answer.matches);
  EXPECT_EQ((*p.held_out[0].answer.matches)[3].penalized, 4);
  EXPECT_FALSE(p.held_out[1].answer.matches);
  EXPECT_FALSE(p.held_out[1].answer.world_from_camera);
  EXPECT_EQ(p.held_out[1].answer.stage, RelocalizationStage::kPnp);
  EXPECT_EQ(p.second_tour.size(), 1u);
  EXPECT_EQ(once.times.track_ms, run.times.track_ms);
  // Rotations are converted to quaternions, which changes at most their last digit.
  EXPECT_LT(
      (once.estimate[0].world_from_camera.rotation() - run.estimate[0].world_from_camera.rotation())
          .cwiseAbs()
          .maxCoeff(),
      1e-15);
}

TEST_F(StoreFile, ARunThatMetAFullDiskIsNoFailure) {
  Store store(folder_ / "r.sqlite");
  const PoolOptions options = pool_of(
      fmt::format("echo 'modelhouse: error: x: the disk is full' >&2\nexit {}\n", kDiskFullCode));
  EXPECT_THROW(run_pending(store, {{some_run("a").spec, "k"}}, options), DiskFullError);
  EXPECT_EQ(store.status("k"), std::nullopt);
  EXPECT_TRUE(store.claim("k")) << "its claim was kept";
}

// These exit codes have our meaning only together with an error that we reported: a library in the
// process may exit with them, too.
TEST_F(StoreFile, AnExitCodeWithoutAnErrorOfOursIsAFailureOfTheRunAlone) {
  for (const int code : {kBadInputCode, kDiskFullCode, kInputChangedCode}) {
    Store store(folder_ / fmt::format("{}.sqlite", code));
    const PoolOptions options = pool_of(fmt::format("exit {}\n", code));
    run_pending(store, {{some_run("a").spec, "k"}}, options);
    EXPECT_EQ(store.error("k"), fmt::format("exited with code {}", code));
  }
}

TEST_F(StoreFile, ACrashSaysWhere) {
  Store store(folder_ / "r.sqlite");
  const PoolOptions options =
      pool_of(fmt::format("echo '{}frame 7 of 9'\nkill -SEGV $$\n", kStatusMark));
  run_pending(store, {{some_run("a").spec, "k"}}, options);
  EXPECT_EQ(store.error("k"),
            "ended by signal 11 (Segmentation fault), last seen at 'frame 7 of 9'");
}

TEST_F(StoreFile, BadInputFoundLateIsToldAsSuchAndStagesAreSaid) {
  Store store(folder_ / "r.sqlite");
  std::vector<std::string> said;
  PoolOptions options = pool_of(
      "echo 0.5; echo baking the light of a room; echo 0.75\n"
      "echo 'modelhouse: error: x.ply: no floor' >&2\nexit 2\n");
  options.say = [&](std::string_view line) { said.emplace_back(line); };
  run_pending(store, {{some_run("a").spec, "k"}}, options);
  EXPECT_EQ(store.error("k"), std::string(kBadInputMark) + "x.ply: no floor");
  EXPECT_EQ(said, (std::vector<std::string>{"a: baking the light of a room",
                                            "a: failed: bad input: x.ply: no floor"}));
}

// Four runs: one that another process has finished meanwhile, one that failed there, one that
// succeeds and one that does not. Each is counted once, and the reported share of work is that of
// the runs that are settled.
TEST_F(StoreFile, TheWorkDoneIsTheRunsThatAreSettled) {
  Store store(folder_ / "r.sqlite");
  store.put("done", some_run("a"), {});
  store.put_failure("failed", some_run("b").spec, "x", {});
  PoolOptions options = pool_of("[ \"$1\" = well ]\n");
  options.arguments = [&](const Job& job) {
    if (job.key == "well") store.put(job.key, some_run("c"), {});
    return std::vector<std::string>{job.key};
  };
  using Counts = std::tuple<std::size_t, std::size_t, double>;
  std::vector<Counts> seen;
  bool to_go = false;
  options.progress = [&](const PoolProgress& p) {
    if (const Counts now{p.done, p.failed, p.share}; seen.empty() || seen.back() != now)
      seen.push_back(now);
    to_go = p.to_go_s.has_value();
  };
  run_pending(store,
              {{some_run("a").spec, "done"},
               {some_run("b").spec, "failed"},
               {some_run("c").spec, "well"},
               {some_run("d").spec, "badly"}},
              options);
  EXPECT_EQ(seen, (std::vector<Counts>{
                      {0, 0, 0.0}, {1, 0, 0.25}, {1, 1, 0.5}, {2, 1, 0.75}, {2, 2, 1.0}}));
  EXPECT_FALSE(to_go) << "nothing is left to be waited for";
  EXPECT_EQ(store.error("badly"), "exited with code 1");
}

// Eight runs of two environments, planned trial by trial: runs that see the same images follow one
// another, and the images are removed when the last of these runs is over, successful or not; the
// same holds for the frames of a trial.
TEST_F(StoreFile, RunsThatSeeTheSameImagesFollowOneAnother) {
  Store store(folder_ / "r.sqlite");
  std::vector<std::string> events;
  PoolOptions options;
  options.executable = "/bin/false";
  options.work_folder = folder_;
  options.arguments = [&](const Job& job) {
    events.push_back(job.key);
    return std::vector<std::string>();
  };
  options.forget = [&](const std::string& name) { events.push_back("no " + name); };
  std::vector<Job> jobs;
  for (const char* trial : {"1", "2"})
    for (const char* images : {"a", "b"})
      for (const char* system : {"x", "y"}) {
        const std::string name = std::string(images) + trial + system;
        jobs.push_back({some_run(name).spec, name, images, std::string(images) + "/" + trial});
      }
  run_pending(store, jobs, options);
  EXPECT_EQ(events,
            (std::vector<std::string>{"a1x", "a1y", "no a/1", "a2x", "a2y", "no a/2", "no a", "b1x",
                                      "b1y", "no b/1", "b2x", "b2y", "no b/2", "no b"}));
}

TEST_F(StoreFile, TwoAtATimeAreAtImagesOfTheirOwnAsLongAsThereAreTwo) {
  Store store(folder_ / "r.sqlite");
  std::vector<std::string> started;
  PoolOptions options = pool_of("while [ ! -e \"$1\" ]; do sleep 0.02; done\nexit 1\n");
  options.jobs = 2;
  options.arguments = [&](const Job& job) {
    started.push_back(job.key);
    const fs::path gate = folder_ / "gate";
    if (job.key == "b2") std::ofstream(gate) << "open";
    return std::vector<std::string>{job.key == "a1" ? gate
                                                    : options.executable};  // a1 waits for the gate
  };
  std::vector<Job> jobs;
  for (const char* key : {"a1", "a2", "b1", "b2"})
    jobs.push_back({some_run(key).spec, key, std::string(1, key[0])});
  run_pending(store, jobs, options);
  // a2 runs at the same time as a1 only if there is nothing else to do.
  EXPECT_EQ(started, (std::vector<std::string>{"a1", "b1", "b2", "a2"}));
}

TEST_F(StoreFile, AFileWithoutItsTablesIsRefusedWithAdvice) {
  const fs::path file = folder_ / "r.sqlite";
  { Store store(file); }
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec("DROP TABLE runs");
  try {
    Store(file).status("k");
    FAIL();
  } catch (const InputError& e) {
    const std::string message = e.what();
    EXPECT_TRUE(message.starts_with(file.string())) << message;
    EXPECT_NE(message.find("move it away"), std::string::npos) << message;
  }
}

TEST_F(StoreFile, ANewerSchemaIsRefused) {
  const fs::path file = folder_ / "r.sqlite";
  { Store store(file); }
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  const std::string message = error_of_opening(file);
  EXPECT_NE(message.find("has schema 99"), std::string::npos) << message;
  EXPECT_NE(message.find("newer"), std::string::npos) << message;
}

TEST_F(StoreFile, AnOlderSchemaIsRefusedWithAdvice) {
  const fs::path file = folder_ / "r.sqlite";
  { Store store(file); }
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 4");
  const std::string message = error_of_opening(file);
  EXPECT_NE(message.find("has schema 4"), std::string::npos) << message;
  EXPECT_NE(message.find("move it away and run again"), std::string::npos) << message;
  EXPECT_THROW(Store::open_to_read(file), InputError);
}

TEST_F(StoreFile, ADamagedOrForeignFileIsRefusedWithAdvice) {
  const fs::path file = folder_ / "r.sqlite";
  std::ofstream(file) << std::string(5000, 'x');
  EXPECT_NE(error_of_opening(file).find("move it away"), std::string::npos);
  fs::remove(file);
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("CREATE TABLE cats (name TEXT)");
  EXPECT_NE(error_of_opening(file).find("not a results file"), std::string::npos);
  fs::remove(file);
  {
    Store store(file);
    for (int i = 0; i < 20; ++i) store.put(fmt::format("k{}", i), some_run("a"), {});
  }
  ASSERT_GT(fs::file_size(file), 40000u);
  {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekp(8192);
    bytes << std::string(16384, '\xff');
  }
  EXPECT_NE(error_of_opening(file).find("is damaged"), std::string::npos);
}

TEST_F(StoreFile, ARunIsClaimedOnce) {
  const fs::path file = folder_ / "r.sqlite";
  Store one(file), two(file);
  EXPECT_TRUE(one.claim("k"));
  EXPECT_FALSE(two.claim("k"));
  one.release("k");
  EXPECT_TRUE(two.claim("k"));
  two.put("k", some_run("a"), {});
  EXPECT_FALSE(one.claim("k")) << "it is finished";
  EXPECT_EQ(one.rows("SELECT * FROM claims").size(), 1u) << "the header alone";
}

TEST_F(StoreFile, AClaimOfADeadProcessIsTakenOver) {
  const fs::path file = folder_ / "r.sqlite";
  Store store(file);
  ASSERT_TRUE(store.claim("k"));
  SQLite::Database raw(file.string(), SQLite::OPEN_READWRITE);
  raw.exec("UPDATE claims SET started = started - 1");  // its number is in use by another process
  EXPECT_TRUE(store.claim("k"));
  raw.exec("UPDATE claims SET host = 'elsewhere'");
  EXPECT_FALSE(store.claim("k")) << "it may live: it showed itself just now";
  raw.exec("UPDATE claims SET beat = beat - 1000");
  EXPECT_TRUE(store.claim("k"));
}

TEST_F(StoreFile, AFailureStaysUntilItIsForgotten) {
  Store store(folder_ / "r.sqlite");
  store.put_failure("k", some_run("a").spec, "ended by signal 11", {});
  EXPECT_EQ(store.status("k"), RunStatus::kFailed);
  EXPECT_EQ(store.error("k"), "ended by signal 11");
  EXPECT_FALSE(store.claim("k"));
  store.forget_failure("k");
  EXPECT_FALSE(store.status("k"));
  store.put("k", some_run("a"), {});
  store.forget_failure("k");
  EXPECT_EQ(store.status("k"), RunStatus::kDone) << "a result is not a failure";
}

TEST_F(StoreFile, MergingTakesOverWhatIsMissingOnce) {
  const Suite s = suite();
  Store a(folder_ / "a.sqlite"), b(folder_ / "b.sqlite");
  const std::vector<std::pair<std::string, std::string>> plan = {{"x", "kx"}, {"y", "ky"}};
  a.plan(s, {}, plan);
  b.plan(s, {}, plan);
  a.put("kx", some_run("x"), {});
  a.put_failure("ky", some_run("y").spec, "crashed", {});
  b.put("ky", some_run("y", 1.0), {});
  Store all(folder_ / "all.sqlite");
  all.merge(a.file());
  all.merge(b.file());
  all.merge(b.file());
  EXPECT_EQ(all.planned_keys(), plan);
  EXPECT_EQ(
      all.rows("SELECT name, status FROM runs ORDER BY name"),
      (std::vector<std::vector<std::string>>{{"name", "status"}, {"x", "done"}, {"y", "done"}}));
  EXPECT_EQ(all.rows("SELECT * FROM queries").size(), 1u + 2 * 3);
}

TEST_F(StoreFile, MergingNeverPutsAFailureInThePlaceOfAResultNorOneFailureInThatOfAnother) {
  const Suite s = suite();
  const std::vector<std::pair<std::string, std::string>> plan = {{"x", "kx"}};
  int files = 0;
  const auto store_with = [&](bool done, double shift_m, const std::string& error) {
    Store store(folder_ / fmt::format("{}.sqlite", files++));
    store.plan(s, {}, plan);
    done ? store.put("kx", some_run("x", shift_m), {})
         : store.put_failure("kx", some_run("x").spec, error, {});
    return store;
  };
  const auto merged = [&](Store first, const Store& second) {
    const std::size_t taken = first.merge(second.file());
    return std::tuple(taken, first.status("kx").value(), first.error("kx"),
                      first.rows("SELECT * FROM queries").size() - 1);
  };
  EXPECT_EQ(merged(store_with(true, 0, ""), store_with(false, 0, "crashed")),
            std::tuple(0u, RunStatus::kDone, "", 3u));
  EXPECT_EQ(merged(store_with(false, 0, "crashed"), store_with(true, 0, "")),
            std::tuple(1u, RunStatus::kDone, "", 3u));
  EXPECT_EQ(merged(store_with(false, 0, "first"), store_with(false, 0, "second")),
            std::tuple(0u, RunStatus::kFailed, "first", 0u));
  Store here = store_with(true, 1, "");
  EXPECT_EQ(here.merge(store_with(true, 1, "").file()), 0u) << "only its times may differ";
  EXPECT_THROW(here.merge(store_with(true, 2, "").file()), InputError);
  EXPECT_EQ(here.load("kx", some_run("x").spec).truth[0].world_from_camera.translation().x(), 1)
      << "what is here stays";
}

TEST_F(StoreFile, ADamagedPartIsNamedBeforeAnythingIsMerged) {
  const Suite s = whole_suite();
  const std::string name = expand(s)[0].name;
  const fs::path good = folder_ / "good.sqlite", bad = folder_ / "bad.sqlite";
  for (const fs::path& part : {good, bad}) {
    Store store(part);
    store.plan(s, {}, {{name, "k"}});
    store.put("k", some_run(name), {});
  }
  const auto refused = [&] {
    try {
      Store::check_mergeable({good, bad});
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(refused(), "no error");
  SQLite::Database raw(bad.string(), SQLite::OPEN_READWRITE);
  raw.exec("CREATE TABLE my_notes (text TEXT)");
  EXPECT_EQ(refused(), "no error") << "it does no harm";
  raw.exec("UPDATE runs SET result = substr(result, 1, 40)");
  EXPECT_EQ(refused(), bad.string() +
                           ": is damaged: row (k) of its table 'runs': put back a copy, or move it "
                           "away and run again");
  raw.exec("ALTER TABLE metrics DROP COLUMN value");
  EXPECT_TRUE(refused().starts_with(bad.string() + ": does not hold what")) << refused();
}

TEST_F(StoreFile, MergingRefusesRunsOfOtherSettings) {
  Store a(folder_ / "a.sqlite"), b(folder_ / "b.sqlite");
  a.plan(suite(), {}, {{"x", "k1"}});
  b.plan(suite(), {}, {{"x", "k2"}});
  try {
    a.merge(b.file());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("run 'x' was made with settings, input or code different"),
              std::string::npos)
        << e.what();
  }
}

TEST_F(StoreFile, ExportsALinePerRunAndPoint) {
  Store store(folder_ / "r.sqlite");
  store.plan(suite(), {}, {{"x", "kx"}});
  RunResult run = some_run("x");
  run.spec.points.push_back(run.spec.points[0]);
  run.spec.points[1].alpha = 0.5;
  run.points.push_back(run.points[0]);
  store.put("kx", run, {});
  const std::string csv = export_csv(store);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3) << csv;
  EXPECT_NE(csv.find("held_out.success"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",0.5,"), std::string::npos) << csv;
  const auto json = nlohmann::json::parse(export_json(store));
  EXPECT_EQ(json["queries"].size(), 6u);
  EXPECT_FALSE(json.contains("times"));
  EXPECT_EQ(json["queries"][0]["success"], 1);
  EXPECT_EQ(json["queries"][0]["distance_m"], 1.0 / 7.0);
  EXPECT_EQ(json["runs"][0]["trial"], 0);
  EXPECT_EQ(json["runs"][0]["name"], "x");
  EXPECT_TRUE(json["queries"][1]["distance_m"].is_null());
}

TEST_F(StoreFile, WhatAnOutsideProgramDoesNotTellIsNull) {
  Store store(folder_ / "r.sqlite");
  store.plan(suite(), {}, {{"x", "kx"}});
  RunResult run = some_run("x");
  run.spec.system = {SystemKind::kOutside, "vo", OutsideProgram()};
  QueryScore& query = run.points[0].held_out[0];
  query.answer.stage.reset();
  query.answer.matches.reset();
  run.mapping.matches.reset();
  run.mapping.calls[0].inliers.reset();
  query.answer.candidates = {};
  query.answer.candidates.final = 5;
  store.put("kx", run, {});
  EXPECT_EQ(
      store.rows("SELECT stage, c1, final, label_mass, matchers FROM queries WHERE frame = 29")
          .at(1),
      (std::vector<std::string>{"", "", "5", "", ""}));
  EXPECT_NE(export_csv(store).find(",0,,,,,,"), std::string::npos) << export_csv(store);
  EXPECT_EQ(store.rows("SELECT inliers FROM calls ORDER BY call"),
            (std::vector<std::vector<std::string>>{{"inliers"}, {""}, {"12"}}));
  EXPECT_FALSE(store.load("kx", run.spec).mapping.calls[0].inliers);
  const QueryScore back = store.load("kx", run.spec).points[0].held_out[0];
  EXPECT_EQ(back.answer.candidates, query.answer.candidates);
  const auto reported = results_json(suite(), std::vector{store.load("kx", run.spec)})["runs"][0];
  EXPECT_TRUE(reported["points"][0]["settings"].is_null());
  EXPECT_TRUE(reported["mapping"]["matchers"].is_null());
}

TEST_F(StoreFile, ADamagedResultIsNamedWithItsFile) {
  const fs::path file = folder_ / "r.sqlite";
  Store store(file);
  store.put("k", some_run("a"), {});
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec("UPDATE runs SET result = '{'");
  try {
    store.load("k", some_run("a").spec);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(file.string() + ": run 'a' is damaged"), std::string::npos)
        << e.what();
  }
}

TEST(Exact, ReadsBackTheSame) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-300, 12345678.9})
    EXPECT_EQ(std::stod(exact(value)), value);
}

}  // namespace
}  // namespace mh
