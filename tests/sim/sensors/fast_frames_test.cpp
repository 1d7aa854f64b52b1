// SPDX-License-Identifier: Apache-2.0
// The fast ways of making a frame give the same as plain ones, to the bit.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sim/render/color.hpp"
#include "sim/sensors/depth_noise.hpp"
#include "sim/sensors/gaussian.hpp"
#include "sim/sensors/lens.hpp"
#include "sim/sensors/normal_table.hpp"
#include "sim/sensors/processing.hpp"
#include "sim/sensors/shutter.hpp"
#include "slam/core/random.hpp"
#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

Grid2d<Rgb8> noise_image(int width, int height) {
  Grid2d<Rgb8> color(width, height);
  for (std::size_t i = 0; i < color.size(); ++i) {
    const std::uint64_t bits = RandomStream(3).bits(i);
    color.data()[i] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                       static_cast<std::uint8_t>(bits >> 16)};
  }
  return color;
}

TEST(ColorRows, AreTheirValuesOneByOne) {
  for (const int width : {1, 2, 7, 11, 640}) {
    const Grid2d<Rgb8> color = noise_image(width, 1);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(color.data());
    const std::size_t count = 3 * color.size();
    std::vector<float> decoded(count), sum(count), light(count);
    decode_row(color.row(0), decoded.data());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(decoded[i], srgb_to_linear(bytes[i]));
      sum[i] = static_cast<float>(i) / 7;
      light[i] = static_cast<float>(RandomStream(4).uniform(i, -0.1, 1.1));
    }
    add_linear(color.row(0), 0.3F, sum.data());
    Grid2d<Rgb8> encoded(width, 1);
    encode_row(light.data(), encoded.row(0));
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(sum[i], static_cast<float>(i) / 7 + 0.3F * srgb_to_linear(bytes[i]));
      EXPECT_EQ(reinterpret_cast<const std::uint8_t*>(encoded.data())[i], linear_to_srgb(light[i]));
    }
  }
}

/// A grid of floats blurred in separate passes, one value at a time.
Grid2d<float> plainly_blurred(const Grid2d<float>& image, const std::vector<float>& kernel) {
  const int radius = static_cast<int>(kernel.size()) - 1, w = image.width(), h = image.height();
  Grid2d<float> across(w, h), both(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int k = -radius; k <= radius; ++k)
        across(x, y) +=
            kernel[static_cast<std::size_t>(std::abs(k))] * image(std::clamp(x + k, 0, w - 1), y);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int k = -radius; k <= radius; ++k)
        both(x, y) +=
            kernel[static_cast<std::size_t>(std::abs(k))] * across(x, std::clamp(y + k, 0, h - 1));
  return both;
}

constexpr std::uint8_t Rgb8::*kChannels[] = {&Rgb8::r, &Rgb8::g, &Rgb8::b};

TEST(LensBlur, IsThePlainOne) {
  for (const auto& [width, height] : {std::pair(1, 1), {3, 2}, {37, 23}, {64, 48}}) {
    Grid2d<Rgb8> color = noise_image(width, height);
    const Grid2d<Rgb8> before = color;
    blur_by_lens(color, 1.05);
    for (const auto channel : kChannels) {
      Grid2d<float> light(width, height);
      for (std::size_t i = 0; i < light.size(); ++i)
        light.data()[i] = srgb_to_linear(before.data()[i].*channel);
      const Grid2d<float> blurred = plainly_blurred(light, gaussian_kernel(1.05));
      for (std::size_t i = 0; i < light.size(); ++i)
        ASSERT_EQ(color.data()[i].*channel, linear_to_srgb(blurred.data()[i])) << i;
    }
  }
}

TEST(Processing, IsThePlainOne) {
  const ProcessingConfig config{
      .enabled = true, .contrast = 0.7, .sharpening = 2.75, .sharpening_px = 0.55};
  const auto curve = [&](std::uint8_t value) {
    const double v = value / 255.0, c = config.contrast;
    return static_cast<float>(255.0 * ((1.0 - c) * v + c * v * v * (3.0 - 2.0 * v)));
  };
  for (const auto& [width, height] : {std::pair(1, 1), {3, 2}, {37, 23}, {64, 48}}) {
    Grid2d<Rgb8> color = noise_image(width, height);
    const Grid2d<Rgb8> before = color;
    process(color, config);
    Grid2d<float> luma(width, height);
    for (std::size_t i = 0; i < luma.size(); ++i) {
      const Rgb8 c = before.data()[i];
      luma.data()[i] = 0.299F * curve(c.r) + 0.587F * curve(c.g) + 0.114F * curve(c.b);
    }
    const Grid2d<float> smooth = plainly_blurred(luma, gaussian_kernel(config.sharpening_px));
    for (const auto channel : kChannels)
      for (std::size_t i = 0; i < luma.size(); ++i) {
        const float more = 2.75F * (luma.data()[i] - smooth.data()[i]);
        const float level = std::clamp(curve(before.data()[i].*channel) + more, 0.0F, 255.0F);
        ASSERT_EQ(color.data()[i].*channel, static_cast<std::uint8_t>(std::lrint(level))) << i;
      }
  }
}

/// The depth sensor, computed one pixel at a time.
class PlainDepthSensor {
 public:
  PlainDepthSensor(const Grid2d<float>& depth_m, const Camera& camera,
                   const DepthNoiseConfig& config)
      : depth_m_(depth_m), camera_(camera), config_(config) {}

  float read(int x, int y, RandomStream stream) const {
    const int w = depth_m_.width();
    const std::uint64_t bits = stream.bits(static_cast<std::uint64_t>(y * w + x));
    const auto normal = [&](int k) { return normal_table()[(bits >> (12 * k)) & 4095]; };
    int sx = x, sy = y;
    if (config_.lateral) {
      const auto sigma = static_cast<float>(lateral_sigma_px(incidence(surface(x, y))));
      sx = std::clamp(x + static_cast<int>(std::lrint(sigma * normal(0))), 0, w - 1);
      sy =
          std::clamp(y + static_cast<int>(std::lrint(sigma * normal(1))), 0, depth_m_.height() - 1);
    }
    const Surface seen = surface(sx, sy);
    float z = depth_m_(x, y);
    if (config_.lateral && seen.inverse > 0) {
      const float moved = seen.inverse + seen.slope_x * static_cast<float>(x - sx) +
                          seen.slope_y * static_cast<float>(y - sy);
      z = 1.0F / std::clamp(moved, 0.8F * seen.inverse, 1.25F * seen.inverse);
    } else if (config_.lateral) {
      z = 0;
    }
    if (config_.grazing_holes && seen.cosine < static_cast<float>(std::cos(kMaxIncidenceRad)))
      z = 0;
    if (config_.projector_shadow && shaded(x, y)) z = 0;
    if (config_.axial && z > 0) {
      const float away = z - 0.4F;
      const double theta = std::min(incidence(seen), kMaxIncidenceRad);
      const double ratio = theta / (std::numbers::pi / 2.0 - theta);
      const auto angular =
          static_cast<float>(theta <= std::numbers::pi / 3.0 ? 0.0 : 0.0001 * (ratio * ratio));
      const float sigma = 0.0012F + 0.0019F * away * away + angular / std::sqrt(z);
      z += sigma * normal(2);
    }
    const auto steps_per_inverse_depth =
        static_cast<float>(kDisparityStepsPerPx * camera_.fx_px * camera_.baseline_m);
    if (config_.quantization && z > 0) {
      const float steps = std::floor(steps_per_inverse_depth / z + 0.5F);
      z = steps >= 1 ? steps_per_inverse_depth / steps : 0;
    }
    const auto nearest = static_cast<float>(config_.min_range_m);
    return z >= nearest && z <= static_cast<float>(config_.max_range_m) ? z : 0;
  }

 private:
  struct Surface {
    float inverse, slope_x, slope_y, cosine;
  };
  float inverse(int x, int y) const { return depth_m_(x, y) > 0 ? 1.0F / depth_m_(x, y) : 0.0F; }
  /// Along one axis: the smaller difference, or the only one at the border of the image.
  template <class At>
  static float slope(At at, int i, int count) {
    const float before = at(i) - at(std::max(i - 1, 0)),
                after = at(std::min(i + 1, count - 1)) - at(i);
    if (i == 0) return after;
    if (i == count - 1) return before;
    return std::abs(after) < std::abs(before) ? after : before;
  }
  Surface surface(int x, int y) const {
    const float sx = slope([&](int i) { return inverse(i, y); }, x, depth_m_.width());
    const float sy = slope([&](int i) { return inverse(x, i); }, y, depth_m_.height());
    const auto f = [](double value) { return static_cast<float>(value); };
    const float a = (f(x) - f(camera_.cx_px)) / f(camera_.fx_px);
    const float b = (f(y) - f(camera_.cy_px)) / f(camera_.fy_px);
    const float nx = sx * f(camera_.fx_px), ny = sy * f(camera_.fy_px);
    const float nz = inverse(x, y) - nx * a - ny * b;
    const float squares = (nx * nx + ny * ny + nz * nz) * (a * a + b * b + 1.0F);
    return {inverse(x, y), sx, sy, inverse(x, y) / std::sqrt(squares + 1e-30F)};
  }
  /// The angle of incidence, with its cosine rounded to 1/1024 as in the sensor's table.
  static double incidence(const Surface& surface) {
    return std::acos(
        static_cast<double>(static_cast<int>(std::min(surface.cosine, 1.0F) * 1024 + 0.5F)) / 1024);
  }
  /// Whether another pixel of the row that is nearer by more than 1 px of disparity covers this
  /// pixel's column in the projector's image.
  bool shaded(int x, int y) const {
    const float focal_base =
        static_cast<float>(kDisparityStepsPerPx * camera_.fx_px * camera_.baseline_m) /
        static_cast<float>(kDisparityStepsPerPx);
    const float disparity = focal_base * inverse(x, y);
    const int own = static_cast<int>(std::floor(static_cast<float>(x) - disparity + 0.5F));
    for (int other = 0; other < depth_m_.width(); ++other) {
      const float d = focal_base * inverse(other, y);
      const int u = static_cast<int>(std::floor(static_cast<float>(other) - d));
      if ((own == u || own == u + 1) && own >= -depth_m_.width() && d > disparity + 1) return true;
    }
    return false;
  }

  const Grid2d<float>& depth_m_;
  Camera camera_;
  DepthNoiseConfig config_;
};

TEST(DepthNoise, IsThePlainOne) {
  Camera camera;
  camera.fx_px = camera.fy_px = 60;
  for (const auto& [width, height] : {std::pair(1, 1), {2, 3}, {37, 23}, {75, 48}}) {
    camera.width_px = width, camera.height_px = height;
    camera.cx_px = 0.5 * width, camera.cy_px = 0.4 * height;
    // A wall that turns away, a box in front of it, a hole, and single pixels close to the camera.
    Grid2d<float> depth_m(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const bool box = x > width / 3 && x < width / 2 && y > height / 4;
        const bool hole = x > 2 * width / 3 && y < height / 5;
        const bool speck =
            RandomStream(5).bits(static_cast<std::uint64_t>(y * width + x)) % 50 == 0;
        depth_m(x, y) = hole    ? 0
                        : speck ? 0.1F
                        : box   ? 1.3F
                                : 2 + 0.1F * static_cast<float>(x * x) / 9;
      }
    for (int faults = 0; faults < 32; ++faults) {
      DepthNoiseConfig config{.axial = (faults & 1) != 0,
                              .lateral = (faults & 2) != 0,
                              .quantization = (faults & 4) != 0,
                              .grazing_holes = (faults & 8) != 0,
                              .projector_shadow = (faults & 16) != 0};
      const Grid2d<float> fast = noisy_depth(depth_m, camera, config, RandomStream(2));
      const PlainDepthSensor plain(depth_m, camera, config);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          ASSERT_EQ(fast(x, y), plain.read(x, y, RandomStream(2)))
              << faults << ": " << x << ' ' << y;
    }
  }
}

/// A renderer that always renders whole images.
class WholeImages : public Renderer {
 public:
  explicit WholeImages(std::shared_ptr<const Renderer> inner) : inner_(std::move(inner)) {}
  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    return inner_->render(camera, world_from_camera);
  }

 private:
  std::shared_ptr<const Renderer> inner_;
};

/// A room with twelve boxes.
Scene room_of_boxes() {
  Scene scene = test::plain_scene();
  test::add_box(scene, {-3, -3, -3}, {3, 3, 3}, true, 1, 1);
  for (int i = 0; i < 12; ++i) {
    const auto u = [&](int k) {
      return static_cast<float>(RandomStream(8).uniform(static_cast<std::uint64_t>(3 * i + k)));
    };
    const Eigen::Vector3f low(4 * u(0) - 2.5F, 4 * u(1) - 2.5F, 1 + u(2));
    test::add_box(scene, low, low + Eigen::Vector3f(0.4F, 0.3F, 0.5F), false,
                  static_cast<ClassId>(2 + i), static_cast<InstanceId>(2 + i));
  }
  return scene;
}

TEST(Shutter, RendersOnlyWhatIsSeenAndSeesTheSame) {
  const std::shared_ptr<const Renderer> renderer = make_embree_renderer(room_of_boxes());
  const auto whole = std::make_shared<WholeImages>(renderer);
  Camera camera;
  camera.width_px = 150, camera.height_px = 117;
  camera.cx_px = 74, camera.cy_px = 58;
  camera.fx_px = camera.fy_px = 130;
  for (const double speed_rad_per_s : {0.0, 0.1, 0.6, 2.0})
    for (int faults = 0; faults < 8; ++faults)
      for (const LabelMode labels : {LabelMode::kExact, LabelMode::kAnnotated}) {
        SensorConfig config = exact_sensors();
        config.motion_blur = {.enabled = (faults & 1) != 0, .exposure_ms = 10};
        config.rolling_shutter.enabled = (faults & 2) != 0;
        config.depth_offset = {.enabled = (faults & 4) != 0, .offset_ms = 6.8};
        Trajectory path;
        for (int i = 0; i < 5; ++i)
          path.push_back(
              {33'333'333 * i, SE3(Eigen::AngleAxisd(speed_rad_per_s * i / 30.0,
                                                     Eigen::Vector3d(0.3, 1, 0.2).normalized())
                                       .toRotationMatrix(),
                                   {0.01 * i, 0, 0})});
        const auto fast = Shutter(renderer, camera, path, config).expose(2, labels);
        const auto plain = Shutter(whole, camera, path, config).expose(2, labels);
        EXPECT_EQ(fast.seen.color, plain.seen.color) << speed_rad_per_s << ' ' << faults;
        EXPECT_EQ(fast.seen.depth_m, plain.seen.depth_m) << speed_rad_per_s << ' ' << faults;
        EXPECT_EQ(fast.seen.classes, plain.seen.classes) << speed_rad_per_s << ' ' << faults;
        EXPECT_EQ(fast.seen.instances, plain.seen.instances) << speed_rad_per_s << ' ' << faults;
        EXPECT_EQ(fast.seen.exposure, plain.seen.exposure);
      }
}

TEST(Renderer, PartsAreThoseOfTheWholeImage) {
  const std::unique_ptr<const Renderer> renderer = make_embree_renderer(room_of_boxes());
  Camera camera;
  camera.width_px = 150, camera.height_px = 117;
  const SE3 pose(Eigen::Matrix3d::Identity(), {0.1, 0, -1});
  const RenderedFrame whole = renderer->render(camera, pose);
  EXPECT_EQ(renderer->render_depth(camera, pose), whole.depth_m);
  std::vector<Eigen::Vector2i> pixels;
  for (int i = 0; i < 40; ++i) pixels.emplace_back(i * 149 / 39, i * 116 / 39);
  const std::vector<float> depths = renderer->depth_at(camera, pose, pixels);
  ASSERT_EQ(depths.size(), pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i)
    EXPECT_EQ(depths[i], whole.depth_m(pixels[i].x(), pixels[i].y()));
  for (const auto& [first, last] : {std::pair(0, 1), {15, 17}, {40, 90}, {100, 117}, {0, 117}}) {
    const RenderedFrame part = renderer->render_rows(camera, pose, first, last);
    for (int y = first; y < last; ++y) {
      EXPECT_TRUE(std::ranges::equal(part.color.row(y), whole.color.row(y))) << y;
      EXPECT_TRUE(std::ranges::equal(part.classes.row(y), whole.classes.row(y))) << y;
      EXPECT_TRUE(std::ranges::equal(part.instances.row(y), whole.instances.row(y))) << y;
    }
  }
}

}  // namespace
}  // namespace mh
