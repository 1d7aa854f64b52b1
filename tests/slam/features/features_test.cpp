// SPDX-License-Identifier: Apache-2.0
#include "slam/features/features.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "slam/io/error.hpp"
#include "tests/slam/features/texture.hpp"

namespace mh {
namespace {
using testing::camera_of;
using testing::frame_of;
using testing::soften;
using testing::squares;

constexpr int kWidth = 640;
constexpr int kHeight = 480;

Features extract_from(const cv::Mat& gray, const FeatureConfig& config = {}) {
  const RgbdFrame frame = frame_of(gray);
  return extract(frame, camera_of(frame), config);
}

// The position of a keypoint in its own pyramid level, px.
cv::Point2d on_its_level(const Keypoint& k, const FeatureConfig& config, cv::Size full) {
  const double scale = std::pow(config.scale, k.octave);
  const double width = std::round(full.width / scale), height = std::round(full.height / scale);
  return {(k.u_px + 0.5) * width / full.width - 0.5, (k.v_px + 0.5) * height / full.height - 0.5};
}

// Degrees that cv::ORB converts to exactly these radians; if several floats do, the nearest one.
float degrees_for(float radians) {
  const auto factor = static_cast<float>(CV_PI / 180.0);
  const auto guess = static_cast<float>(radians * 180.0 / CV_PI);
  for (float low = guess, high = guess;;
       low = std::nextafter(low, -1e9F), high = std::nextafter(high, 1e9F)) {
    if (low * factor == radians) return low;
    if (high * factor == radians) return high;
    if (high - guess > 0.01F) return std::numeric_limits<float>::quiet_NaN();
  }
}

double angle_difference(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * std::numbers::pi));
}

TEST(Extract, DescriptorsEqualThoseOfOpenCvBitForBit) {
  const cv::Mat image = squares(kWidth, kHeight, 1);
  const FeatureConfig config;
  const Features features = extract_from(image, config);
  ASSERT_EQ(features.size(), 1000U);

  // cv::ORB holds its scale as a float and rounds pt / scale to the pixel of the level.
  std::vector<cv::KeyPoint> keypoints;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Keypoint& k = features.keypoints[i];
    const cv::Point2d p = on_its_level(k, config, image.size());
    const double scale = std::pow(config.scale, k.octave);
    const float degrees = degrees_for(k.angle_rad);
    ASSERT_FALSE(std::isnan(degrees));
    keypoints.emplace_back(static_cast<float>(std::round(p.x) * scale),
                           static_cast<float>(std::round(p.y) * scale), 31.0F, degrees, 1.0F,
                           k.octave, static_cast<int>(i));
  }
  const auto orb = cv::ORB::create(1000, 1.2F, 8, /*edgeThreshold=*/1);
  cv::Mat descriptors;
  orb->compute(image, keypoints, descriptors);
  ASSERT_EQ(keypoints.size(), features.size());
  ASSERT_EQ(descriptors.rows, 1000);

  std::vector<int> per_octave(8, 0);
  for (int row = 0; row < descriptors.rows; ++row) {
    const auto i = static_cast<std::size_t>(keypoints[static_cast<std::size_t>(row)].class_id);
    Descriptor expected;
    std::memcpy(expected.data(), descriptors.ptr(row), sizeof expected);
    EXPECT_EQ(hamming(features.descriptors[i], expected), 0) << "keypoint " << i;
    ++per_octave[static_cast<std::size_t>(features.keypoints[i].octave)];
  }
  EXPECT_GE(*std::min_element(per_octave.begin(), per_octave.end()), 30);
}

TEST(Extract, OrientationsEqualThoseOfOpenCv) {
  const cv::Mat image = squares(kWidth, kHeight, 2);
  FeatureConfig config;
  config.levels = 1;
  const Features features = extract_from(image, config);
  const auto orb = cv::ORB::create(20000, 1.2F, 1, 19, 0, 2, cv::ORB::FAST_SCORE, 31, 20);
  std::vector<cv::KeyPoint> theirs;
  orb->detect(image, theirs);

  int compared = 0;
  for (const Keypoint& k : features.keypoints)
    for (const cv::KeyPoint& t : theirs) {
      if (t.pt.x != std::round(k.u_px) || t.pt.y != std::round(k.v_px)) continue;
      // cv::fastAtan2 is accurate to about 0.3 deg.
      EXPECT_LT(angle_difference(k.angle_rad, t.angle * CV_PI / 180.0), 0.006);
      ++compared;
    }
  EXPECT_GT(compared, 500);
}

TEST(Extract, IsDeterministic) {
  const cv::Mat image = squares(kWidth, kHeight, 3);
  const Features a = extract_from(image), b = extract_from(image);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.descriptors, b.descriptors);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.keypoints[i].u_px, b.keypoints[i].u_px);
    EXPECT_EQ(a.keypoints[i].v_px, b.keypoints[i].v_px);
    EXPECT_EQ(a.keypoints[i].angle_rad, b.keypoints[i].angle_rad);
  }
}

TEST(Extract, AQuarterTurnTurnsAnglesAndKeepsDescriptors) {
  const cv::Mat image = squares(480, 480, 4);
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
  FeatureConfig config;
  config.levels =
      1;  // pyramid levels are sampled at the same positions only if sizes divide evenly
  const Features a = extract_from(image, config), b = extract_from(turned, config);
  ASSERT_EQ(a.size(), 1000U);

  int found = 0, close = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) {
      // (x, y) goes to (height - 1 - y, x).
      if (std::abs(b.keypoints[j].u_px - (479 - a.keypoints[i].v_px)) > 1e-3F ||
          std::abs(b.keypoints[j].v_px - a.keypoints[i].u_px) > 1e-3F)
        continue;
      ++found;
      EXPECT_LT(angle_difference(b.keypoints[j].angle_rad,
                                 a.keypoints[i].angle_rad + std::numbers::pi / 2),
                1e-4);
      // Only comparisons of points between pixels can change, and those are few.
      close += hamming(a.descriptors[i], b.descriptors[j]) <= 10;
    }
  EXPECT_GT(found, 700);  // ties in strength are broken in image order, which the rotation changes
  EXPECT_GE(close, 95 * found / 100);
}

TEST(Extract, SpreadsKeypointsOverUnevenTexture) {
  // Faint texture all over, and one strongly textured patch.
  cv::Mat image = squares(kWidth, kHeight, 5, 1.0);
  image.convertTo(image, CV_8U, 0.3, 90);
  squares(160, 120, 6, 1.0).copyTo(image(cv::Rect(0, 0, 160, 120)));
  const Features features = extract_from(image);
  ASSERT_EQ(features.size(), 1000U);
  int in_patch = 0;
  std::vector<int> per_tile(12, 0);
  for (const Keypoint& k : features.keypoints) {
    in_patch += k.u_px < 160 && k.v_px < 120;
    ++per_tile[static_cast<std::size_t>(k.v_px / 160) * 4 + static_cast<std::size_t>(k.u_px / 160)];
  }
  EXPECT_LT(in_patch, 200);  // the patch covers 1/16 of the area
  EXPECT_GT(*std::min_element(per_tile.begin(), per_tile.end()), 15);
}

TEST(Extract, LowThresholdServesCellsWithoutStrongCorners) {
  // Squares 12 gray levels brighter than the background: not found at a FAST threshold of 20, but
  // found at 7.
  cv::Mat image(kHeight, kWidth, CV_8U, cv::Scalar(100));
  for (int y = 30; y < kHeight - 40; y += 40)
    for (int x = 30; x < kWidth - 40; x += 40)
      cv::rectangle(image, {x, y, 15, 15}, cv::Scalar(112), cv::FILLED);
  cv::GaussianBlur(image, image, {5, 5}, 0.8);
  EXPECT_GT(extract_from(image).size(), 200U);
  FeatureConfig high_only;
  high_only.fast_threshold_low = high_only.fast_threshold;
  EXPECT_EQ(extract_from(image, high_only).size(), 0U);
}

TEST(Extract, MirroredImagesHaveMirroredKeypointsOnEveryLevel) {
  // The positions are off by scale - 1 px if levels are not mapped center to center (as with u = x
  // * scale).
  const cv::Mat image = squares(kWidth, kHeight, 12);
  cv::Mat mirrored;
  cv::flip(image, mirrored, /*both axes=*/-1);
  const Features a = extract_from(image), b = extract_from(mirrored);
  std::vector<int> found(8, 0), all(8, 0);
  for (const Keypoint& k : a.keypoints) {
    const auto octave = static_cast<std::size_t>(k.octave);
    ++all[octave];
    found[octave] += std::any_of(b.keypoints.begin(), b.keypoints.end(), [&](const Keypoint& m) {
      return m.octave == k.octave && std::abs(m.u_px - (kWidth - 1 - k.u_px)) < 1e-3F &&
             std::abs(m.v_px - (kHeight - 1 - k.v_px)) < 1e-3F;
    });
  }
  for (std::size_t l = 0; l < 8; ++l) {
    EXPECT_GE(all[l], 30);
    EXPECT_GT(found[l], 0.6 * all[l]) << "level " << l;  // ties are broken in image order
  }
}

TEST(Extract, FollowsShiftsOfAFractionOfAPixel) {
  // Drawn at four times the size, shifted by whole pixels, then reduced: a shift by quarters of a
  // pixel.
  const auto reduced = [](int shift) {
    cv::Mat large = squares(4 * 324, 4 * 244, 13);
    cv::GaussianBlur(large, large, {}, 3.0);  // a lens blur that matches the reduced pixels
    const cv::Mat window = large(cv::Rect(8 - shift, 8 - shift, 4 * 320, 4 * 240));
    cv::Mat image;
    cv::resize(window, image, {320, 240}, 0, 0, cv::INTER_AREA);
    return image;
  };
  FeatureConfig config;
  config.levels = 1;
  const Features before = extract_from(reduced(0), config);
  for (const int quarters : {1, 2, 3}) {
    const Features after = extract_from(reduced(quarters), config);
    const double truth_px = quarters / 4.0;
    double sum = 0, squares_sum = 0;
    int matched = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
      for (std::size_t j = 0; j < after.size(); ++j) {
        const double du = after.keypoints[j].u_px - before.keypoints[i].u_px;
        const double dv = after.keypoints[j].v_px - before.keypoints[i].v_px;
        if (std::hypot(du - truth_px, dv - truth_px) > 1.5 ||
            hamming(before.descriptors[i], after.descriptors[j]) > 40)
          continue;
        sum += du + dv - 2 * truth_px;
        squares_sum += (du - truth_px) * (du - truth_px) + (dv - truth_px) * (dv - truth_px);
        ++matched;
      }
    ASSERT_GT(matched, 200);
    EXPECT_NEAR(sum / (2 * matched), 0.0, 0.05);
    // Rounding to whole pixels would give errors of sqrt(q (1 - q)): 0.43, 0.5, 0.43 px.
    EXPECT_LT(std::sqrt(squares_sum / (2 * matched)), 0.3) << quarters;
  }
}

TEST(Extract, ImagesWithoutTextureHaveNoFeatures) {
  for (const int gray : {0, 255, 127}) {
    EXPECT_EQ(extract_from(cv::Mat(kHeight, kWidth, CV_8U, cv::Scalar(gray))).size(), 0U);
    EXPECT_EQ(extract_from(cv::Mat(5, 7, CV_8U, cv::Scalar(gray))).size(), 0U);
  }
}

TEST(Extract, NeverReturnsMoreThanAskedFor) {
  const cv::Mat image = squares(kWidth, kHeight, 7);
  for (const int count : {0, 1, 7, 500, 2000}) {
    FeatureConfig config;
    config.count = count;
    EXPECT_EQ(extract_from(image, config).size(), static_cast<std::size_t>(count));
  }
}

TEST(Extract, TakesDepthAndLabelAtTheKeypointsPixel) {
  RgbdFrame frame = frame_of(squares(kWidth, kHeight, 8));
  frame.semantics.index = Grid2d<std::uint8_t>(kWidth, kHeight);
  frame.semantics.palette = {ClassDistribution{}, ClassDistribution::one_hot(5),
                             ClassDistribution{{{3, 0.3F}, {9, 0.6F}}}};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      frame.depth_m(x, y) = 1.0F + 0.005F * static_cast<float>(x) + 0.001F * static_cast<float>(y);
      frame.semantics.index(x, y) = static_cast<std::uint8_t>((x / 7 + y / 5) % 3);
    }
  const Features features = extract(frame, camera_of(frame), {});
  ASSERT_EQ(features.size(), 1000U);
  constexpr ClassId kLabels[] = {kVoid, 5, 9};
  for (const Keypoint& k : features.keypoints) {
    const int x = static_cast<int>(std::lround(k.u_px)), y = static_cast<int>(std::lround(k.v_px));
    // lround and OpenCV's rounding differ at exactly one half.
    if (std::abs(k.u_px - x) > 0.499F || std::abs(k.v_px - y) > 0.499F) continue;
    EXPECT_EQ(k.depth_m, frame.depth_m(x, y));
    EXPECT_EQ(k.label, kLabels[(x / 7 + y / 5) % 3]);
  }
}

TEST(Extract, TheCornerOfASilhouetteIsAsNearAsWhatStandsInFront) {
  RgbdFrame frame = frame_of(squares(kWidth, kHeight, 10));
  // Columns alternately 1 m and 3 m away, each 4 pixels wide; one row in three has no depth.
  const auto surface = [](int x) { return x / 4 % 2 == 0 ? 1.0F : 3.0F; };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) frame.depth_m(x, y) = y % 3 == 0 ? 0.0F : surface(x);
  int at_edges = 0, behind = 0;
  for (const Keypoint& k : extract(frame, camera_of(frame), {}).keypoints) {
    const int x = static_cast<int>(std::lround(k.u_px)), y = static_cast<int>(std::lround(k.v_px));
    if (std::abs(k.u_px - x) > 0.499F || std::abs(k.v_px - y) > 0.499F) continue;
    const float left = surface(x - 1), right = surface(x + 1);
    if (left != right) {
      EXPECT_EQ(k.depth_m, 1.0F) << "whatever the pixel itself shows";
      ++at_edges;
    } else {
      EXPECT_EQ(k.depth_m, frame.depth_m(x, y)) << "one surface: nothing is made up";
      behind += k.depth_m == 3.0F;
    }
  }
  EXPECT_GT(at_edges, 100);
  EXPECT_GT(behind, 100);
}

// Pixels less than 5 % behind the nearest of the 3x3 pixels are on the same surface.
TEST(Extract, ASurfaceEndsAtExactlyFivePercentBehindTheNearest) {
  RgbdFrame frame = frame_of(squares(kWidth, kHeight, 10));
  const float second = 1.05F;
  for (const auto& [behind, is_another] :
       {std::pair(std::nextafter(second, 0.0F), false), {second, true}, {2.0F, true}}) {
    const auto surface = [behind = behind](int x) { return x / 4 % 2 == 0 ? 1.0F : behind; };
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) frame.depth_m(x, y) = surface(x);
    int at_edges = 0;
    for (const Keypoint& k : extract(frame, camera_of(frame), {}).keypoints) {
      const int x = static_cast<int>(std::lround(k.u_px));
      if (std::abs(k.u_px - x) > 0.499F) continue;
      const bool edge = surface(x - 1) != surface(x + 1);
      EXPECT_EQ(k.depth_m, edge && is_another ? 1.0F : surface(x)) << behind;
      at_edges += edge && surface(x) == behind;
    }
    EXPECT_GT(at_edges, 100);
  }
}

TEST(Extract, DepthThatIsNoDepthCountsAsNone) {
  RgbdFrame frame = frame_of(squares(kWidth, kHeight, 9));
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, -1.0F, 0.0F, 8.001F}) {
    std::fill(frame.depth_m.begin(), frame.depth_m.end(), bad);
    const Features features = extract(frame, camera_of(frame), {});
    ASSERT_EQ(features.size(), 1000U);
    for (const Keypoint& k : features.keypoints) EXPECT_EQ(k.depth_m, 0.0F);
  }
  frame.depth_m = {};
  for (const Keypoint& k : extract(frame, camera_of(frame), {}).keypoints)
    EXPECT_EQ(k.depth_m, 0.0F);
}

TEST(Extract, UndistortedKeypointsDistortBackToTheirPixels) {
  const RgbdFrame frame = frame_of(squares(kWidth, kHeight, 10));
  Camera camera = camera_of(frame);
  const Features raw = extract(frame, camera, {});
  // The lens distortion of Freiburg 1 of the TUM benchmark, which is strong and has tangential
  // terms, and that of an Azure Kinect's color camera.
  for (const Distortion& d :
       {Distortion{.k1 = 0.2624, .k2 = -0.9531, .p1 = -0.0054, .p2 = 0.0026, .k3 = 1.1633},
        Distortion{0.5286, -2.6450, 0.00082, -0.00022, 1.5006, 0.4073, -2.4695, 1.4282}}) {
    camera.distortion = d;
    const Features straight = extract(frame, camera, {});
    ASSERT_EQ(raw.size(), straight.size());
    float moved_px = 0;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      const double x = (straight.keypoints[i].u_px - camera.cx_px) / camera.fx_px;
      const double y = (straight.keypoints[i].v_px - camera.cy_px) / camera.fy_px;
      const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
      const double radial =
          (1 + d.k1 * r2 + d.k2 * r4 + d.k3 * r6) / (1 + d.k4 * r2 + d.k5 * r4 + d.k6 * r6);
      const double xd = x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x);
      const double yd = y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y;
      EXPECT_NEAR(xd * camera.fx_px + camera.cx_px, raw.keypoints[i].u_px, 0.01);
      EXPECT_NEAR(yd * camera.fy_px + camera.cy_px, raw.keypoints[i].v_px, 0.01);
      moved_px = std::max(moved_px, std::hypot(straight.keypoints[i].u_px - raw.keypoints[i].u_px,
                                               straight.keypoints[i].v_px - raw.keypoints[i].v_px));
      EXPECT_EQ(raw.keypoints[i].depth_m, straight.keypoints[i].depth_m);
    }
    EXPECT_EQ(raw.descriptors, straight.descriptors);
    EXPECT_GT(moved_px, 3.0F);
  }
}

TEST(Extract, RefusesAFrameOfAnotherSize) {
  RgbdFrame frame = frame_of(squares(kWidth, kHeight, 11));
  Camera camera = camera_of(frame);
  camera.width_px = 641;
  EXPECT_THROW(extract(frame, camera, {}), InputError);
  camera.width_px = kWidth;
  frame.depth_m = Grid2d<float>(320, 240);
  EXPECT_THROW(extract(frame, camera, {}), InputError);
  frame.depth_m = {};
  frame.semantics.index = Grid2d<std::uint8_t>(kWidth, 240);
  EXPECT_THROW(extract(frame, camera, {}), InputError);
}

}  // namespace
}  // namespace mh
