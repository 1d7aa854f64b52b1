// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/sense.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

#include "slam/io/error.hpp"
#include "slam/io/files.hpp"
#include "source_dir.hpp"

namespace mh {
namespace {

const Camera kCamera;
constexpr double kDegree = std::numbers::pi / 180.0;

RenderedFrame blank_frame(float depth_m, Rgb8 color = {120, 130, 140}) {
  const int w = kCamera.width_px, h = kCamera.height_px;
  return {Grid2d<Rgb8>(w, h, color), Grid2d<float>(w, h, depth_m), Grid2d<ClassId>(w, h),
          Grid2d<InstanceId>(w, h)};
}

/// Depth of the plane with unit normal (0, -sin t, -cos t) that intersects the axis at
/// `distance_m`: a surface that leans back by the angle t.
RenderedFrame leaning_plane(double distance_m, double angle_rad) {
  RenderedFrame frame = blank_frame(0.0F);
  for (int y = 0; y < kCamera.height_px; ++y) {
    const double b = (y - kCamera.cy_px) / kCamera.fy_px;
    const double depth =
        distance_m * std::cos(angle_rad) / (std::cos(angle_rad) + b * std::sin(angle_rad));
    for (float& z : frame.depth_m.row(y)) z = depth > 0.0 ? static_cast<float>(depth) : 0.0F;
  }
  return frame;
}

/// The angle between a pixel's ray and the normal of that plane.
double incidence_rad(int x, int y, double angle_rad) {
  const Eigen::Vector3d d = kCamera.unproject(x, y, 1.0).normalized();
  return std::acos(std::abs(d.dot(Eigen::Vector3d(0, std::sin(angle_rad), std::cos(angle_rad)))));
}

SensorConfig no_noise() {
  SensorConfig config;
  config.color_noise.enabled = false;
  config.depth_noise = no_depth_noise();
  return config;
}

RgbdFrame sensed(const RenderedFrame& truth, const SensorConfig& config, std::uint64_t seed = 1) {
  return sense(truth, kCamera, config, RandomStream(seed), 5);
}

struct Moments {
  double n = 0, sum = 0, square = 0;
  void add(double x) { n += 1, sum += x, square += x * x; }
  double mean() const { return sum / n; }
  double sigma() const { return std::sqrt(square / n - mean() * mean()); }
};

TEST(DepthNoise, AllOffIsTheTruth) {
  const RenderedFrame truth = leaning_plane(2.0, 0.5);
  EXPECT_EQ(sensed(truth, no_noise()).depth_m, truth.depth_m);
  SensorConfig off;
  off.depth_noise.enabled = off.color_noise.enabled = false;
  EXPECT_EQ(sensed(truth, off).depth_m, truth.depth_m);
  EXPECT_EQ(sensed(truth, off).color, truth.color);
  EXPECT_EQ(sensed(truth, off).stamp_ns, 5);
}

TEST(DepthNoise, AxialSigmaOverDistanceIsThePublishedOne) {
  SensorConfig config = no_noise();
  config.depth_noise.axial = true;
  for (const double z : {0.6, 1.0, 2.0, 3.5, 5.0}) {
    const RgbdFrame frame = sensed(blank_frame(static_cast<float>(z)), config);
    Moments moments;
    for (const float depth : frame.depth_m) moments.add(depth - z);
    const double published = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    EXPECT_NEAR(moments.sigma(), published, 0.05 * published) << z;
    // 307,200 samples: the standard error of the mean is sigma / 554.
    EXPECT_NEAR(moments.mean(), 0.0, 5.0 * published / 554.0) << z;
  }
}

TEST(DepthNoise, AxialSigmaGrowsWithSteepIncidenceAsPublished) {
  SensorConfig config = no_noise();
  config.depth_noise.axial = true;
  const double angle = 70.0 * kDegree;
  const RenderedFrame truth = leaning_plane(2.0, angle);
  const RgbdFrame frame = sensed(truth, config);
  Moments standardized;
  double smallest_angular_share = 1.0;
  for (int y = 200; y < 260; ++y)
    for (int x = 0; x < kCamera.width_px; ++x) {
      const double z = truth.depth_m(x, y), theta = incidence_rad(x, y, angle);
      ASSERT_GT(theta, 60.0 * kDegree);
      const double ratio = theta / (std::numbers::pi / 2 - theta);
      const double flat = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
      const double sigma = flat + 0.0001 / std::sqrt(z) * ratio * ratio;
      smallest_angular_share = std::min(smallest_angular_share, (sigma - flat) / flat);
      standardized.add((frame.depth_m(x, y) - z) / sigma);
    }
  EXPECT_GT(smallest_angular_share, 0.05);  // otherwise the term would have no visible effect
  EXPECT_NEAR(standardized.sigma(), 1.0, 0.03);
}

TEST(DepthNoise, LateralNoiseMovesEdgesAndNothingElse) {
  SensorConfig config = no_noise();
  config.depth_noise.lateral = true;
  RenderedFrame truth = blank_frame(2.0F);
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 0; x < 320; ++x) truth.depth_m(x, y) = 1.0F;
  const RgbdFrame frame = sensed(truth, config);
  const double sigma = lateral_sigma_px(0.0);
  EXPECT_DOUBLE_EQ(sigma, 0.8);
  for (int k = 0; k < 3; ++k) {  // k px to the left of the last near column
    int far = 0;
    for (int y = 0; y < kCamera.height_px; ++y) {
      const float depth = frame.depth_m(319 - k, y);
      ASSERT_TRUE(std::abs(depth - 1.0F) < 1e-4F || std::abs(depth - 2.0F) < 1e-4F);
      far += depth > 1.5F;
    }
    const double expected = 0.5 * std::erfc((k + 0.5) / sigma / std::numbers::sqrt2);
    const double spread = std::sqrt(expected * (1 - expected) / kCamera.height_px);
    EXPECT_NEAR(static_cast<double>(far) / kCamera.height_px, expected, 4 * spread + 0.02) << k;
  }
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 0; x < kCamera.width_px; ++x)
      if (std::abs(x - 320) > 6) {
        ASSERT_NEAR(frame.depth_m(x, y), truth.depth_m(x, y), 1e-5);
      }

  // Lateral noise changes nothing on a smooth slope, where inverse depth is affine.
  const RenderedFrame slope = leaning_plane(2.0, 0.9);
  const RgbdFrame slid = sensed(slope, config);
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 0; x < kCamera.width_px; ++x)
      ASSERT_NEAR(slid.depth_m(x, y), slope.depth_m(x, y), 2e-4 * slope.depth_m(x, y));
}

TEST(DepthNoise, QuantizationStepIsAnEighthOfAPixelOfDisparity) {
  SensorConfig config = no_noise();
  config.depth_noise.quantization = true;
  const RenderedFrame truth = leaning_plane(2.0, 0.6);
  const RgbdFrame frame = sensed(truth, config);
  std::set<float> distinct;
  for (int y = 0; y < kCamera.height_px; ++y) {
    const double before = kCamera.disparity_px(truth.depth_m(7, y));
    const double after = kCamera.disparity_px(frame.depth_m(7, y));
    ASSERT_NEAR(after * 8.0, std::round(after * 8.0), 1e-3);
    ASSERT_LE(std::abs(after - before), 0.5 / 8.0 + 1e-4);
    distinct.insert(frame.depth_m(7, y));
  }
  EXPECT_GT(distinct.size(), 50U);
  // Khoshelham and Elberink: z^2 / (f b) per pixel, so about 1.3 cm per step at 2 m.
  const float low = *std::prev(distinct.upper_bound(2.0F)), high = *distinct.upper_bound(2.0F);
  EXPECT_NEAR(high - low, 2.0 * 2.0 / (525.0 * 0.075) / 8.0, 5e-4);
}

TEST(DepthNoise, GrazingSurfacesGiveNoReturn) {
  SensorConfig config = no_noise();
  config.depth_noise.grazing_holes = true;
  const double angle = 75.0 * kDegree;
  const RenderedFrame truth = leaning_plane(3.0, angle);
  const RgbdFrame frame = sensed(truth, config);
  int holes = 0, kept = 0;
  for (int y = 0; y < kCamera.height_px; ++y) {
    if (truth.depth_m(300, y) <= 0.0F || truth.depth_m(300, y) > 100.0F) continue;
    const double theta = incidence_rad(300, y, angle);
    if (std::abs(theta - kMaxIncidenceRad) < 0.2 * kDegree) continue;  // rounding of the gradient
    const bool hole = frame.depth_m(300, y) == 0.0F;
    ASSERT_EQ(hole, theta > kMaxIncidenceRad) << y;
    (hole ? holes : kept) += 1;
  }
  EXPECT_GT(holes, 20);
  EXPECT_GT(kept, 200);
}

TEST(DepthNoise, TheProjectorsShadowLiesLeftOfWhatStandsInFront) {
  SensorConfig config = no_noise();
  config.depth_noise.projector_shadow = true;
  RenderedFrame truth = blank_frame(3.0F);
  for (int y = 100; y < 300; ++y)
    for (int x = 300; x < 400; ++x) truth.depth_m(x, y) = 1.0F;
  const RgbdFrame frame = sensed(truth, config);
  // Khoshelham and Elberink, figure 1: f b (1 / z_front - 1 / z_back) px wide.
  const double width = 525.0 * 0.075 * (1.0 / 1.0 - 1.0 / 3.0);
  for (int y = 0; y < kCamera.height_px; ++y) {
    int holes = 0;
    for (int x = 0; x < kCamera.width_px; ++x) {
      if (frame.depth_m(x, y) > 0.0F) continue;
      ++holes;
      ASSERT_TRUE(x >= 300 - width - 2 && x < 300) << x;
    }
    ASSERT_NEAR(holes, y >= 100 && y < 300 ? width : 0.0, 1.6) << y;
  }
  // A pole casts a shadow of its own width: to the right of the shadow, the wall is lit again.
  for (float& z : truth.depth_m) z = 3.0F;
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 300; x < 306; ++x) truth.depth_m(x, y) = 1.0F;
  const RgbdFrame pole = sensed(truth, config);
  int holes = 0;
  for (const float depth : pole.depth_m.row(50)) holes += depth == 0.0F;
  EXPECT_NEAR(holes, 6, 1.6);
  EXPECT_GT(pole.depth_m(295, 50), 0.0F);
  // A slope does not shade itself, no matter how steep it is.
  const RgbdFrame slope = sensed(leaning_plane(2.0, 1.2), config);
  EXPECT_EQ(slope.depth_m, leaning_plane(2.0, 1.2).depth_m);
}

TEST(DepthNoise, NothingIsSeenOutOfRange) {
  SensorConfig config = no_noise();
  config.depth_noise.min_range_m = 0.4;
  config.depth_noise.max_range_m = 8.0;
  EXPECT_EQ(sensed(blank_frame(0.39F), config).depth_m(5, 5), 0.0F);
  EXPECT_EQ(sensed(blank_frame(0.41F), config).depth_m(5, 5), 0.41F);
  EXPECT_EQ(sensed(blank_frame(7.9F), config).depth_m(5, 5), 7.9F);
  EXPECT_EQ(sensed(blank_frame(8.1F), config).depth_m(5, 5), 0.0F);
  EXPECT_EQ(sensed(blank_frame(0.0F), config).depth_m(5, 5), 0.0F);
}

TEST(ColorNoise, IsGaussianWithTheStatedSigmaAndIndependentChannels) {
  SensorConfig config = no_noise();
  config.color_noise.enabled = true;
  const RgbdFrame frame = sensed(blank_frame(2.0F), config);
  Moments r, g, b, rg;
  int beyond_two = 0;
  const double sigma = 0.007 * 255.0;
  for (const Rgb8& c : frame.color) {
    r.add(c.r - 120), g.add(c.g - 130), b.add(c.b - 140), rg.add((c.r - 120) * (c.g - 130));
    beyond_two += std::abs(c.r - 120) > 3.5;  // more than 3.5 gray levels = 1.961 sigma
  }
  const double rounded = std::sqrt(sigma * sigma + 1.0 / 12.0);  // rounding to whole levels
  for (const Moments& channel : {r, g, b}) {
    EXPECT_NEAR(channel.sigma(), rounded, 0.01 * rounded);
    EXPECT_NEAR(channel.mean(), 0.0, 0.02);
  }
  EXPECT_NEAR(rg.mean(), 0.0, 0.03);
  EXPECT_NEAR(beyond_two / r.n, std::erfc(3.5 / sigma / std::numbers::sqrt2), 0.002);
}

TEST(ColorNoise, StopsAtBlackAndWhite) {
  SensorConfig config = no_noise();
  config.color_noise.enabled = true;
  config.color_noise.sigma = 0.1;
  const RgbdFrame frame = sensed(blank_frame(2.0F, {0, 255, 128}), config);
  int black = 0, white = 0;
  for (const Rgb8& c : frame.color) {
    ASSERT_LT(c.r, 128);  // wrapping around would turn black into white
    ASSERT_GT(c.g, 127);
    black += c.r == 0, white += c.g == 255;
  }
  EXPECT_GT(black, 140000);
  EXPECT_GT(white, 140000);
}

TEST(Sense, SameKeySameBitsOtherKeyOtherNoise) {
  const RenderedFrame truth = leaning_plane(2.0, 0.5);
  const RgbdFrame a = sensed(truth, {}, 1), b = sensed(truth, {}, 1), c = sensed(truth, {}, 2);
  EXPECT_EQ(a.depth_m, b.depth_m);
  EXPECT_EQ(a.color, b.color);
  EXPECT_NE(a.depth_m, c.depth_m);
  EXPECT_NE(a.color, c.color);
  // Depth noise does not affect the random stream of color.
  SensorConfig color_only;
  color_only.depth_noise.enabled = false;
  EXPECT_EQ(sensed(truth, color_only).color, a.color);
}

void paint_box(RenderedFrame& frame, int left, int top, int right, int bottom, ClassId class_id,
               InstanceId instance) {
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      frame.classes(x, y) = class_id;
      frame.instances(x, y) = instance;
    }
}

TEST(LabelImage, ExactLabelsAreThePixelsClasses) {
  RenderedFrame truth = blank_frame(2.0F);
  paint_box(truth, 10, 10, 200, 200, 1, 1);
  paint_box(truth, 50, 60, 90, 99, 5, 2);
  const SemanticImage image = label_image(truth, LabelMode::kExact);
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 0; x < kCamera.width_px; ++x)
      ASSERT_EQ(image.at(x, y), ClassDistribution::one_hot(truth.classes(x, y)));
  EXPECT_TRUE(image.at(0, 0).entries.empty());
  EXPECT_EQ(image.at(60, 70).most_probable(), 5);
  EXPECT_TRUE(label_image(truth, LabelMode::kNone).index.empty());
  EXPECT_TRUE(label_image(truth, LabelMode::kNone).at(3, 3).entries.empty());
}

TEST(LabelImage, EachVisibleObjectHasAnEntryOfItsOwn) {
  RenderedFrame truth = blank_frame(2.0F);
  paint_box(truth, 10, 10, 59, 59, 5, 1);
  paint_box(truth, 60, 10, 99, 59, 5, 2);  // touches the first
  paint_box(truth, 10, 80, 59, 99, 7, 0);  // without an instance
  const SemanticImage image = label_image(truth, LabelMode::kExact);
  EXPECT_NE(image.index(20, 20), image.index(80, 20));
  EXPECT_EQ(image.at(20, 20), image.at(80, 20));
  EXPECT_EQ(image.index(20, 90), 7);
  // Erosion removes pixels at the border of a class, but not at the border of two objects of the
  // same class.
  LabelConfig config;
  config.noise = {.enabled = true, .erosion_px = 2};
  const SemanticImage eroded =
      label_image(truth, LabelMode::kExact, config, SE3(), RandomStream(1));
  EXPECT_EQ(eroded.at(59, 30).most_probable(), 5);
  EXPECT_EQ(eroded.at(60, 30).most_probable(), 5);
  EXPECT_EQ(eroded.at(11, 30).most_probable(), kVoid);
}

TEST(LabelImage, FewerClassesAreDistinguishedOnDemand) {
  RenderedFrame truth = blank_frame(2.0F);
  const auto id = [](const char* name) { return class_by_name(name).value(); };
  const std::vector<const char*> names = {"bed",  "night stand", "lamp",  "wall",   "door",
                                          "desk", "floor mat",   "books", "window", "cup"};
  for (std::size_t i = 0; i < names.size(); ++i)
    paint_box(truth, static_cast<int>(20 * i), 0, static_cast<int>(20 * i) + 19, 50, id(names[i]),
              static_cast<InstanceId>(i + 1));
  const auto seen = [&](ClassSet set) {
    LabelConfig config;
    config.noise = {.enabled = true, .class_set = set};
    const SemanticImage image =
        label_image(truth, LabelMode::kExact, config, SE3(), RandomStream(1));
    std::vector<std::string_view> classes_seen;
    for (std::size_t i = 0; i < names.size(); ++i)
      classes_seen.push_back(
          classes()[image.at(static_cast<int>(20 * i) + 5, 20).most_probable()].name);
    EXPECT_NE(image.index(25, 20), image.index(45, 20));  // objects remain separate
    return classes_seen;
  };
  using Names = std::vector<std::string_view>;
  EXPECT_EQ(seen(ClassSet::kAll), Names(names.begin(), names.end()));
  EXPECT_EQ(seen(ClassSet::kThirteen), (Names{"bed", "otherfurniture", "otherprop", "wall", "wall",
                                              "table", "floor", "books", "window", "otherprop"}));
  EXPECT_EQ(seen(ClassSet::kFive),
            (Names{"otherfurniture", "otherfurniture", "otherprop", "wall", "wall",
                   "otherfurniture", "floor", "otherprop", "wall", "otherprop"}));
  EXPECT_EQ(seen(ClassSet::kTwo), (Names{"otherprop", "otherprop", "otherprop", "wall", "wall",
                                         "otherprop", "wall", "otherprop", "wall", "otherprop"}));
}

TEST(LabelImage, MoreObjectsThanAPaletteHoldsShareTheEntryOfTheirClass) {
  RenderedFrame truth = blank_frame(2.0F);
  for (int i = 0; i < 400; ++i) {
    const int x = i % 25 * 12, y = i / 25 * 12,
              side = i < 300 ? 8 : 4;  // the last ones are smaller
    paint_box(truth, x, y, x + side, y + side, 5, static_cast<InstanceId>(i + 1));
  }
  const SemanticImage image = label_image(truth, LabelMode::kExact);
  EXPECT_EQ(image.palette.size(), 256u);
  std::set<std::uint8_t> entries;
  for (int i = 0; i < 400; ++i) {
    const int x = i % 25 * 12, y = i / 25 * 12;
    EXPECT_EQ(image.at(x + 1, y + 1), ClassDistribution::one_hot(5));
    if (i >= 300) {
      EXPECT_EQ(image.index(x + 1, y + 1), 5);
    }
    entries.insert(image.index(x + 1, y + 1));
  }
  EXPECT_EQ(entries.size(), 256 - classes().size() + 1);
}

TEST(LabelImage, BoxesAreThoseWorkedOutByHand) {
  constexpr ClassId chair = 5, table = 7, wall = 1;
  RenderedFrame truth = blank_frame(2.0F);
  paint_box(truth, 0, 0, 639, 479, wall, 1);       // not a COCO class: background
  paint_box(truth, 100, 100, 299, 249, table, 2);  // box 100..299 x 100..249
  paint_box(truth, 150, 150, 179, 299, chair, 3);  // smaller: on top of the table
  paint_box(truth, 400, 50, 408, 60, chair, 4);    // 9 x 11 = 99 px: too small to be seen
  paint_box(truth, 500, 50, 509, 59, chair, 5);    // 100 px: just large enough
  paint_box(truth, 600, 300, 604, 319, table, 6);  // one object in two parts of 100 px each:
  paint_box(truth, 620, 400, 624, 419, table, 6);  // one box around both parts
  const SemanticImage image = label_image(truth, LabelMode::kBoxes);
  const auto expected = [&](int x, int y) -> ClassId {
    const auto within = [&](int l, int t, int r, int b) {
      return x >= l && x <= r && y >= t && y <= b;
    };
    if (within(150, 150, 179, 299) || within(500, 50, 509, 59)) return chair;
    if (within(100, 100, 299, 249) || within(600, 300, 624, 419)) return table;
    return kBackground;
  };
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 0; x < kCamera.width_px; ++x)
      ASSERT_EQ(image.at(x, y), ClassDistribution::one_hot(expected(x, y))) << x << " " << y;
}

TEST(LabelImage, SmallerBoxesLieOverLargerOnesWhateverTheirIds) {
  RenderedFrame truth = blank_frame(2.0F);
  paint_box(truth, 0, 0, 400, 400, 6, 9);      // sofa
  paint_box(truth, 100, 100, 200, 200, 4, 3);  // bed inside the sofa's box, lower id
  EXPECT_EQ(label_image(truth, LabelMode::kBoxes).at(150, 150).most_probable(), 4);
  paint_box(truth, 0, 0, 400, 400, 6, 3);
  paint_box(truth, 100, 100, 200, 200, 4, 9);
  EXPECT_EQ(label_image(truth, LabelMode::kBoxes).at(150, 150).most_probable(), 4);
}

std::filesystem::path level(const std::string& name) {
  return std::filesystem::path(MH_SOURCE_DIR) / "sim/sensors/levels" / (name + ".yaml");
}

// Results identify a level by its digest, and comparisons under the same name must mean the same. A
// changed level is a new level: say so in CHANGELOG.md, and discard earlier measurements.
TEST(SensorLevels, AreFrozen) {
  const auto digest = [](const std::string& name) {
    const std::string text = read_file(level(name));
    return XXH3_64bits(text.data(), text.size());
  };
  EXPECT_EQ(digest("ideal"), 0x5cb9218b63b90e92U);
  EXPECT_EQ(digest("pepper"), 0xbd5d2f49a473fb63U);
  EXPECT_EQ(digest("handheld"), 0x202805d426fa97fcU);
}

TEST(SensorLevels, SayWhatTheirNamesSay) {
  const SensorConfig ideal = load_sensor_config(level("ideal"));
  EXPECT_FALSE(ideal.depth_noise.enabled || ideal.color_noise.enabled || ideal.shot_noise.enabled ||
               ideal.motion_blur.enabled || ideal.rolling_shutter.enabled ||
               ideal.auto_exposure.enabled || ideal.vignetting.enabled ||
               ideal.lens_distortion.enabled || ideal.processing.enabled ||
               ideal.lens_blur.enabled || ideal.depth_offset.enabled || ideal.depth_bias.enabled ||
               ideal.blank_frames.enabled || ideal.dropped_frames.enabled);
  EXPECT_EQ(ideal, exact_sensors());

  const SensorConfig pepper = load_sensor_config(level("pepper"));
  const DepthNoiseConfig& d = pepper.depth_noise;
  EXPECT_TRUE(pepper.depth_noise.enabled && d.axial && d.lateral && d.quantization &&
              d.grazing_holes && d.projector_shadow);
  EXPECT_EQ(d.min_range_m, 0.4);
  EXPECT_EQ(d.max_range_m, 8.0);
  EXPECT_TRUE(pepper.shot_noise.enabled && !pepper.color_noise.enabled);
  EXPECT_EQ(pepper.shot_noise.well_e, 3981.0);
  EXPECT_FALSE(pepper.motion_blur.enabled || pepper.rolling_shutter.enabled);

  const SensorConfig handheld = load_sensor_config(level("handheld"));
  EXPECT_TRUE(handheld.depth_noise.enabled && handheld.shot_noise.enabled &&
              handheld.auto_exposure.enabled && handheld.motion_blur.enabled &&
              handheld.rolling_shutter.enabled);
  EXPECT_GT(handheld.shot_noise.gain_at_exposure, 0);
  EXPECT_EQ(pepper.shot_noise.gain_at_exposure, 0);
  EXPECT_TRUE(handheld.processing.contrast > 0 && handheld.processing.sharpening > 0);
  EXPECT_EQ(pepper.processing.contrast + pepper.processing.sharpening, 0.0);
}

/// Expects that the output of format_sensor_config() is read back equal.
void expect_round_trip(const SensorConfig& config) {
  for (const bool notes : {false, true})
    EXPECT_EQ(parse_sensor_config(format_sensor_config(config, notes), "level"), config);
}

TEST(SensorLevels, WhatIsPrintedIsReadBackEqual) {
  for (const char* name : {"ideal", "pepper", "handheld"}) {
    const SensorConfig config = load_sensor_config(level(name));
    expect_round_trip(config);
    EXPECT_EQ(config == SensorConfig{}, false) << name;
  }
  expect_round_trip({});
}

/// Gives each field a different value within its range.
struct OtherValues {
  void section(const char*) {}
  void operator()(const char*, bool& value, const SettingRange&, const char*) { value = !value; }
  template <class T>
  void operator()(const char*, T& value, const SettingRange& range, const char*) {
    value = static_cast<T>(range.min + (range.max - range.min) / ++divisor);
  }
  int divisor = 2;
};

TEST(SensorLevels, EveryFieldIsWrittenAndReadBackEqual) {
  SensorConfig config;
  for_each_setting(config, OtherValues{});
  config.depth_noise.min_range_m = 0.1 * config.depth_noise.max_range_m;
  expect_round_trip(config);
}

TEST(SensorLevels, ASectionThatIsThereIsOnUnlessItSaysOtherwise) {
  const std::string needed = "depth_noise: {}\ncolor_noise: {}\n";
  const SensorConfig absent = parse_sensor_config(needed, "level");
  EXPECT_EQ(absent, SensorConfig{});
  EXPECT_FALSE(absent.vignetting.enabled);
  EXPECT_TRUE(parse_sensor_config(needed + "vignetting: {}\n", "level").vignetting.enabled);
  const SensorConfig off =
      parse_sensor_config(needed +
                              "motion_blur: {enabled: false, exposure_ms: 5}\n"
                              "label_noise: {enabled: false, dropout: 1, seed: 3}\n"
                              "blank_frames: {enabled: false, share: 1}\n",
                          "level");
  EXPECT_EQ(off.motion_blur.exposure_s(), 0);
  EXPECT_EQ(off.blank_frames.lost(), 0);
  EXPECT_TRUE(off.labels.noise.none());
  EXPECT_EQ(off.labels.seed, 3U);  // the detector uses it, too
}

/// A number in a level: its place in the file, its range and the field that it sets.
struct LevelNumber {
  std::string section, key;
  double low, high;
  bool above = false;  ///< the low end itself is not allowed
  std::string beside;  ///< what else the section needs, such as "sigma_px: 1, "
  std::function<double(const SensorConfig&)> value;
  double unit = 1;  ///< one unit of the file, in our unit
};

std::vector<LevelNumber> level_numbers() {
  using C = SensorConfig;
  return {
      {"color_noise", "sigma", 0, 1, false, "", [](const C& c) { return c.color_noise.sigma; }},
      {"shot_noise", "well_e", 0, 1e7, true, "", [](const C& c) { return c.shot_noise.well_e; }},
      {"shot_noise", "read_noise_e", 0, 1e6, false, "",
       [](const C& c) { return c.shot_noise.read_noise_e; }},
      {"shot_noise", "gain", 1, 1000, false, "", [](const C& c) { return c.shot_noise.gain; }},
      {"shot_noise", "gain_at_exposure", 0, 1e6, false, "",
       [](const C& c) { return c.shot_noise.gain_at_exposure; }},
      {"auto_exposure", "target", 0, 1, true, "",
       [](const C& c) { return c.auto_exposure.target; }},
      {"auto_exposure", "time_constant_s", 0, 60, false, "",
       [](const C& c) { return c.auto_exposure.time_constant_s; }},
      {"auto_exposure", "max_gain", 1, 1000, false, "",
       [](const C& c) { return c.auto_exposure.max_gain; }},
      {"vignetting", "strength", 0, 1, false, "", [](const C& c) { return c.vignetting.strength; }},
      {"lens_blur", "sigma_px", 0, 20, false, "", [](const C& c) { return c.lens_blur.sigma_px; }},
      {"processing", "contrast", 0, 1, false, "", [](const C& c) { return c.processing.contrast; }},
      {"processing", "sharpening", 0, 20, false, "",
       [](const C& c) { return c.processing.sharpening; }},
      {"processing", "sharpening_px", 0, 20, true, "",
       [](const C& c) { return c.processing.sharpening_px; }},
      {"lens_distortion", "k1", -2, 2, false, "",
       [](const C& c) { return c.lens_distortion.lens.k1; }},
      {"lens_distortion", "k2", -2, 2, false, "",
       [](const C& c) { return c.lens_distortion.lens.k2; }},
      {"lens_distortion", "p1", -0.2, 0.2, false, "",
       [](const C& c) { return c.lens_distortion.lens.p1; }},
      {"lens_distortion", "p2", -0.2, 0.2, false, "",
       [](const C& c) { return c.lens_distortion.lens.p2; }},
      {"lens_distortion", "k3", -2, 2, false, "",
       [](const C& c) { return c.lens_distortion.lens.k3; }},
      {"motion_blur", "exposure_ms", 0, 1000, false, "",
       [](const C& c) { return c.motion_blur.exposure_s(); }, 1e-3},
      {"rolling_shutter", "readout_ms", 0, 1000, false, "",
       [](const C& c) { return c.rolling_shutter.readout_s(); }, 1e-3},
      {"depth_offset", "offset_ms", -1000, 1000, false, "",
       [](const C& c) { return c.depth_offset.offset_s(); }, 1e-3},
      {"depth_bias", "scale", 0.5, 2, false, "", [](const C& c) { return c.depth_bias.scale; }},
      {"depth_bias", "bend", 0, 0.2, false, "", [](const C& c) { return c.depth_bias.bend; }},
      {"depth_bias", "shift_x_px", -50, 50, false, "",
       [](const C& c) { return c.depth_bias.shift_x_px; }},
      {"depth_bias", "shift_y_px", -50, 50, false, "",
       [](const C& c) { return c.depth_bias.shift_y_px; }},
      {"blank_frames", "share", 0, 1, false, "", [](const C& c) { return c.blank_frames.lost(); }},
      {"dropped_frames", "share", 0, 1, false, "",
       [](const C& c) { return c.dropped_frames.lost(); }},
      {"label_noise", "confusion", 0, 1, false, "",
       [](const C& c) { return c.labels.noise.confusion; }},
      {"label_noise", "swap", 0, 1, false, "", [](const C& c) { return c.labels.noise.swap; }},
      {"label_noise", "dropout", 0, 1, false, "",
       [](const C& c) { return c.labels.noise.dropout; }},
      {"label_noise", "persistent_share", 0, 1, false, "frame_share: 0, ",
       [](const C& c) { return c.labels.persistent_share; }},
      {"label_noise", "frame_share", 0, 1, false, "persistent_share: 0, ",
       [](const C& c) { return c.labels.frame_share; }},
      {"detector", "recall_small", 0, 1, false, "",
       [](const C& c) { return c.labels.detector.recall_small; }},
      {"detector", "recall_medium", 0, 1, false, "",
       [](const C& c) { return c.labels.detector.recall_medium; }},
      {"detector", "recall_large", 0, 1, false, "",
       [](const C& c) { return c.labels.detector.recall_large; }},
      {"light", "share", 0, 1, false, "", [](const C& c) { return c.light.share; }},
      {"lens_dirt", "share", 0, 1, false, "", [](const C& c) { return c.lens_dirt.share; }},
      {"depth_faults", "noise", 0, 1000, false, "",
       [](const C& c) { return c.depth_faults.noise; }},
      {"depth_faults", "edges", 0, 100, false, "", [](const C& c) { return c.depth_faults.edges; }},
      {"depth_faults", "holes", 0, 1, false, "", [](const C& c) { return c.depth_faults.holes; }},
      {"feed", "stuck", 0, 1, false, "", [](const C& c) { return c.feed.stuck; }},
      {"feed", "jitter_ms", 0, 1000, false, "", [](const C& c) { return c.feed.jitter_ms; }},
      {"told", "focal", 0.2, 5, false, "", [](const C& c) { return c.told.focal; }},
      {"told", "center_px", -1000, 1000, false, "", [](const C& c) { return c.told.center_px; }},
      {"told", "k1", -1, 1, false, "", [](const C& c) { return c.told.k1; }},
      {"detector", "confusion", 0, 1, false, "",
       [](const C& c) { return c.labels.detector.confusion; }},
      {"detector", "false_alarms", 0, 8, false, "",
       [](const C& c) { return c.labels.detector.false_alarms; }},
      {"detector", "box_sigma", 0, 1, false, "",
       [](const C& c) { return c.labels.detector.box_sigma; }}};
}

TEST(SensorLevels, EachNumberGoesToItsPlaceAndItsRangeEndsWhereItShould) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "modelhouse_level_ends.yaml";
  for (const LevelNumber& n : level_numbers()) {
    const auto loaded = [&](double value) -> std::optional<double> {
      std::string text = "depth_noise: {}\n";
      if (n.section != "color_noise") text += "color_noise: {sigma: 0.01}\n";
      text += fmt::format("{}: {{{}{}: {}}}\n", n.section, n.beside, n.key, value);
      write_atomically(file, text);
      try {
        return n.value(load_sensor_config(file));
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(n.key), std::string::npos) << error.what();
        return std::nullopt;
      }
    };
    const std::string name = n.section + "." + n.key;
    const double first = n.above ? std::nextafter(n.low, n.high) : n.low;
    for (const double value : {first, n.low + 0.375 * (n.high - n.low), n.high}) {
      ASSERT_TRUE(loaded(value)) << name << " " << value;
      EXPECT_DOUBLE_EQ(*loaded(value), n.unit * value) << name;
    }
    EXPECT_FALSE(loaded(std::nextafter(n.high, HUGE_VAL))) << name;
    EXPECT_FALSE(loaded(n.above ? n.low : std::nextafter(n.low, -HUGE_VAL))) << name;
  }
  std::filesystem::remove(file);
}

TEST(SensorLevels, BadFilesAreNamedWithLineAndValue) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "modelhouse_bad_level.yaml";
  const auto message = [&](const std::string& text) -> std::string {
    write_atomically(file, text);
    try {
      load_sensor_config(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string color = "color_noise: {sigma: 0.01}\n";
  EXPECT_NE(message("depth_noise: {wobble: true}\n" + color).find("wobble"), std::string::npos);
  EXPECT_NE(message("depth_noise: {axial: 3}\n" + color).find(":1:"), std::string::npos);
  EXPECT_NE(message("depth_noise: {min_range_m: 2, max_range_m: 1}\n" + color).find("max_range_m"),
            std::string::npos);
  EXPECT_NE(message("depth_noise: {}\ncolor_noise: {sigma: -1}\n").find("-1"), std::string::npos);
  EXPECT_NE(message("depth_noise: {}\n").find("color_noise"), std::string::npos);
  EXPECT_EQ(message("depth_noise: {}\n" + color), "accepted");
  // Each fault in its own section: what the message must contain, and for which line.
  const std::string both = "depth_noise: {}\n" + color;
  const auto third_line = [&](const std::string& text, const std::string& named) {
    const std::string reported = message(both + text + "\n");
    EXPECT_NE(reported.find(":3:"), std::string::npos) << reported;
    EXPECT_NE(reported.find(named), std::string::npos) << reported;
  };
  third_line("motion_blur: {exposure_s: 0.02}", "exposure_s");
  third_line("motion_blur: {exposure_ms: -1}", "exposure_ms: -1 is outside [0, 1000]");
  third_line("motion_blur: {exposure_ms: 2000}", "2000");
  third_line("rolling_shutter: {readout_ms: -1}", "-1");
  third_line("shot_noise: {well_e: 0}", "well_e");
  third_line("shot_noise: {gain: 0.5}", "0.5");
  third_line("shot_noise: {gain_at_exposure: -1}", "-1");
  third_line("auto_exposure: {target: 2}", "2");
  third_line("vignetting: {strength: 1.5}", "1.5");
  third_line("lens_blur: {sigma_px: -1}", "-1");
  third_line("processing: {contrast: 2}", "2");
  third_line("processing: {sharpening: -1}", "-1");
  third_line("processing: {sharpening_px: 0}", "sharpening_px");
  third_line("lens_distortion: {k1: 7}", "7");
  third_line("lens_distortion: {k9: 0}", "k9");
  third_line("depth_offset: {enabled: true}", "offset_ms");
  third_line("blank_frames: {share: 1.1}", "1.1");
  third_line("dropped_frames: {rate: 0.1}", "share");
  third_line("label_noise: {confusion: -0.1}", "-0.1");
  third_line("label_noise: {erosion_px: 2.5}", "2.5");
  third_line("label_noise: {class_set: six}", "six");
  third_line("label_noise: {persistent_share: 0.8, frame_share: 0.4}", "frame_share");
  third_line("detector: {recall: 1}", "recall");
  third_line("fog: {enabled: true}", "fog");
  third_line("lens_blurr: {sigma_px: 1}", "lens_blur'");
  third_line("lens_blur: {sigma: 1}", "is 'sigma' a typo for it");
  EXPECT_EQ(message(both + "motion_blur: {enabled: false, exposure_ms: 5}\nvignetting: {}\n"),
            "accepted");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace mh
