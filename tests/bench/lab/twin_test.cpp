// SPDX-License-Identifier: Apache-2.0
#include "bench/lab/twin.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "slam/io/error.hpp"
#include "tests/slam/core/kept_frames.hpp"

namespace mh {
namespace {

constexpr Stamp kSecond_ns = 1'000'000'000;

/// Blocks of random gray, 2 m away, shifted to the right by some pixels.
RgbdFrame blocks(const Camera& camera, int right_px, float depth_m, Stamp stamp_ns) {
  RgbdFrame frame{stamp_ns,
                  Grid2d<Rgb8>(camera.width_px, camera.height_px),
                  Grid2d<float>(camera.width_px, camera.height_px),
                  {}};
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const auto block = static_cast<std::uint64_t>((x - right_px + 640) / 16 * 1000 + y / 16);
      const auto gray = static_cast<std::uint8_t>(RandomStream(5).below(block, 256));
      frame.color(x, y) = {gray, gray, gray};
      frame.depth_m(x, y) = x < 10 ? 0 : depth_m;
    }
  return frame;
}

std::unique_ptr<KeptFrames> recorded(Trajectory truth) {
  const Camera camera;
  std::vector<RgbdFrame> frames;
  for (int i = 0; i < 4; ++i) frames.push_back(blocks(camera, 0, 2, i * kSecond_ns));
  return std::make_unique<KeptFrames>(std::move(frames), camera, std::move(truth));
}

TEST(PosedFrames, AreThoseWithATruePoseInTheFrameOfTheScene) {
  const SE3 scene_from_recording(Eigen::Matrix3d::Identity(), {0, 0, 5});
  const SE3 pose(Eigen::Matrix3d::Identity(), {1, 2, 3});
  const Trajectory truth{{1 * kSecond_ns, pose}, {3 * kSecond_ns, pose}};
  const PosedFrames frames(recorded(truth), scene_from_recording);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames.left_out(), 2U);
  EXPECT_EQ(frames.stamp_ns(0), 1 * kSecond_ns);
  EXPECT_EQ(frames.stamp_ns(1), 3 * kSecond_ns);
  EXPECT_EQ(frames.frame(1, RandomStream(0)).stamp_ns, 3 * kSecond_ns);
  EXPECT_EQ((*frames.truth())[0].world_from_camera.translation(), Eigen::Vector3d(1, 2, 8));
  EXPECT_EQ(PosedFrames(recorded({truth[0], truth[1]}), {}, 2).size(), 2U);
  EXPECT_THROW(PosedFrames(recorded({truth[0]}), {}), InputError);
}

Features at(std::vector<std::pair<float, std::uint64_t>> keypoints) {
  Features features;
  for (const auto& [u_px, bits] : keypoints) {
    Keypoint k;
    k.u_px = u_px;
    features.keypoints.push_back(k);
    features.descriptors.push_back({bits, 0, 0, 0});
  }
  return features;
}

TEST(Agreement, CountsWhatBecomesOfEachKeypoint) {
  const std::uint64_t all = ~0ULL;  // differs from 0 in all 64 bits
  // The first keypoint finds its match in place; the second has a neighbor with a different
  // descriptor there and its match 10 px away; the match of the third is too far away; the fourth
  // has nothing nearby.
  const Features first = at({{100, 0}, {200, 0}, {300, 0}, {500, 0}});
  const Features other = at({{102, 0}, {202, all}, {210, 0}, {325, 0}});
  const KeypointAgreement found = agreement(first, other);
  EXPECT_EQ(found.keypoints, 4U);
  EXPECT_EQ(found.repeated, 2U);
  EXPECT_EQ(found.matched, 1U);
  EXPECT_EQ(found.mismatched, 1U);
  Features coarse = at({{100, 0}});
  coarse.keypoints[0].octave = 2;
  EXPECT_EQ(agreement(at({{100, 0}}), coarse).repeated, 0U) << "two octaves apart";
}

TEST(CompareTwins, AnEqualTwinAgreesAndADisplacedOneDoesNot) {
  const Camera camera;
  const auto real = recorded({});
  const auto twin_of = [&](int right_px, float depth_m) {
    std::vector<RgbdFrame> frames;
    for (int i = 0; i < 4; ++i) frames.push_back(blocks(camera, right_px, depth_m, i * kSecond_ns));
    return KeptFrames(std::move(frames), camera, {});
  };
  const auto equal = compare_twins(*real, twin_of(0, 2), {}, 2);
  ASSERT_EQ(equal.size(), 2U);
  EXPECT_EQ(equal[1].stamp_ns, 2 * kSecond_ns);
  for (const TwinFrame& frame : equal) {
    EXPECT_EQ(frame.recorded, frame.rendered);
    EXPECT_EQ(frame.depth_difference_m, 0.0);
    EXPECT_NEAR(frame.recorded_depth_share, 1 - 10.0 / camera.width_px, 1e-12);
    EXPECT_GT(frame.across.keypoints, 300U);
    EXPECT_EQ(frame.across.repeated, frame.across.keypoints);
    EXPECT_GT(static_cast<double>(frame.across.matched),
              0.95 * static_cast<double>(frame.across.keypoints));
  }
  const auto displaced = compare_twins(*real, twin_of(8, 2.5F), {}, 4);
  ASSERT_EQ(displaced.size(), 1U);
  EXPECT_NEAR(*displaced[0].depth_difference_m, 0.5, 1e-6);
  EXPECT_LT(displaced[0].across.matched, displaced[0].across.mismatched);
  EXPECT_GT(displaced[0].noise.matched, displaced[0].across.matched);

  const std::vector<TwinRow> rows = summarize(displaced);
  const auto row = [&](std::string_view key) {
    return *std::ranges::find(rows, key, &TwinRow::key);
  };
  const KeypointAgreement& a = displaced[0].across;
  EXPECT_EQ(row("matched").recorded,
            static_cast<double>(a.matched) / static_cast<double>(a.keypoints));
  EXPECT_EQ(row("keypoints").recorded, static_cast<double>(a.keypoints));
  EXPECT_EQ(row("fast_20").recorded, displaced[0].recorded[0]);
}

}  // namespace
}  // namespace mh
