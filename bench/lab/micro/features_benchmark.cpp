// SPDX-License-Identifier: Apache-2.0
// Times feature extraction and its parts against cv::ORB on one thread (1,000 features, 8 levels,
// 640x480).
#include <benchmark/benchmark.h>
#include <opencv2/features2d.hpp>

#include "slam/features/corners.hpp"
#include "slam/features/describe.hpp"
#include "slam/features/features.hpp"
#include "slam/features/pyramid.hpp"
#include "tests/slam/features/texture.hpp"

namespace mh {
namespace {

const cv::Mat kImage = testing::squares(640, 480, 1);
const RgbdFrame kFrame = testing::frame_of(kImage);
const FeatureConfig kConfig;

std::vector<PyramidLevel> pyramid() {
  return make_pyramid(kFrame.color, kConfig, 2 * kPatchReach_px + 1);
}

void opencv_orb(benchmark::State& state) {
  const auto orb = cv::ORB::create(kConfig.count);
  for (auto _ : state) {
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    orb->detectAndCompute(kImage, cv::noArray(), keypoints, descriptors);
    benchmark::DoNotOptimize(descriptors.data);
  }
}
BENCHMARK(opencv_orb)->Unit(benchmark::kMillisecond);

void extract_features(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(extract(kFrame, testing::camera_of(kFrame), kConfig));
}
BENCHMARK(extract_features)->Unit(benchmark::kMillisecond);

void part_pyramid_and_blur(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(pyramid());
}
BENCHMARK(part_pyramid_and_blur)->Unit(benchmark::kMillisecond);

void part_corners(benchmark::State& state) {
  const std::vector<PyramidLevel> levels = pyramid();
  for (auto _ : state)
    for (const PyramidLevel& level : levels)
      benchmark::DoNotOptimize(find_corners(level.image, kPatchReach_px, kConfig.fast_threshold,
                                            kConfig.fast_threshold_low));
}
BENCHMARK(part_corners)->Unit(benchmark::kMillisecond);

void part_spread(benchmark::State& state) {
  std::vector<std::vector<Corner>> corners;
  for (const PyramidLevel& level : pyramid())
    corners.push_back(find_corners(level.image, kPatchReach_px, kConfig.fast_threshold,
                                   kConfig.fast_threshold_low));
  for (auto _ : state)
    for (const std::vector<Corner>& c : corners) benchmark::DoNotOptimize(spread(c, 125));
}
BENCHMARK(part_spread)->Unit(benchmark::kMillisecond);

void part_orientation_and_descriptor(benchmark::State& state) {
  const std::vector<PyramidLevel> levels = pyramid();
  const PyramidLevel& level = levels.front();
  const std::vector<Corner> corners = spread(
      find_corners(level.image, kPatchReach_px, kConfig.fast_threshold, kConfig.fast_threshold_low),
      kConfig.count);
  for (auto _ : state)
    for (const Corner& c : corners)
      benchmark::DoNotOptimize(
          describe(level.blurred, c.x, c.y, to_radians(orientation_deg(level.image, c.x, c.y))));
}
BENCHMARK(part_orientation_and_descriptor)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace mh

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
