// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <cmath>

#include "sim/sensors/depth_noise.hpp"
#include "sim/sensors/normal_table.hpp"
#include "sim/sensors/sensors.hpp"

namespace mh {
namespace {

// Names of random streams.
constexpr std::uint64_t kDepthStream = 1, kColourStream = 2;

void add_colour_noise(Grid2d<Rgb8>& colour, double sigma, RandomStream stream) {
  // Grey levels in 1/256: one table entry per equally probable normal number.
  std::array<int, 1 << kNormalBits> noise;
  std::transform(normal_table().begin(), normal_table().end(), noise.begin(), [&](float normal) {
    return static_cast<int>(std::lrint(256.0 * 255.0 * sigma * normal));
  });
  const auto add = [&](std::uint8_t value, std::uint64_t bits) {
    const int sum = (256 * value + noise[bits & kNormalMask] + 128) >> 8;
    return static_cast<std::uint8_t>(std::clamp(sum, 0, 255));
  };
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const std::uint64_t bits = stream.bits(i);
    Rgb8& c = colour.data()[i];
    c = {add(c.r, bits), add(c.g, bits >> kNormalBits), add(c.b, bits >> (2 * kNormalBits))};
  }
}

}  // namespace

RgbdFrame sense(const RenderedFrame& truth, const Camera& camera, const SensorConfig& config,
                LabelMode labels, RandomStream stream, Stamp stamp_ns) {
  assert(truth.depth_m.width() == camera.width_px && truth.depth_m.height() == camera.height_px);
  RgbdFrame frame{stamp_ns, truth.colour, {}, label_image(truth, labels)};
  frame.depth_m = config.depth_noise_on ? noisy_depth(truth.depth_m, camera, config.depth_noise,
                                                      stream.fork(kDepthStream))
                                        : truth.depth_m;
  if (config.colour_noise_on)
    add_colour_noise(frame.colour, config.colour_noise.sigma, stream.fork(kColourStream));
  return frame;
}

}  // namespace mh
