// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/render/color.hpp"
#include "sim/sensors/lens.hpp"
#include "sim/sensors/processing.hpp"
#include "sim/sensors/sense.hpp"

namespace mh {
namespace {

RenderedFrame gray_frame(std::uint8_t gray, const Camera& camera = {}) {
  const int w = camera.width_px, h = camera.height_px;
  return {{w, h, {gray, gray, gray}}, {w, h, 2.0F}, {w, h, 1}, {w, h, 1}};
}

SensorConfig nothing() {
  SensorConfig config;
  config.depth_noise.enabled = config.color_noise.enabled = false;
  return config;
}

struct ColorMoments {
  double n = 0, sum = 0, square = 0;
  void add(double x) { n += 1, sum += x, square += x * x; }
  double mean() const { return sum / n; }
  double sigma() const { return std::sqrt(square / n - mean() * mean()); }
};

ColorMoments light_of(const Grid2d<Rgb8>& color) {
  ColorMoments moments;
  for (const Rgb8& c : color) moments.add(srgb_to_linear(c.g));
  return moments;
}

TEST(ShotNoise, SignalToNoiseIsThatOfTheElectrons) {
  for (const double gain : {1.0, 8.0})
    for (const int gray : {60, 118, 188}) {
      SensorConfig config = nothing();
      config.shot_noise.enabled = true;
      config.shot_noise.gain = gain;
      const RenderedFrame truth = gray_frame(static_cast<std::uint8_t>(gray));
      const ColorMoments seen = light_of(sense(truth, {}, config, RandomStream(1), 0).color);
      const double light = srgb_to_linear(static_cast<std::uint8_t>(gray));
      const double well = 3981.0 / gain, electrons = light * well;
      const double sigma = std::sqrt(electrons + 1.6 * 1.6) / well;
      // Rounding to 8 bits adds a twelfth of a gray level squared to the variance.
      const double level = srgb_to_linear(static_cast<std::uint8_t>(gray + 1)) - light;
      const double rounded = std::sqrt(sigma * sigma + level * level / 12.0);
      EXPECT_NEAR(seen.sigma(), rounded, 0.02 * rounded) << gray << " at gain " << gain;
      EXPECT_NEAR(seen.mean(), light, 0.01 * light) << gray << " at gain " << gain;
    }
  // The published figures: 36 dB at a full well, 68 dB between a full well and the read noise.
  const ShotNoiseConfig published;
  EXPECT_NEAR(20.0 * std::log10(std::sqrt(published.well_e)), 36.0, 0.05);
  EXPECT_NEAR(20.0 * std::log10(published.well_e / published.read_noise_e), 68.0, 0.2);
}

TEST(ShotNoise, DarkerScenesTakeMoreGain) {
  SensorConfig config = nothing();
  config.shot_noise.enabled = true;
  config.shot_noise.gain = 2.0;
  RenderedFrame truth = gray_frame(118);
  const auto taken = [&](float exposure) {
    truth.exposure = exposure;
    return sense(truth, {}, config, RandomStream(1), 0).color;
  };
  EXPECT_EQ(taken(3.0F), taken(0.5F));  // the exposure has no effect by default
  config.shot_noise.gain_at_exposure = 0.5;
  const auto at_gain = [&](double gain) {
    SensorConfig plain = config;
    plain.shot_noise = {.enabled = true, .gain = gain};
    return sense(truth, {}, plain, RandomStream(1), 0).color;
  };
  EXPECT_EQ(taken(0.5F), at_gain(2.0));
  EXPECT_EQ(taken(1.5F), at_gain(6.0));
  EXPECT_EQ(taken(0.01F), at_gain(1.0));
  EXPECT_EQ(taken(0.0F), at_gain(2.0));  // unknown exposure
}

TEST(Vignetting, FallsOffWithTheFourthPowerOfTheCosine) {
  SensorConfig config = nothing();
  config.vignetting.enabled = true;
  const Camera camera;
  const RgbdFrame frame = sense(gray_frame(200), camera, config, RandomStream(1), 0);
  const double light = srgb_to_linear(200);
  for (const auto& [x, y] : {std::pair(319, 239), std::pair(0, 0), std::pair(600, 100)}) {
    const double cosine = camera.unproject(x, y, 1.0).normalized().z();
    const double expected = light * std::pow(cosine, 4);
    EXPECT_NEAR(srgb_to_linear(frame.color(x, y).r), expected, 0.006) << x << " " << y;
  }
  config.vignetting.strength = 0.0;
  EXPECT_EQ(sense(gray_frame(200), camera, config, RandomStream(1), 0).color(0, 0),
            (Rgb8{200, 200, 200}));
}

TEST(Gain, MultipliesLinearLight) {
  const RgbdFrame frame = sense(gray_frame(100), {}, nothing(), RandomStream(1), 0, 2.0);
  EXPECT_NEAR(srgb_to_linear(frame.color(5, 5).g), 2.0 * srgb_to_linear(100), 0.004);
  EXPECT_EQ(sense(gray_frame(250), {}, nothing(), RandomStream(1), 0, 2.0).color(5, 5).g, 255);
}

Camera pepper_top() {
  Camera camera;  // naoqi_driver's calibration of Pepper's upper camera
  camera.fx_px = 556.845, camera.fy_px = 555.899;
  camera.cx_px = 309.367, camera.cy_px = 230.592;
  camera.distortion = {-0.05452, 0.06920, -0.00241, -0.00112, 0.0};
  return camera;
}

TEST(Lens, UndistortingIsTheInverseOfDistorting) {
  Camera strong = pepper_top();
  strong.distortion = {-0.3, 0.1, 0.002, -0.001, -0.01};
  Camera rational = pepper_top();
  rational.distortion = {0.5286, -2.6450, 0.00082, -0.00022, 1.5006, 0.4073, -2.4695, 1.4282};
  for (const Camera& camera : {pepper_top(), strong, rational})
    for (int y = 0; y < 480; y += 60)
      for (int x = 0; x < 640; x += 60) {
        const Eigen::Vector2d back = distort_px(camera, undistort_px(camera, {x, y}));
        ASSERT_NEAR(back.x(), x, 1e-6);
        ASSERT_NEAR(back.y(), y, 1e-6);
      }
}

TEST(Lens, EveryPixelShowsWhatItsRayMeets) {
  Camera camera = pepper_top();
  camera.distortion = {-0.25, 0.05, 0.001, -0.002, 0.0};
  const Lens lens(camera);
  const Camera& wide = lens.pinhole();
  EXPECT_GT(wide.width_px,
            camera.width_px);  // barrel distortion brings in what is outside the image
  // An image that encodes the directions of its rays.
  RenderedFrame image = gray_frame(0, wide);
  for (int y = 0; y < wide.height_px; ++y)
    for (int x = 0; x < wide.width_px; ++x) {
      image.depth_m(x, y) = static_cast<float>(3.0 + wide.unproject(x, y, 1.0).x());
      image.color(x, y).g = static_cast<std::uint8_t>(128 + 90 * wide.unproject(x, y, 1.0).y());
    }
  image.exposure = 0.7F;
  const RenderedFrame bent = lens.bend(image);
  EXPECT_EQ(bent.exposure, 0.7F);
  ASSERT_EQ(bent.color.width(), camera.width_px);
  for (int y = 0; y < 480; y += 7)
    for (int x = 0; x < 640; x += 7) {
      const Eigen::Vector2d ray = undistort_px(camera, {x, y});
      ASSERT_NEAR(bent.depth_m(x, y), 3.0 + ray.x(), 0.51 / camera.fx_px + 1e-5);
      ASSERT_NEAR(bent.color(x, y).g, 128 + 90 * ray.y(), 1.1);
    }
}

TEST(Lens, WithoutDistortionNothingChanges) {
  const Lens lens{Camera{}};
  EXPECT_EQ(lens.pinhole(), Camera{});
  const RenderedFrame image = gray_frame(77);
  EXPECT_EQ(lens.bend(image).color, image.color);
}

TEST(LensBlur, SpreadsAPointByItsSigmaAndLosesNoLight) {
  for (const double sigma : {0.7, 2.0}) {
    Grid2d<Rgb8> color(61, 41);
    // A block of 9 x 9 pixels instead of a single one, so that 8 bits suffice: its own variance is
    // (81 - 1) / 12.
    for (int y = 16; y <= 24; ++y)
      for (int x = 26; x <= 34; ++x) color(x, y) = {255, 255, 255};
    blur_by_lens(color, sigma);
    double sum = 0, mean = 0, square = 0;
    for (int y = 0; y < 41; ++y)
      for (int x = 0; x < 61; ++x) {
        const double light = srgb_to_linear(color(x, y).g);
        sum += light, mean += light * x, square += light * x * x;
      }
    EXPECT_NEAR(sum, 81.0, 0.3);
    EXPECT_NEAR(mean / sum, 30.0, 1e-6);
    EXPECT_NEAR(square / sum - 900.0, 80.0 / 12.0 + sigma * sigma, 0.04 * sigma * sigma + 0.02);
  }
}

TEST(LensBlur, AnEvenImageStaysAndZeroIsNothing) {
  Grid2d<Rgb8> even(20, 20, {90, 140, 200});
  blur_by_lens(even, 1.5);
  EXPECT_EQ(even, Grid2d<Rgb8>(20, 20, {90, 140, 200}));
  Grid2d<Rgb8> edge(20, 20);
  edge(3, 3) = {255, 0, 0};
  const Grid2d<Rgb8> before = edge;
  blur_by_lens(edge, 0.0);
  EXPECT_EQ(edge, before);
}

TEST(Processing, SharpensEachFrequencyAsAnUnsharpMaskDoes) {
  for (const double sigma : {0.65, 1.0, 2.0})
    for (const int period : {4, 8, 20}) {
      Grid2d<Rgb8> color(160, 60);
      const double step = 2.0 * std::numbers::pi / period;
      const auto wave = [&](int x) { return std::sin(step * (x + 0.5)); };
      for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 160; ++x) {
          const auto v = static_cast<std::uint8_t>(std::lround(128 + 30 * wave(x)));
          color(x, y) = {v, v, v};
        }
      const auto amplitude = [&] {
        double sum = 0;  // 40 to 119: whole periods, away from the borders
        for (int x = 40; x < 120; ++x) sum += (color(x, 30).g - 128.0) * wave(x);
        return sum;
      };
      const double before = amplitude();
      process(color, {.sharpening = 1.5, .sharpening_px = sigma});
      const double passed = std::exp(-2.0 * std::pow(std::numbers::pi * sigma / period, 2));
      // Rounding may cost 1 %: all samples of a short wave may be rounded by the same half gray
      // level, and its amplitude is at least 50.
      EXPECT_NEAR(amplitude() / before, 1 + 1.5 * (1 - passed), 0.02) << sigma << " " << period;
    }
}

TEST(Processing, AStepOvershootsAsMuchOnBothSidesAndOnlyNearIt) {
  Grid2d<Rgb8> color(40, 40, {100, 110, 120});
  for (int y = 20; y < 40; ++y)
    for (int x = 0; x < 40; ++x) color(x, y) = {140, 150, 160};
  process(color, {.sharpening = 0.5, .sharpening_px = 1.0});
  // For the first row after a step of 40, half of the weight outside the central row lies on the
  // other side of the step.
  const double middle = 1.0 / (1 + 2 * (std::exp(-0.5) + std::exp(-2.0) + std::exp(-4.5)));
  const int over = static_cast<int>(std::lround(0.5 * 40 * 0.5 * (1 - middle)));
  EXPECT_NEAR(color(20, 20).r, 140 + over, 1);
  EXPECT_EQ(color(20, 20).r - 140, 100 - color(20, 19).r);
  for (int y = 0; y < 40; ++y) {
    EXPECT_EQ(color(7, y), color(30, y));
    EXPECT_EQ(color(7, y).g - color(7, y).r, 10);  // the color does not change
    EXPECT_EQ(color(7, y).b - color(7, y).g, 10);
  }
  EXPECT_EQ(color(20, 15), (Rgb8{100, 110, 120}));
  EXPECT_EQ(color(20, 24), (Rgb8{140, 150, 160}));
}

TEST(Processing, AnEvenImageStaysAndNoneIsNothing) {
  Grid2d<Rgb8> even(20, 20, {90, 140, 255});
  process(even, {.sharpening = 3.0, .sharpening_px = 0.7});
  EXPECT_EQ(even, Grid2d<Rgb8>(20, 20, {90, 140, 255}));
  Grid2d<Rgb8> edge(20, 20);
  edge(3, 3) = {255, 0, 0};
  const Grid2d<Rgb8> before = edge;
  process(edge, {});
  EXPECT_EQ(edge, before);
}

TEST(Processing, ItsToneCurveKeepsBothEndsAndSteepensTheMiddle) {
  Grid2d<Rgb8> grays(256, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 256; ++x) {
      const auto v = static_cast<std::uint8_t>(x);
      grays(x, y) = {v, v, v};
    }
  process(grays, {.contrast = 0.5});
  EXPECT_EQ(grays(0, 1).g, 0);
  EXPECT_EQ(grays(255, 1).g, 255);
  // At a quarter of full scale, the S-curve is 3/16 - 1/32 = 5/32; the output is the mean of that
  // and the input.
  EXPECT_NEAR(grays(64, 1).g, 255 * 0.5 * (0.25 + 5.0 / 32.0), 1.0);
  EXPECT_NEAR(grays(148, 1).g - grays(108, 1).g, 1.25 * 40, 1.0);
  for (int x = 0; x < 255; ++x) EXPECT_LE(grays(x, 1).g, grays(x + 1, 1).g);
}

TEST(Processing, ComesAfterTheNoise) {
  const RenderedFrame truth = gray_frame(120, {});
  const auto sensed = [&](const SensorConfig& config) {
    return sense(truth, {}, config, RandomStream(3), 0).color;
  };
  SensorConfig config = nothing();
  config.shot_noise.enabled = true;
  Grid2d<Rgb8> noisy = sensed(config);
  config.processing = {.enabled = true, .contrast = 0.5, .sharpening = 1.0};
  const Grid2d<Rgb8> sharp = sensed(config);
  EXPECT_NE(sharp, noisy);
  process(noisy, config.processing);
  EXPECT_EQ(sharp, noisy);
}

TEST(BlankFrames, ComeAtTheirRateWithoutDepthColorAndLabels) {
  Camera small;
  small.width_px = 32, small.height_px = 24, small.cx_px = 15.5, small.cy_px = 11.5;
  SensorConfig config = nothing();
  config.blank_frames = {.enabled = true, .share = 0.25};
  const RenderedFrame truth = gray_frame(120, small);
  int blank = 0;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    const RandomStream stream = RandomStream(1).fork(i);
    const RgbdFrame frame = sense(truth, small, config, stream, 0);
    const SemanticImage labels = sense_labels(truth, LabelMode::kExact, config, SE3(), stream);
    const bool dark = frame.color(3, 3) == Rgb8{};
    ASSERT_EQ(dark, frame.depth_m(3, 3) == 0.0F);
    ASSERT_EQ(dark, labels.index.empty());
    blank += dark;
  }
  EXPECT_NEAR(blank, 1000, 4.0 * std::sqrt(4000 * 0.25 * 0.75));
}

}  // namespace
}  // namespace mh
