// SPDX-License-Identifier: Apache-2.0
// What `verify` compares, field by field, in made-up results (tests/bench/run/run_test.cpp covers
// differences between whole runs).
#include "bench/run/verify.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "bench/protocol/system_report.hpp"
#include "bench/run/execute_run.hpp"
#include "bench/suite/suite.hpp"
#include "slam/core/digest.hpp"
#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "slam/io/temporary_folder.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

/// A run with two mapped frames, the second after a restart, and two queries of each set under each
/// of two points.
RunResult some_run() {
  RunResult run;
  run.spec.name = "run";
  run.spec.points.resize(2);
  run.mapping.calls = {{.index = 3, .stamp_ns = 30, .inliers = {}},
                       {.index = 4, .stamp_ns = 40, .restart = 2, .inliers = {}}};
  run.estimate = {{30, SE3()}, {40, SE3()}};
  QueryScore first, second;
  first.answer.index = 29;
  second.answer.index = 59;
  run.points.assign(2, {{first, second}, {first, second}});
  run.episodes = {{.variant = "moved", .start = 7}};
  return run;
}

std::string reported(const std::function<void(RunResult&)>& change) {
  RunResult changed = some_run();
  change(changed);
  const auto difference = first_difference(some_run(), changed);
  return difference ? describe(*difference) : "none";
}

TEST(FirstDifference, NamesWhateverDiffers) {
  EXPECT_EQ(reported([](RunResult&) {}), "none");
  EXPECT_EQ(reported([](RunResult& r) { r.place.scene_digest = 1; }), "run: world: scene differs");
  EXPECT_EQ(reported([](RunResult& r) { r.place.path_digest = 1; }), "run: world: path differs");
  EXPECT_EQ(reported([](RunResult& r) { r.episodes[0].digest = 1; }),
            "run: episodes: moved, start 7 differs");
  EXPECT_EQ(reported([](RunResult& r) { r.episodes.clear(); }), "run: episodes: number differs");
  const auto call = [](auto field, auto value) {
    return reported([=](RunResult& r) { r.mapping.calls[1].*field = value; });
  };
  const std::string at = "run: mapping: frame 4 (after 2 restarts): ";
  EXPECT_EQ(call(&MappedFrame::index, 5u), at + "order differs");
  EXPECT_EQ(call(&MappedFrame::image_digest, 1u), at + "image differs");
  EXPECT_EQ(call(&MappedFrame::matching_digest, 1u), at + "matching differs");
  EXPECT_EQ(call(&MappedFrame::pose_digest, 1u), at + "pose differs");
  EXPECT_EQ(reported([](RunResult& r) { r.mapping.calls.pop_back(); }),
            "run: mapping: frame 1: order differs");
  EXPECT_EQ(reported([](RunResult& r) {
              r.estimate[1].world_from_camera = SE3(Eigen::Matrix3d::Identity(), {0, 0, 1e-300});
            }),
            "run: result: frame 4: map differs");
  EXPECT_EQ(reported([](RunResult& r) { r.map_digest = 1; }), "run: result: frame 0: map differs");
}

TEST(FirstDifference, NamesWhateverDiffersInAQuery) {
  const auto query = [](std::size_t point, auto set, auto field, auto value) {
    return reported([=](RunResult& r) { (r.points[point].*set)[1].answer.*field = value; });
  };
  for (const std::size_t point : {0u, 1u})
    for (const auto& [set, of] : {std::pair(&PointResult::held_out, "run: held_out: frame 59: "),
                                  {&PointResult::second_tour, "run: second_tour: frame 59: "}}) {
      const std::string at = of;
      EXPECT_EQ(query(point, set, &QueryAnswer::index, 60u), at + "order differs");
      EXPECT_EQ(query(point, set, &QueryAnswer::image_digest, 1u), at + "image differs");
      EXPECT_EQ(query(point, set, &QueryAnswer::matching_digest, 1u), at + "matching differs");
      EXPECT_EQ(query(point, set, &QueryAnswer::pose_digest, 1u), at + "pose differs");
    }
  EXPECT_EQ(reported([](RunResult& r) { r.points[1].held_out.pop_back(); }),
            "run: held_out: frame 0: order differs");
}

// A cause is reported before its consequences.
TEST(FirstDifference, IsTheFirstInTheOrderInWhichThingsHappen) {
  const auto later = [](RunResult& r) {
    r.map_digest = 1;
    r.points[0].held_out[0].answer.image_digest = 1;
    r.estimate[0].stamp_ns = 31;
    r.mapping.calls[1].image_digest = r.mapping.calls[1].matching_digest = 1;
    r.mapping.calls[1].pose_digest = 1;
  };
  EXPECT_EQ(reported(later), "run: mapping: frame 4 (after 2 restarts): image differs");
  EXPECT_EQ(reported([&](RunResult& r) {
              later(r);
              r.mapping.calls[0].pose_digest = 1;
            }),
            "run: mapping: frame 3: pose differs");
}

TEST(Digests, EachSeesItsOwnAndNoOther) {
  const Suite suite;
  const auto of = [&](const std::function<void(RunResult&)>& change) {
    RunResult run = some_run();
    change(run);
    return digests(suite, std::vector{run});
  };
  const ExecutionDigests same = of([](RunResult&) {});
  const auto changes = [&](std::uint64_t ExecutionDigests::*digest,
                           const std::function<void(RunResult&)>& change) {
    const ExecutionDigests other = of(change);
    EXPECT_NE(other.*digest, same.*digest);
    for (const auto field :
         {&ExecutionDigests::scene, &ExecutionDigests::path, &ExecutionDigests::images,
          &ExecutionDigests::matching, &ExecutionDigests::poses, &ExecutionDigests::maps})
      if (field != digest) {
        EXPECT_EQ(other.*field, same.*field);
      }
  };
  using D = ExecutionDigests;
  changes(&D::scene, [](RunResult& r) { r.place.scene_digest = 1; });
  changes(&D::path, [](RunResult& r) { r.place.path_digest = 1; });
  changes(&D::maps, [](RunResult& r) { r.map_digest = 1; });
  changes(&D::images, [](RunResult& r) { r.mapping.calls[0].image_digest = 1; });
  changes(&D::matching, [](RunResult& r) { r.mapping.calls[0].matching_digest = 1; });
  changes(&D::poses, [](RunResult& r) { r.mapping.calls[0].pose_digest = 1; });
  for (const auto set : {&PointResult::held_out, &PointResult::second_tour}) {
    changes(&D::images, [=](RunResult& r) { (r.points[1].*set)[1].answer.image_digest = 1; });
    changes(&D::matching, [=](RunResult& r) { (r.points[1].*set)[1].answer.matching_digest = 1; });
    changes(&D::poses, [=](RunResult& r) { (r.points[1].*set)[1].answer.pose_digest = 1; });
  }
}

TEST(DigestOfMatching, SeesAllThatAStepSaidOfItButThePose) {
  SystemReport report;
  report.candidates = {
      .keyframes = 0, .c1 = 0, .c2 = 0, .c3 = 0, .final = 0, .label_mass = 0, .gamma = {}};
  report.matches.emplace();
  std::set<std::uint64_t> seen = {digest_of_matching(report)};
  std::size_t changes = 1;
  const auto change = [&](const std::function<void(SystemReport&)>& with) {
    SystemReport changed = report;
    with(changed);
    seen.insert(digest_of_matching(changed));
    EXPECT_EQ(seen.size(), ++changes) << "change " << changes;
  };
  change([](SystemReport& r) { r.status = TrackStatus::kTracked; });
  change([](SystemReport& r) { r.keypoints = 1; });
  change([](SystemReport& r) { r.inliers = 1; });
  change([](SystemReport& r) { r.keyframe_added = true; });
  change([](SystemReport& r) { r.relocalization = RelocalizationStage::kPnp; });
  for (std::size_t m = 0; m < report.matches->size(); ++m)
    for (const auto count : {&MatcherCounts::compared, &MatcherCounts::penalized,
                             &MatcherCounts::rejected_by_xi, &MatcherCounts::ratio_helped})
      change([=](SystemReport& r) { (*r.matches)[m].*count = 1; });
  for (const auto count : {&Candidates::keyframes, &Candidates::c1, &Candidates::c2,
                           &Candidates::c3, &Candidates::final})
    change([=](SystemReport& r) { r.candidates.*count = 1; });
  change([](SystemReport& r) { r.candidates.label_mass = 0.5; });
  change([](SystemReport& r) { r.candidates = {}; });
  report.world_from_camera = SE3();
  EXPECT_TRUE(seen.contains(digest_of_matching(report))) << "the pose has a digest of its own";
}

TEST(DigestOfAFrame, SeesEveryPixelLabelAndItsStamp) {
  RgbdFrame frame;
  frame.stamp_ns = 5;
  frame.color = Grid2d<Rgb8>(4, 3);
  frame.depth_m = Grid2d<float>(4, 3);
  frame.semantics.index = decltype(frame.semantics.index)(4, 3);
  frame.semantics.palette.resize(2);
  frame.semantics.palette[1].entries = {{ClassId{3}, 0.5F}};
  std::set<std::uint64_t> seen = {digest(frame)};
  std::size_t changes = 1;
  const auto change = [&](const std::function<void(RgbdFrame&)>& with) {
    RgbdFrame changed = frame;
    with(changed);
    seen.insert(digest(changed));
    EXPECT_EQ(seen.size(), ++changes) << "change " << changes;
  };
  change([](RgbdFrame& f) { f.stamp_ns = 6; });
  change([](RgbdFrame& f) { f.color(3, 2).b = 1; });
  change([](RgbdFrame& f) { f.depth_m(3, 2) = 1e-30F; });
  change([](RgbdFrame& f) { f.semantics.index(3, 2) = 1; });
  change([](RgbdFrame& f) { f.semantics.palette[1].entries[0].first = ClassId{4}; });
  change([](RgbdFrame& f) { f.semantics.palette[1].entries[0].second = 0.25F; });
  change([](RgbdFrame& f) { f.semantics.palette[0] = f.semantics.palette[1]; });
  change([](RgbdFrame& f) { f.depth_m = Grid2d<float>(3, 4); });
}

TEST(DigestOfATrajectory, SeesStampsPlacesTurnsAndOrder) {
  const SE3 there(Eigen::Matrix3d::Identity(), {1, 2, 3});
  const SE3 turned(so3_exp({0, 0, 0.1}), {1, 2, 3});
  const std::vector<Trajectory> all = {{},
                                       {{1, SE3()}},
                                       {{2, SE3()}},
                                       {{1, there}},
                                       {{1, turned}},
                                       {{1, SE3()}, {2, there}},
                                       {{2, there}, {1, SE3()}}};
  std::set<std::uint64_t> seen;
  for (const Trajectory& t : all) seen.insert(digest(t));
  EXPECT_EQ(seen.size(), all.size());
  EXPECT_NE(digest(std::optional<SE3>()), digest(std::optional(SE3())));
  EXPECT_NE(digest(std::optional(there)), digest(std::optional(turned)));
}

constexpr const char* kPlay = "MH_TEST_PLAY";  // environment variable: what a played run does

/// Plays the part of `modelhouse run-child`: puts a made-up result into the store. "alike": always
/// the same result; "apart": the pose of frame 4 differs if several runs are executed in parallel;
/// "fail": no result.
int play_a_run(const std::filesystem::path& file) {
  const std::string play = std::getenv(kPlay);
  if (play == "fail") return 1;
  const RunOrder order = read_order(file);
  RunResult run = some_run();
  run.spec = order.spec;
  run.points.resize(1);
  if (play == "apart" && order.jobs != 1) run.mapping.calls[1].pose_digest = 9;
  Store(order.store).put(order.key, run, {});
  return 0;
}

/// A suite of two trials in a shipped room.
Suite played_suite(const std::filesystem::path& folder) {
  const std::string root = MH_SOURCE_DIR "/bench/scenarios/";
  std::ofstream(folder / "suite.yaml")
      << "environments: [{category: room, scene: " << root << "room.yaml, mapping_tour: " << root
      << "tours/room.yaml}]\nrobot: " << root << "robot.yaml\nvocabulary: " MH_SOURCE_DIR
      << "/assets/vocabulary.mhvoc\nlevels: [ideal]\nsystems: [plain]\nlabels: [exact]\n"
      << "trials: 2\n";
  return load_suite(folder / "suite.yaml");
}

TEST(Verify, ExecutesAllRunsTwiceWithOneJobAndWithFourAndComparesThem) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  const Suite suite = played_suite(folder.path());
  std::vector<std::string> said;
  std::vector<double> shares;
  bool told_time = false;
  BenchOptions options;
  options.metrics_only = true;
  options.say = [&](std::string_view line) {
    if (line.starts_with("executing ") || line.ends_with(" to do")) said.emplace_back(line);
  };
  options.progress = [&](const PoolProgress& p) {
    shares.push_back(p.share);
    told_time = told_time || (p.share < 0.5 && p.to_go_s);
  };
  setenv(kPlay, "alike", 1);
  const Verification alike = verify(suite, {}, options);
  EXPECT_FALSE(alike.difference);
  EXPECT_EQ(alike.first, alike.second);
  EXPECT_EQ(said, (std::vector<std::string>{"executing with 1 job", "2 runs, 2 of them to do",
                                            "executing with 4 jobs", "2 runs, 2 of them to do"}));
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  ASSERT_FALSE(shares.empty());
  EXPECT_EQ(shares.front(), 0.0);
  EXPECT_EQ(shares.back(), 1.0);
  EXPECT_TRUE(std::ranges::count(shares, 0.5)) << "the half";
  EXPECT_FALSE(told_time) << "of the whole, before half of it is known";

  setenv(kPlay, "apart", 1);
  const Verification apart = verify(suite, {}, options);
  ASSERT_TRUE(apart.difference);
  EXPECT_EQ(describe(*apart.difference),
            "plain-ideal-0: mapping: frame 4 (after 2 restarts): pose differs");
  EXPECT_EQ(apart.first, alike.first);
  EXPECT_NE(apart.second.poses, alike.second.poses);
  EXPECT_EQ(apart.second.images, alike.second.images);
}

TEST(Verify, ARunThatFailedIsNoVerification) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path());
  const Suite suite = played_suite(folder.path());
  setenv(kPlay, "fail", 1);
  try {
    verify(suite, {}, {});
    FAIL();
  } catch (const MachineError& error) {
    EXPECT_STREQ(error.what(), "plain-ideal-0: exited with code 1");
  }
}

}  // namespace
}  // namespace mh

// The bench starts its own executable for each run; in this test that is this program.
int main(int argc, char** argv) {
  if (argc > 2 && std::string_view(argv[1]) == "run-child") return mh::play_a_run(argv[2]);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
