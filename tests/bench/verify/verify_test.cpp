// SPDX-License-Identifier: Apache-2.0
// What `verify` compares, field by field, in results that were made up
// (tests/bench/run/run_test.cpp has it find differences of whole runs).
#include "bench/verify/verify.hpp"

#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "bench/protocol/step_digest.hpp"
#include "bench/provenance/digest.hpp"

namespace mh {
namespace {

/// One mapped frame after a restart, two queries of each set under each of two points.
RunResult some_run() {
  RunResult run;
  run.spec.name = "run";
  run.spec.points.resize(2);
  run.mapping.calls = {{.index = 3, .stamp_ns = 30}, {.index = 4, .stamp_ns = 40, .restart = 2}};
  run.estimate = {{30, SE3()}, {40, SE3()}};
  QueryScore first, second;
  first.answer.index = 29;
  second.answer.index = 59;
  run.points.assign(2, {{first, second}, {first, second}});
  return run;
}

std::string told(const std::function<void(RunResult&)>& change) {
  RunResult changed = some_run();
  change(changed);
  const auto difference = first_difference(some_run(), changed);
  return difference ? describe(*difference) : "none";
}

TEST(FirstDifference, NamesWhateverDiffers) {
  EXPECT_EQ(told([](RunResult&) {}), "none");
  EXPECT_EQ(told([](RunResult& r) { r.place.scene_digest = 1; }), "run: world: scene differs");
  EXPECT_EQ(told([](RunResult& r) { r.place.path_digest = 1; }), "run: world: path differs");
  const auto call = [](auto field, auto value) {
    return told([=](RunResult& r) { r.mapping.calls[1].*field = value; });
  };
  const std::string at = "run: mapping: frame 4 (after 2 restarts): ";
  EXPECT_EQ(call(&MappedFrame::index, 5u), at + "order differs");
  EXPECT_EQ(call(&MappedFrame::image_digest, 1u), at + "image differs");
  EXPECT_EQ(call(&MappedFrame::matching_digest, 1u), at + "matching differs");
  EXPECT_EQ(call(&MappedFrame::pose_digest, 1u), at + "pose differs");
  EXPECT_EQ(told([](RunResult& r) { r.mapping.calls.pop_back(); }),
            "run: mapping: frame 1: order differs");
  EXPECT_EQ(told([](RunResult& r) {
              r.estimate[1].world_from_camera = SE3(Eigen::Matrix3d::Identity(), {0, 0, 1e-300});
            }),
            "run: result: frame 4: map differs");
  EXPECT_EQ(told([](RunResult& r) { r.map_digest = 1; }), "run: result: frame 0: map differs");
}

TEST(FirstDifference, NamesWhateverDiffersInAQuery) {
  const auto query = [](std::size_t point, auto set, auto field, auto value) {
    return told([=](RunResult& r) { (r.points[point].*set)[1].answer.*field = value; });
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
  EXPECT_EQ(told([](RunResult& r) { r.points[1].held_out.pop_back(); }),
            "run: held_out: frame 0: order differs");
}

// The cause comes before its consequences.
TEST(FirstDifference, IsTheFirstInTheOrderInWhichThingsHappen) {
  const auto later = [](RunResult& r) {
    r.map_digest = 1;
    r.points[0].held_out[0].answer.image_digest = 1;
    r.estimate[0].stamp_ns = 31;
    r.mapping.calls[1].image_digest = r.mapping.calls[1].matching_digest = 1;
    r.mapping.calls[1].pose_digest = 1;
  };
  EXPECT_EQ(told(later), "run: mapping: frame 4 (after 2 restarts): image differs");
  EXPECT_EQ(told([&](RunResult& r) {
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
  StepReport report;
  report.candidates.emplace();
  std::set<std::uint64_t> seen = {digest_of_matching(report)};
  std::size_t changes = 1;
  const auto change = [&](const std::function<void(StepReport&)>& with) {
    StepReport changed = report;
    with(changed);
    seen.insert(digest_of_matching(changed));
    EXPECT_EQ(seen.size(), ++changes) << "change " << changes;
  };
  change([](StepReport& r) { r.status = TrackStatus::kTracked; });
  change([](StepReport& r) { r.keypoints = 1; });
  change([](StepReport& r) { r.inliers = 1; });
  change([](StepReport& r) { r.keyframe_added = true; });
  change([](StepReport& r) { r.relocalization = RelocalizationStage::kPnp; });
  for (std::size_t m = 0; m < report.matches.size(); ++m)
    for (const auto count : {&MatcherCounts::compared, &MatcherCounts::penalized,
                             &MatcherCounts::rejected_by_xi, &MatcherCounts::ratio_helped})
      change([=](StepReport& r) { r.matches[m].*count = 1; });
  for (const auto count : {&CandidateCounts::keyframes, &CandidateCounts::c1, &CandidateCounts::c2,
                           &CandidateCounts::c3, &CandidateCounts::final})
    change([=](StepReport& r) { (*r.candidates).*count = 1; });
  change([](StepReport& r) { r.candidates->label_mass = 0.5; });
  change([](StepReport& r) { r.candidates.reset(); });
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

}  // namespace
}  // namespace mh
