// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/develop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "sim/render/color.hpp"
#include "sim/sensors/jpeg.hpp"
#include "sim/sensors/lens_dirt.hpp"
#include "sim/sensors/normal_table.hpp"
#include "sim/sensors/processing.hpp"

namespace mh {
namespace {

enum DevelopStream : std::uint64_t { kShot = 1, kFlicker = 2 };

/// Linear light of an 8-bit value and the standard deviation of its noise.
struct Signal {
  float light, sigma;
};

/// @param brightness  share of the light that reaches the sensor
std::array<Signal, 256> signal_table(const SensorConfig& config, double brightness) {
  const double well_e = config.shot_noise.well_e / config.shot_noise.gain;
  std::array<Signal, 256> table{};
  for (std::size_t v = 0; v < table.size(); ++v) {
    const double light = brightness * srgb_to_linear(static_cast<std::uint8_t>(v));
    const double read = config.shot_noise.read_noise_e / well_e;
    const double sigma = config.shot_noise.enabled ? std::sqrt(light / well_e + read * read) : 0.0;
    table[v] = {static_cast<float>(light), static_cast<float>(sigma)};
  }
  return table;
}

/// Computes the fraction of the light that reaches each pixel of row y.
void fall_off(const Camera& camera, double strength, int y, std::vector<float>& share) {
  const auto b = static_cast<float>((y - camera.cy_px) / camera.fy_px);
  const auto s = static_cast<float>(strength);
  for (std::size_t x = 0; x < share.size(); ++x) {
    const auto a = static_cast<float>((static_cast<double>(x) - camera.cx_px) / camera.fx_px);
    const float cosine_squared = 1.0F / (1.0F + a * a + b * b);
    share[x] = 1.0F - s * (1.0F - cosine_squared * cosine_squared);
  }
}

/// The light of a frame relative to the scene's.
double brightness_of(const LightConfig& config, RandomStream stream) {
  if (!config.enabled) return 1.0;
  const double phase = 2 * std::numbers::pi * stream.uniform(0);
  return config.share * (1.0 + config.flicker * std::sin(phase));
}

void expose(Grid2d<Rgb8>& color, const Camera& camera, const SensorConfig& config, double gain,
            double brightness, RandomStream stream) {
  const std::array<Signal, 256> signals = signal_table(config, brightness);
  const Grid2d<float> dirt = config.lens_dirt.enabled
                                 ? light_through(config.lens_dirt, color.width(), color.height())
                                 : Grid2d<float>();
  const auto& normals = normal_table();
  const std::uint8_t* encode = kSrgbTable.data();
  const auto scale = static_cast<float>(gain * kSrgbTableMax);
  std::vector<float> share(static_cast<std::size_t>(color.width()), 1.0F);
  std::uint64_t pixel = 0;
  for (int y = 0; y < color.height(); ++y) {
    if (config.vignetting.enabled) fall_off(camera, config.vignetting.strength, y, share);
    if (!dirt.empty()) {
      if (!config.vignetting.enabled) std::ranges::fill(share, 1.0F);
      std::ranges::transform(share, dirt.row(y), share.begin(), std::multiplies<>());
    }
    const float* lit = share.data();
    for (Rgb8& c : color.row(y)) {
      const std::uint64_t bits = stream.bits(pixel++);
      // Less light through the lens has less noise: sigma is proportional to the square root of the
      // share.
      const float factor = scale * *lit, noise_factor = scale * std::sqrt(*lit);
      ++lit;
      const auto read = [&](std::uint8_t value, int k) {
        const Signal& s = signals[value];
        const float normal = normals[(bits >> (kNormalBits * k)) & kNormalMask];
        const float level = factor * s.light + noise_factor * s.sigma * normal + 0.5F;
        return encode[static_cast<std::size_t>(
            std::clamp(level, 0.0F, static_cast<float>(kSrgbTableMax)))];
      };
      c = {read(c.r, 0), read(c.g, 1), read(c.b, 2)};
    }
  }
}

void add_gray_noise(Grid2d<Rgb8>& color, double sigma, RandomStream stream) {
  // In units of 1/256 gray level, an entry for each of the equally probable normal numbers.
  std::array<int, 1 << kNormalBits> noise;
  std::transform(normal_table().begin(), normal_table().end(), noise.begin(), [&](float normal) {
    return static_cast<int>(std::lrint(256.0 * 255.0 * sigma * normal));
  });
  const auto add = [&](std::uint8_t value, std::uint64_t bits) {
    const int sum = (256 * value + noise[bits & kNormalMask] + 128) >> 8;
    return static_cast<std::uint8_t>(std::clamp(sum, 0, 255));
  };
  for (std::size_t i = 0; i < color.size(); ++i) {
    const std::uint64_t bits = stream.bits(i);
    Rgb8& c = color.data()[i];
    c = {add(c.r, bits), add(c.g, bits >> kNormalBits), add(c.b, bits >> (2 * kNormalBits))};
  }
}

}  // namespace

double analog_gain(const ShotNoiseConfig& config, float exposure) {
  if (config.gain_at_exposure <= 0.0 || exposure <= 0.0F) return config.gain;
  return std::max(1.0, config.gain * static_cast<double>(exposure) / config.gain_at_exposure);
}

void develop(Grid2d<Rgb8>& color, const Camera& camera, const SensorConfig& config, double gain,
             RandomStream stream) {
  const double brightness = brightness_of(config.light, stream.fork(kFlicker));
  const bool dirty = config.lens_dirt.enabled && config.lens_dirt.share > 0;
  if (config.shot_noise.enabled || config.vignetting.enabled || gain != 1.0 || brightness != 1.0 ||
      dirty)
    expose(color, camera, config, gain, brightness, stream.fork(kShot));
  if (config.color_noise.enabled) add_gray_noise(color, config.color_noise.sigma, stream);
  if (config.processing.enabled) process(color, config.processing);
  if (config.jpeg.enabled && config.jpeg.loss > 0) compress(color, 100 - config.jpeg.loss);
}

}  // namespace mh
