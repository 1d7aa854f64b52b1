// SPDX-License-Identifier: Apache-2.0
// Recordings as environments of suites: mapped, queried and stored like scenes.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "bench/report/results_table.hpp"
#include "bench/report/write.hpp"
#include "bench/results/rows.hpp"
#include "bench/run/one/hidden_folders.hpp"
#include "bench/run/one/run_one.hpp"
#include "bench/run/plan_runs.hpp"
#include "bench/run/run_suite.hpp"
#include "bench/store/store.hpp"
#include "bench/suite/inputs.hpp"
#include "bench/suite/run_key.hpp"
#include "bench/suite/run_spec.hpp"
#include "bench/systems/builtin.hpp"
#include "bench/systems/program_folder.hpp"
#include "scenes/recordings/frame_files.hpp"
#include "scenes/recordings/open_sequence.hpp"
#include "scenes/recordings/scannet_folder.hpp"
#include "scenes/recordings/sequence_writer.hpp"
#include "slam/core/digest.hpp"
#include "slam/core/trajectory_io.hpp"
#include "slam/files/settings_file.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"
#include "tests/slam/pipeline/box_room_slam.hpp"

namespace mh {
namespace {

namespace fs = std::filesystem;
using testing_support::box_room_frame;
using testing_support::BoxRoom;
using testing_support::kTurnFrames;
using testing_support::vocabulary;

ExactFrame exact_frame(int i) {
  ExactFrame frame{
      .seen = box_room_frame(i), .classes = {}, .instances = {}, .world_from_camera = {}};
  frame.classes = class_image(frame.seen.semantics);
  frame.instances =
      Grid2d<InstanceId>(frame.classes.width(), frame.classes.height(), InstanceId{1});
  frame.world_from_camera = BoxRoom::round_trip(i, kTurnFrames);
  return frame;
}

/// Writes frames first .. last - 1 of a turn in the box room as a recording for the bench.
void record(const fs::path& folder, const std::string& layout, int first, int last) {
  const auto writer = make_sequence_writer(layout, folder, BoxRoom::camera());
  for (int i = first; i < last; ++i)
    writer->add(static_cast<std::size_t>(i - first), exact_frame(i));
  writer->finish();
}

void write(const fs::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

/// Sixteen numbers that mark a frame without a pose.
std::string lost() {
  std::string text;
  for (int i = 0; i < 16; ++i) text += "-inf ";
  return text;
}

void expect_same(const Trajectory& a, const Trajectory& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].stamp_ns, b[i].stamp_ns);
    EXPECT_LT((a[i].world_from_camera.inverse() * b[i].world_from_camera).log().norm(), 1e-12);
  }
}

class Recorded : public testing::Test {
 protected:
  Recorded()
      : folder_(fs::temp_directory_path() /
                fmt::format("mh_recorded_{}_{}",
                            testing::UnitTest::GetInstance()->current_test_info()->name(),
                            getpid())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    spec_.name = "semantic-recorded-recorded-0";
    spec_.environment.name = spec_.environment.category = "room";
    spec_.environment.sequence = "tum:" + room().string();
    spec_.level = {.file = kRecordedLevel, .of_recordings = true};
    spec_.system = {SystemKind::kSemantic, "semantic", {}};
    spec_.labels = LabelMode::kRecorded;
    spec_.points = {SemanticConfig{}};
  }
  ~Recorded() override { fs::remove_all(folder_); }

  fs::path room() const { return folder_ / "room"; }
  World world() const {
    return build_world(spec_, 1, Cache(), [](std::string_view) {});
  }
  RunResult run() const { return run(world()); }
  RunResult run(const World& world) const { return run_one(spec_, world, tools()); }
  RunTools tools() const {
    return {.folder = folder_, .system = [](const RunSpec& spec, const World& place) {
              return make_builtin_system(place.mapping->camera(),
                                         testing_support::box_room_settings(spec.points.front()),
                                         vocabulary());
            }};
  }
  /// A suite of the run's environment, system and labels.
  Suite suite() const {
    Suite all;
    all.environments = {spec_.environment};
    all.levels = {{.file = kRecordedLevel, .of_recordings = true}};
    all.systems = {spec_.system};
    all.labels = {LabelMode::kRecorded};
    return all;
  }
  std::string key() const {
    const std::vector<InputDigest> inputs = InputReader().inputs_of(spec_);
    return run_key(spec_, inputs);
  }

  fs::path folder_;
  RunSpec spec_;
};

TEST_F(Recorded, TheReadoutTimeOfACalibrationCountsUnlessTheSuiteStatesIt) {
  record(room(), "tum", 0, 40);
  EXPECT_FALSE(world().readout_s);
  const std::string camera =
      format_settings({.camera = BoxRoom::camera(), .has_camera = true, .slam = {}, .notes = {}});
  const std::string without = "readout_s: 0\n";
  ASSERT_NE(camera.find(without), std::string::npos) << camera;
  std::string with = camera;
  with.replace(with.find(without), without.size(), "readout_s: 0.02\n");
  write(folder_ / "camera.yaml", camera);
  spec_.environment.settings = folder_ / "camera.yaml";
  EXPECT_FALSE(world().readout_s);
  const std::string before = key();
  write(folder_ / "camera.yaml", with);
  EXPECT_EQ(world().readout_s, 0.02);
  EXPECT_NE(fmt::format("{}", fmt::join(world().notes, "\n")).find("track.readout_s: 0.02"),
            std::string::npos);
  EXPECT_NE(key(), before);
  const std::string counts = key();
  spec_.environment.suite_states_readout = true;
  EXPECT_FALSE(world().readout_s);
  EXPECT_NE(key(), counts) << "another result under the same key";
  EXPECT_TRUE(run_spec_from_json(to_json(spec_)).environment.suite_states_readout);
}

TEST_F(Recorded, AFolderIsMappedAndItsHeldOutFramesAndASecondRecordingAreAskedAbout) {
  record(room(), "tum", 0, 90);
  record(folder_ / "again", "tum", 10, 75);
  spec_.environment.queries = "tum:" + (folder_ / "again").string();
  const World place = world();
  EXPECT_FALSE(place.simulated);
  const RunResult result = run(place);
  EXPECT_EQ(result.trajectory.completeness, 1.0);
  EXPECT_LT(result.trajectory.ate_rmse_m.value(), 0.02);
  EXPECT_EQ(result.mapping.skipped, SkippedFrames{});
  const PointResult& answers = result.points.front();
  ASSERT_EQ(answers.held_out.size(), 3U);
  ASSERT_EQ(answers.second_tour.size(), 2U);
  for (const QuerySet set : kQuerySets)
    for (const QueryScore& q : queries(answers, set)) {
      EXPECT_TRUE(q.correct) << name(set) << q.answer.index;
      EXPECT_LT(q.distance_m.value(), 0.05);
      EXPECT_GT(q.answer.candidates.label_mass.value_or(0), 0.01) << "its labels are not seen";
    }
  EXPECT_TRUE(result.volume);
  EXPECT_EQ(result.grid.cells.size(), 0U) << "nobody knows where the floor is";
  EXPECT_EQ(result.place.scene, "room");
  EXPECT_EQ(result.place.mapping.frames, 90U);
  EXPECT_GT(result.place.mapping.length_m, 0.1);

  const fs::path out = folder_ / "run";
  write_run(out, place, result, "k1");
  for (const char* file : {"truth.tum", "estimate.tum", "map.bt"})
    EXPECT_TRUE(fs::exists(out / file)) << file;
  for (const char* file : {"topdown.png", "map.pgm"}) EXPECT_FALSE(fs::exists(out / file)) << file;
  EXPECT_FALSE(shows_another_run(out, "k1"));
  EXPECT_TRUE(shows_another_run(out, "k2"));
  remove_run(out);
  EXPECT_TRUE(fs::is_empty(out));
}

TEST_F(Recorded, WithoutLabelsItsFramesHaveNoneAndTheRunIsTheSameButForThem) {
  record(room(), "tum", 0, 40);
  spec_.labels = LabelMode::kNone;
  EXPECT_TRUE(world().mapping->frame(0, RandomStream()).semantics.index.empty());
  const auto without = key();
  spec_.labels = LabelMode::kRecorded;
  EXPECT_FALSE(world().mapping->frame(0, RandomStream()).semantics.index.empty());
  EXPECT_NE(key(), without);
}

TEST_F(Recorded, WithoutATruthAnswersAreSuccessesAndNothingElseIsSaid) {
  record(room(), "tum", 0, 65);
  fs::remove(room() / "groundtruth.txt");
  RunResult result = run();
  EXPECT_EQ(result.trajectory.completeness, 1.0);
  EXPECT_FALSE(result.trajectory.ate_rmse_m || result.trajectory.ate_first_pose_m);
  const QuerySummary s = summarize(result.points.front().held_out);
  EXPECT_EQ(s.queries, 2);
  EXPECT_EQ(s.success, 1);
  EXPECT_FALSE(s.correct || s.false_positive || s.distance_mean_m);

  Store store(folder_ / "results.sqlite");
  store.put("key", result, {});
  const RunResult loaded = store.load("key", spec_);
  EXPECT_TRUE(loaded.truth.empty());
  expect_same(loaded.estimate, result.estimate);
  EXPECT_FALSE(summarize(loaded.points.front().held_out).correct);
  EXPECT_TRUE(std::isnan(loaded.place.mapping.length_m));

  // The paper's method needs no ground truth: the query's reference pose is interpolated between
  // the estimates before and after it.
  spec_.protocol.truth = QueryTruth::kInterpolated;
  EXPECT_EQ(summarize(run().points.front().held_out).correct, 1.0);
}

// A tracking system reports ground truth at its own rate; it is stored as reported.
TEST_F(Recorded, ATruthOfOtherMomentsIsAskedBetweenThem) {
  record(room(), "tum", 0, 60);
  Trajectory truth;
  for (int i = 0; i < 60 * 4; ++i) {
    const double at = 0.25 * i + 0.1;
    const int before = static_cast<int>(at);
    const SE3 a = BoxRoom::round_trip(before, kTurnFrames),
              b = BoxRoom::round_trip(before + 1, kTurnFrames);
    const double share = at - before;
    truth.push_back({static_cast<Stamp>(at * testing_support::kFrame_ns),
                     SE3(a.quaternion().slerp(share, b.quaternion()),
                         (1 - share) * a.translation() + share * b.translation())});
  }
  write_tum(room() / "groundtruth.txt", truth);
  const RunResult result = run();
  EXPECT_LT(result.trajectory.ate_rmse_m.value(), 0.02);
  ASSERT_EQ(result.points.front().held_out.size(), 2U);
  for (const QueryScore& q : result.points.front().held_out) {
    EXPECT_TRUE(q.correct);
    const SE3 really = BoxRoom::round_trip(static_cast<int>(q.answer.index), kTurnFrames);
    EXPECT_LT((q.true_world_from_camera->inverse() * really).log().norm(), 1e-3);
  }
  Store store(folder_ / "results.sqlite");
  store.put("key", result, {});
  const RunResult loaded = store.load("key", spec_);
  expect_same(loaded.truth, result.truth);
  expect_same(loaded.estimate, result.estimate);
}

TEST_F(Recorded, FramesThatCannotBeUsedAreSkippedAndCounted) {
  record(room(), "tum", 0, 70);
  const std::vector<RecordedFrame> files = load_tum_folder(room());
  write(files[10].color, "no image");
  fs::remove(files[12].depth);
  write(files[29].color, "no image");  // a test frame
  // From frame 60 on, images of a different size; then a timestamp that repeats and one that goes
  // back.
  Camera small = BoxRoom::camera();
  small.width_px /= 2;
  TumWriter other(folder_ / "small", small);
  for (int i = 60; i < 65; ++i)
    other.add({files[static_cast<std::size_t>(i)].stamp_ns,
               Grid2d<Rgb8>(small.width_px, small.height_px),
               Grid2d<float>(small.width_px, small.height_px, 1.0F),
               {}});
  other.finish();
  for (std::size_t i = 60; i < 65; ++i)
    fs::copy_file(folder_ / "small" / "rgb" / files[i].color.filename(), files[i].color,
                  fs::copy_options::overwrite_existing);
  std::string list = read_file(room() / "rgb.txt");
  const std::size_t line = list.find('\n') + 1;
  list += list.substr(line, list.find('\n', line) + 1 - line);  // the first frame once more
  write(room() / "rgb.txt", list);

  const RunResult result = run();
  EXPECT_EQ(result.mapping.skipped.count, 9U);
  EXPECT_EQ(result.mapping.skipped.reasons.size(), SkippedFrames::kReasonsKept);
  // The recording's location is not part of a result.
  EXPECT_TRUE(result.mapping.skipped.reasons[0].starts_with(
      "rgb/" + files[10].color.filename().string() + ": "))
      << result.mapping.skipped.reasons[0];
  EXPECT_EQ(result.points.front().held_out.size(), 1U);  // frame 59
  EXPECT_EQ(result.trajectory.tracked, 61U);
  Store store(folder_ / "results.sqlite");
  store.put("key", result, {});
  EXPECT_EQ(store.load("key", spec_).mapping.skipped, result.mapping.skipped);
  const std::string table = results_table(suite(), std::span(&result, 1));
  EXPECT_NE(table.find("room: 9 frames skipped, the first: "), std::string::npos) << table;
  EXPECT_NE(table.find("differ only in RANSAC's draws"), std::string::npos);
}

TEST_F(Recorded, AFrameShownTwiceIsNotAskedAboutAsIfItWereNew) {
  record(room(), "tum", 0, 60);
  std::istringstream lines(read_file(room() / "rgb.txt"));
  std::string doubled;
  int frame = 0;
  for (std::string line; std::getline(lines, line);) {
    doubled += line + "\n";
    if (line[0] != '#' && ++frame == 29) doubled += line + "\n";  // index 29 is a copy of 28
  }
  write(room() / "rgb.txt", doubled);
  const RunResult result = run();
  EXPECT_EQ(result.mapping.skipped.count, 1U);
  ASSERT_EQ(result.points.front().held_out.size(), 1U);  // 29 was skipped, 59 is left
  EXPECT_EQ(result.points.front().held_out[0].answer.index, 59U);
}

TEST_F(Recorded, AClockThatIsWrongAtFirstCostsOnlyThoseFrames) {
  record(room(), "tum", 0, 60);
  fs::remove(room() / "label.txt");
  for (const char* list : {"rgb.txt", "depth.txt"}) {
    std::istringstream lines(read_file(room() / list));
    std::string late;
    int frame = 0;
    for (std::string line; std::getline(lines, line);)
      late += (line[0] != '#' && frame++ < 12 ? "9" : "") + line + "\n";
    write(room() / list, late);
  }
  spec_.labels = LabelMode::kNone;
  const RunResult result = run();
  EXPECT_EQ(result.mapping.skipped.count, 12U);
  EXPECT_EQ(result.trajectory.tracked, 46U);  // of 48, two of which are held out
}

TEST_F(Recorded, WhatARecordingLacksIsPartOfItsResults) {
  record(room(), "scannet-frames", 0, 60);
  for (int i = 50; i < 60; ++i) {
    fs::remove(room() / "color" / fmt::format("{}.jpg", i));
    fs::remove(room() / "depth" / fmt::format("{}.png", i));
  }
  spec_.environment.sequence = "scannet:" + room().string();
  const RunResult result = run();
  const std::string note = "pose: 10 of 60 poses belong to no image (the first is 50)";
  EXPECT_TRUE(std::ranges::find(result.place.notes, note) != result.place.notes.end());
  const std::string table = results_table(suite(), std::span(&result, 1));
  EXPECT_NE(table.find("  room: " + note + "\n"), std::string::npos) << table;
}

// Only systems that see labels lose the frame. Queries are paired by frame, not by position in the
// list.
TEST_F(Recorded, AFrameWithADamagedLabelImageIsSkippedForTheSystemsThatSeeIt) {
  record(room(), "tum", 0, 125);
  write(load_tum_folder(room())[29].classes, "no image");  // the first test frame
  Suite both = suite();
  both.systems.push_back({SystemKind::kPlain, "plain", {}});
  both.compare = {{0, 1}};
  std::vector<RunResult> results;
  for (const RunSpec& spec : expand(both)) {
    spec_ = spec;
    results.push_back(run());
  }
  ASSERT_EQ(results.size(), 2U);
  ASSERT_EQ(results[0].points.front().held_out.size(), 3U);
  ASSERT_EQ(results[1].points.front().held_out.size(), 4U);

  const std::string table = results_table(both, results);
  EXPECT_NE(table.find("4 queries"), std::string::npos) << table;
  EXPECT_NE(table.find("3 of them"), std::string::npos) << table;
  EXPECT_NE(table.find("room, semantic (recorded labels): 1 frame skipped"), std::string::npos)
      << table;
  EXPECT_EQ(table.find("room, plain"), std::string::npos) << table;

  QueryScore& other = results[0].points.front().held_out[0];  // frame 59
  other.success = other.correct = false;
  const std::vector<Row> rows = make_rows(both, results);
  ASSERT_EQ(rows.size(), 2U);
  const std::vector<PairedDifference> pairs = paired_success(rows[0], rows[1], QuerySet::kHeldOut);
  ASSERT_EQ(pairs.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(pairs[i].present);
    EXPECT_EQ(pairs[i].difference, i == 0 ? -1 : 0);
  }
}

TEST_F(Recorded, ItsInertialReadingsAreGivenIfTheSuiteAsks) {
  record(room(), "tum", 0, 3);
  spec_.senses = {Sense::kImu};
  try {
    world();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("has no inertial sensor"), std::string::npos)
        << error.what();
  }
  write(room() / "imu.csv", "10,0,0,0,0,-9.8,0\n20,0,0,0,0,-9.8,0\n");
  EXPECT_EQ(world().mapping->imu().size(), 2U);
  spec_.senses = {};
  EXPECT_TRUE(world().mapping->imu().empty());
}

TEST_F(Recorded, HalfATruthIsSaid) {
  record(room(), "tum", 0, 60);
  Trajectory truth = read_trajectory(room() / "groundtruth.txt");
  truth.resize(25);
  write_tum(room() / "groundtruth.txt", truth);
  const RunResult result = run();
  EXPECT_EQ(result.trajectory.tracked, 58);
  EXPECT_EQ(result.trajectory.scored, 25);
  EXPECT_EQ(result.place.mapping.true_poses, 25U);
  const std::string table = results_table(suite(), std::span(&result, 1));
  EXPECT_NE(table.find("room: 25 of 60 frames have a true pose; the others are not scored"),
            std::string::npos)
      << table;
}

TEST_F(Recorded, QueriesInAnotherFrameOfReferenceAreAskedFor) {
  record(room(), "tum", 0, 90);
  record(folder_ / "again", "tum", 0, 100);
  Trajectory moved = read_trajectory(folder_ / "again" / "groundtruth.txt");
  for (TimedPose& pose : moved)
    pose.world_from_camera = SE3(Eigen::Matrix3d::Identity(), {5, 0, 0}) * pose.world_from_camera;
  write_tum(folder_ / "again" / "groundtruth.txt", moved);
  spec_.environment.queries = "tum:" + (folder_ / "again").string();
  spec_.system = {SystemKind::kPlain, "plain", {}};
  const Suite plain = suite();
  spec_ = expand(plain).front();
  const RunResult result = run();
  const std::string table = results_table(plain, std::span(&result, 1));
  EXPECT_NE(table.find("warning: room: all 3 answers to `queries` are wrong, by 5.0"),
            std::string::npos)
      << table;
  const std::size_t second = table.find("second tour");
  ASSERT_NE(second, std::string::npos) << table;
  EXPECT_EQ(table.find("saturated", second), std::string::npos)
      << "nothing is left to gain, though all is wrong: " << table;
  std::vector<RunResult> of_two(2, result);
  of_two[1].spec.environment.name = "other";
  Suite two = plain;
  two.environments.push_back(of_two[1].spec.environment);
  const std::string means = results_table(two, of_two);
  EXPECT_NE(means.find("2nd tour: success"), std::string::npos) << means;
  EXPECT_EQ(means.find("saturated"), std::string::npos) << means;
}

TEST_F(Recorded, ARecordingOfWhichNothingCanBeReadIsOneError) {
  record(room(), "tum", 0, 15);
  for (const RecordedFrame& frame : load_tum_folder(room())) write(frame.depth, "no image");
  try {
    run();
    FAIL() << "mapped";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("depth"), std::string::npos) << error.what();
  }
  EXPECT_THROW(require_usable_frames(*world().mapping), InputError);
}

TEST_F(Recorded, WhatCannotBeRunIsToldBeforeAnythingIsWritten) {
  record(room(), "tum", 0, 12);
  Suite suite;
  suite.environments = {spec_.environment};
  suite.levels = {{.file = kRecordedLevel, .of_recordings = true}};
  suite.systems = {{SystemKind::kSemantic, "semantic", {}}};
  suite.labels = {LabelMode::kRecorded};
  std::vector<std::string> said;
  const auto error = [&] {
    try {
      run_suite(suite, {},
                {.out = folder_, .shard = {}, .cache = {}, .say = [&](std::string_view line) {
                   said.emplace_back(line);
                 }});
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto expect_told = [&](const std::string& part) {
    const std::string message = error();
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_FALSE(fs::exists(folder_ / "results.sqlite"));
  };
  Camera other = BoxRoom::camera();
  other.fx_px += 1;
  TumWriter writer(folder_ / "other", other);
  for (int i = 0; i < 3; ++i) writer.add(static_cast<std::size_t>(i), exact_frame(20 + i));
  writer.finish();
  suite.environments[0].queries = "tum:" + (folder_ / "other").string();
  expect_told("was recorded with a different camera from");
  suite.environments[0].queries.reset();
  fs::remove(room() / "label.txt");
  expect_told("holds no labels");
  suite.labels = {LabelMode::kNone};
  // A settings file contributes only the calibration.
  std::string settings = read_file(room() / "camera.yaml");
  settings.replace(settings.find("nFeatures: 1000"), 15, "nFeatures: 1700");
  write(folder_ / "settings.yaml", settings);
  suite.environments[0].settings = folder_ / "settings.yaml";
  for (const RecordedFrame& frame : load_tum_folder(room())) write(frame.color, "no image");
  expect_told("rgb");
  const auto is_warned = [&] {
    return std::ranges::any_of(said, [](const std::string& line) {
      return line.find("under `slam:`): features.count: 1700") != std::string::npos;
    });
  };
  EXPECT_TRUE(is_warned());
  said.clear();
  SlamConfig meant;
  meant.features.count = 1700;
  suite.slam = meant;
  expect_told("rgb");
  EXPECT_FALSE(is_warned());
}

TEST_F(Recorded, ScanNetsFramesWithoutAPoseAreMappedAndNotScored) {
  record(room(), "scannet-frames", 0, 90);
  spec_.environment.sequence = "scannet:" + room().string();
  for (const int invalid : {40, 41, 59})
    write(room() / "pose" / fmt::format("{}.txt", invalid), lost());
  const RunResult result = run();
  EXPECT_EQ(result.trajectory.completeness, 1.0);
  EXPECT_LT(result.trajectory.ate_rmse_m.value(), 0.03);
  ASSERT_EQ(result.points.front().held_out.size(), 2U);  // 29 and 89
  EXPECT_EQ(result.points.front().held_out[1].answer.index, 89U);
  EXPECT_TRUE(result.points.front().held_out[1].correct);
  EXPECT_GT(result.points.front().held_out[0].answer.candidates.label_mass.value_or(0), 0.01);

  for (int i = 0; i < 90; ++i) write(room() / "pose" / fmt::format("{}.txt", i), lost());
  const RunResult unknown = run();
  EXPECT_FALSE(unknown.trajectory.ate_rmse_m);
  EXPECT_EQ(unknown.points.front().held_out.size(), 3U);
  EXPECT_FALSE(summarize(unknown.points.front().held_out).correct);
}

TEST_F(Recorded, ACutRecordingSaysSo) {
  record(room(), "tum", 0, 60);
  spec_.max_frames = 40;
  const World place = world();
  EXPECT_TRUE(place.cut);
  EXPECT_EQ(place.mapping->size(), 40U);
  EXPECT_EQ(place.mapping->truth()->size(), 43U) << "what is true 0.1 s around its frames";
  spec_.max_frames = 60;
  EXPECT_FALSE(world().cut);
}

// ---- keys ------------------------------------------------------------------------------------

/// Changes single bytes of each file below a folder: the key must change, or reading must fail.
/// Files for which `counts` is false must not change the key.
void expect_all_count(const fs::path& folder, const std::function<std::string()>& key,
                      const std::function<bool(const fs::path&)>& counts) {
  const std::string before = key();
  EXPECT_EQ(key(), before);
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string content = read_file(entry.path());
    for (const std::size_t at : {std::size_t{0}, content.size() / 2, content.size() - 1}) {
      std::string changed = content;
      changed[at] = static_cast<char>(changed[at] ^ 1);
      write(entry.path(), changed);
      std::string now;
      try {
        now = key();
      } catch (const InputError& error) {
        now = error.what();
      }
      EXPECT_EQ(now != before, counts(entry.path())) << entry.path() << ", byte " << at;
    }
    write(entry.path(), content);
  }
  EXPECT_EQ(key(), before);
}

TEST_F(Recorded, TheKeyOfARunHoldsEveryByteOfATumFolder) {
  record(room(), "tum", 0, 2);
  write(folder_ / "classes.yaml", "1: chair\n2: table\n");
  spec_.environment.classes = folder_ / "classes.yaml";
  expect_all_count(
      folder_, [&] { return key(); },
      [&](const fs::path& file) {
        const std::string name = file.lexically_relative(room()).string();
        return !name.starts_with("instance") && name != "associations.txt" &&
               name != "camera_info.yaml" && name != "checksums.txt" &&
               file.filename() != ".modelhouse";
      });
  // The key is made from exactly the inputs that a run is built from.
  EXPECT_EQ(run_key(spec_, world().inputs), key());
  // The recording's location is not part of the key.
  const std::string before = key();
  fs::create_directories(folder_ / "elsewhere");
  fs::rename(room(), folder_ / "elsewhere" / "room");
  spec_.environment.sequence = "tum:" + (folder_ / "elsewhere" / "room").string();
  EXPECT_EQ(key(), before);
}

TEST_F(Recorded, AFileThatChangesUnderARunLeavesNeitherAMapNorAResult) {
  record(room(), "tum", 0, 40);
  const auto image = [&](int i) {
    auto files = std::vector<fs::path>(fs::directory_iterator(room() / "rgb"), {});
    std::ranges::sort(files);
    return files.at(static_cast<std::size_t>(i));
  };
  const World place = world();
  const fs::path maps = folder_ / "maps";
  RunTools watched = tools();
  watched.maps = Cache(maps);
  const std::string first = read_file(image(0));
  watched.status = [&](std::string_view status) {
    if (status.starts_with("frame 20 ")) write(image(30), first);
  };
  EXPECT_THROW(run_one(spec_, place, watched), InputChanged);
  bool made = false;
  Cache(maps).get("map", map_key(spec_, place.inputs), [&] {
    made = true;
    return std::string();
  });
  EXPECT_TRUE(made) << "a map of these images was kept";
}

TEST_F(Recorded, WhatItsLinksLeadToIsHiddenFromAProgramAndSoAreOtherRunsFolders) {
  record(folder_ / "kept", "tum", 0, 4);
  fs::remove(folder_ / "kept" / ".modelhouse");  // no marker shows that it is a recording
  fs::create_directories(room());
  for (const auto& entry : fs::directory_iterator(folder_ / "kept"))
    fs::create_symlink(entry.path(), room() / entry.path().filename());
  spec_.system = {.kind = SystemKind::kPlain,
                  .name = "p",
                  .outside = OutsideProgram{.name = "p", .command = "true", .folder = folder_}};
  const fs::path other = ProgramFolder::place() / fmt::format(".work.mh_test.{}x.0", getpid());
  fs::create_directories(other);
  const std::vector<fs::path> hidden = program_of(spec_, world(), {}).hidden;
  fs::remove(other);
  const auto holds = [&](const fs::path& path) {
    return std::ranges::find(hidden, path) != hidden.end();
  };
  EXPECT_TRUE(holds(fs::canonical(folder_ / "kept" / "groundtruth.txt")));
  EXPECT_TRUE(holds(room()));
  EXPECT_TRUE(holds(other));
}

TEST_F(Recorded, AnImageThatAppearsUnderARunLeavesNeitherAMapNorAResult) {
  record(room(), "tum", 0, 40);
  auto files = std::vector<fs::path>(fs::directory_iterator(room() / "rgb"), {});
  std::ranges::sort(files);
  const std::string late = read_file(files.at(30));
  fs::remove(files.at(30));
  const World place = world();
  RunTools watched = tools();
  RunTools plain = tools();
  watched.status = [&](std::string_view status) {
    if (status.starts_with("frame 20 ")) write(files.at(30), late);
  };
  EXPECT_THROW(run_one(spec_, place, watched), InputChanged);
  fs::remove(files.at(30));
  EXPECT_NO_THROW(run_one(spec_, place, plain));
}

// Other images temporarily replace the folder's images, and some frames are read from them.
TEST_F(Recorded, AFolderThatIsAnotherForAMomentLeavesNoResult) {
  record(room(), "tum", 0, 40);
  const fs::path other = folder_ / "other";
  fs::copy(room() / "rgb", other);
  auto files = std::vector<fs::path>(fs::directory_iterator(other), {});
  std::ranges::sort(files);
  for (std::size_t i = 1; i < files.size(); ++i) write(files[i], read_file(files[0]));
  const auto exchange = [&] {
    fs::rename(room() / "rgb", folder_ / "aside");
    fs::rename(other, room() / "rgb");
    fs::rename(folder_ / "aside", other);
  };
  const World place = world();
  for (const std::string during : {"frame 20 ", "queries"}) {
    RunTools watched = tools();
    RunTools plain = tools();
    bool is_other = false;
    watched.status = [&](std::string_view status) {
      if (status.starts_with(during) != is_other) {
        exchange();
        is_other = !is_other;
      }
    };
    std::string what = "no error";
    try {
      run_one(spec_, place, watched);
    } catch (const InputChanged& error) {
      what = error.what();
    }
    EXPECT_NE(what.find("was changed while it was in use"), std::string::npos) << what;
    if (is_other) exchange();
    EXPECT_NO_THROW(run_one(spec_, place, plain)) << during;
  }
}

// The key of a run covers everything that exists in the recording beforehand, not only what the run
// reads: it is the same without labels.
TEST_F(Recorded, TheKeyIsTheSameWhetherLabelsAreLeftOutOrNot) {
  write(folder_ / "classes.yaml", "1: chair\n");
  spec_.environment.classes = folder_ / "classes.yaml";
  for (const char* layout : {"tum", "scannet-frames"}) {
    const fs::path folder = folder_ / layout;
    record(folder, layout, 0, 2);
    spec_.environment.sequence = folder.string();
    for (const LabelMode labels : {LabelMode::kRecorded, LabelMode::kNone}) {
      spec_.labels = labels;
      EXPECT_EQ(run_key(spec_, world().inputs), key()) << layout << " " << name(labels);
    }
  }
}

TEST_F(Recorded, ACopyUnderAnotherNameIsRefused) {
  record(room(), "tum", 0, 2);
  fs::copy(room(), folder_ / "copy", fs::copy_options::recursive);
  Suite two = suite();
  two.environments.push_back(spec_.environment);
  two.environments[1].name = "copy";
  two.environments[1].sequence = "tum:" + (folder_ / "copy").string();
  InputReader reader;
  const auto plan = [&] { return plan_runs(two, reader, [](std::string_view) {}); };
  const auto expect_refused = [&](const std::string& why) {
    reader = InputReader();
    try {
      plan();
      ADD_FAILURE() << "one recording would count twice";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  expect_refused("'room' and 'copy' are equal in every byte");
  // A copy with different words in its lists or different file names is not a different place,
  // either.
  const fs::path list = folder_ / "copy" / "rgb.txt";
  write(list, read_file(list) + "# another\n");
  fs::rename(folder_ / "copy" / "rgb", folder_ / "copy" / "images");
  write(list, std::regex_replace(read_file(list), std::regex("rgb/"), "images/"));
  expect_refused("'room' and 'copy' have the same images");
  // A recording must not be queried with its own frames.
  Suite own = suite();
  own.environments[0].queries = two.environments[1].sequence;
  EXPECT_THROW(plan_runs(own, reader, [](std::string_view) {}), InputError);
  fs::remove(folder_ / "copy" / "label.txt");  // a run need not see the labels
  reader = InputReader();
  EXPECT_THROW(plan_runs(own, reader, [](std::string_view) {}), InputError);
  fs::remove_all(folder_ / "copy");
  record(folder_ / "copy", "tum", 2, 4);
  reader = InputReader();
  EXPECT_EQ(plan().size(), 2U);
}

TEST_F(Recorded, ACachedMapSaysTheSameOfACopy) {
  record(room(), "tum", 0, 40);
  write(load_tum_folder(room())[10].color, "no image");
  fs::copy(room(), folder_ / "copy", fs::copy_options::recursive);
  RunTools cached = tools();
  cached.maps = Cache(folder_ / "maps");
  const SkippedFrames first = run_one(spec_, world(), cached).mapping.skipped;
  fs::remove_all(room());
  spec_.environment.sequence = "tum:" + (folder_ / "copy").string();
  EXPECT_EQ(run_one(spec_, world(), cached).mapping.skipped, first);
  EXPECT_EQ(run().mapping.skipped, first);
}

TEST_F(Recorded, ANameThatNoFolderCanHaveIsRefusedBeforeAnythingRuns) {
  record(room(), "tum", 0, 2);
  Suite long_name = suite();
  long_name.systems[0].name = std::string(300, 'x');
  InputReader reader;
  try {
    plan_runs(long_name, reader, [](std::string_view) {});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("characters, at most 200"), std::string::npos)
        << error.what();
  }
}

// A folder that fits two layouts is two recordings, no matter which one is read first.
TEST_F(Recorded, OneFolderReadAsTwoLayoutsIsTwoRecordings) {
  record(room(), "tum", 0, 2);
  std::ofstream(room() / "x.gt.freiburg") << "0 0 0 0 0 0 0 1\n";
  InputReader reader;
  const auto key_as = [&](const std::string& layout) {
    spec_.environment.sequence = layout + room().string();
    return run_key(spec_, reader.inputs_of(spec_));
  };
  const std::string as_tum = key_as("tum:"), as_icl = key_as("icl_nuim:");
  EXPECT_NE(as_tum, as_icl);
  reader = InputReader();
  EXPECT_EQ(key_as("icl_nuim:"), as_icl);
  EXPECT_EQ(key_as("tum:"), as_tum);
}

TEST_F(Recorded, TheKeyOfARunHoldsEveryByteOfAScanNetRecording) {
  record(room(), "scannet-frames", 0, 2);
  spec_.environment.sequence = "scannet:" + room().string();
  expect_all_count(
      room(), [&] { return key(); },
      [&](const fs::path& file) {
        const std::string name = file.lexically_relative(room()).string();
        return !name.starts_with("instance-filt") && name != "_info.txt" && name != "checksums.txt";
      });
  EXPECT_EQ(run_key(spec_, world().inputs), key());

  write_scannet_recording(folder_ / "sens", BoxRoom::camera(), 2,
                          [](std::size_t i) { return exact_frame(static_cast<int>(i)); });
  spec_.environment.sequence = "scannet:" + (folder_ / "sens").string();
  expect_all_count(
      folder_ / "sens", [&] { return key(); },
      [&](const fs::path& file) {
        return file.filename().string().find("instance-filt") == std::string::npos;
      });
}

}  // namespace
}  // namespace mh
