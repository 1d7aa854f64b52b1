// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/shutter.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "sim/render/color.hpp"
#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

constexpr double kDepthM = 2.0;

Camera small_camera() {
  Camera camera;
  camera.width_px = 160, camera.height_px = 120;
  camera.fx_px = camera.fy_px = 130.0;
  camera.cx_px = 79.5, camera.cy_px = 59.5;
  return camera;
}

/// A wall at a depth of 2 m, white where world x < 0 and black elsewhere, with an edge smoothed
/// over one pixel. The depth encodes the camera's world y. Counts the rows that it renders.
class Edge : public Renderer {
 public:
  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    const int w = camera.width_px, h = camera.height_px;
    RenderedFrame frame{{w, h}, {w, h, static_cast<float>(kDepthM)}, {w, h, 1}, {w, h, 1}};
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const Eigen::Vector3d p = world_from_camera * camera.unproject(x, y, kDepthM);
        const double white = 0.5 - p.x() / kDepthM * camera.fx_px;
        const std::uint8_t gray = linear_to_srgb(static_cast<float>(white));
        frame.color(x, y) = {gray, gray, gray};
        frame.depth_m(x, y) = static_cast<float>(kDepthM + world_from_camera.translation().y());
      }
    rows += h;
    return frame;
  }
  std::vector<float> depth_at(const Camera&, const SE3& world_from_camera,
                              std::span<const Eigen::Vector2i> pixels) const override {
    const double depth_m = kDepthM + world_from_camera.translation().y();
    return std::vector<float>(pixels.size(), static_cast<float>(depth_m));
  }
  mutable long rows = 0;
};

/// Frames at 30 Hz while the camera moves along x.
Trajectory sliding(double speed_m_per_s, int frames = 5, double from_m = 0.0) {
  Trajectory path;
  for (int i = 0; i < frames; ++i) {
    const Stamp stamp = i * Stamp{33'333'333};
    path.push_back(
        {stamp,
         SE3(Eigen::Matrix3d::Identity(),
             {from_m + speed_m_per_s * (static_cast<double>(stamp) * 1e-9 - 0.066666666), 0, 0})});
  }
  return path;
}

SensorConfig blurring(double exposure_s) {
  SensorConfig config;
  config.motion_blur = {.enabled = true, .exposure_ms = 1e3 * exposure_s};
  config.motion_sampling.step_px = 0.25;
  config.motion_sampling.sharp_px = 0.0;
  config.motion_sampling.max_images = 301;
  return config;
}

/// The squared width over which an edge was smeared: a uniform smear has a variance of width^2 /
/// 12; the area of a pixel adds 1/12, and so does sampling by pixels, averaged over where the edge
/// falls between pixels.
double squared_smear_px(const Grid2d<Rgb8>& color, int y) {
  double mean = 0.0, square = 0.0;
  for (int x = 0; x + 1 < color.width(); ++x) {
    const double drop = srgb_to_linear(color(x, y).r) - srgb_to_linear(color(x + 1, y).r);
    mean += drop * x;
    square += drop * x * x;
  }
  return 12.0 * (square - mean * mean) - 2.0;
}

/// Position of the edge in a row: the number of pixels that the light would fill.
double edge_px(const Grid2d<Rgb8>& color, int y) {
  double light = 0.0;
  for (const Rgb8& c : color.row(y)) light += srgb_to_linear(c.r);
  return light;
}

TEST(MotionBlur, LengthIsFocalLengthTimesSpeedTimesExposureOverDepth) {
  const auto scene = std::make_shared<Edge>();
  constexpr int kPlaces = 8;
  for (const double speed : {0.55, 2.0, 6.0})
    for (const double exposure_s : {0.010, 0.033}) {
      double squared = 0.0;
      for (int k = 0; k < kPlaces; ++k) {
        const double from_m = kDepthM / 130.0 * k / kPlaces;
        const Shutter shutter(scene, small_camera(), sliding(speed, 5, from_m),
                              blurring(exposure_s));
        squared += squared_smear_px(shutter.expose(2).seen.color, 60) / kPlaces;
      }
      const double expected = 130.0 * speed * exposure_s / kDepthM;
      EXPECT_NEAR(std::sqrt(std::max(0.0, squared)), expected, 0.1 + 0.01 * expected)
          << speed << " m/s, " << exposure_s << " s";
    }
}

TEST(MotionBlur, IsTheMeanInLinearLight) {
  // Half of the exposure sees white, half sees black: sRGB 188, not 128.
  const Shutter shutter(std::make_shared<Edge>(), small_camera(), sliding(2.0), blurring(0.030));
  const Grid2d<Rgb8> color = shutter.expose(2).seen.color;
  EXPECT_EQ(color(20, 60).r, 255);
  EXPECT_EQ(color(140, 60).r, 0);
  EXPECT_NEAR((color(79, 60).r + color(80, 60).r) / 2.0, 188, 6);
}

TEST(MotionBlur, ACameraAtRestSeesTheExactImageAndRendersItOnce) {
  const auto scene = std::make_shared<Edge>();
  SensorConfig config = blurring(0.033);
  config.rolling_shutter.enabled = true;
  const Shutter shutter(scene, small_camera(), sliding(0.0), config);
  const RenderedFrame seen = shutter.expose(2).seen;
  EXPECT_EQ(scene->rows, 120);
  EXPECT_EQ(seen.color, scene->render(small_camera(), SE3()).color);
}

TEST(MotionBlur, AloneLeavesDepthClassesAndInstancesAtTheStamp) {
  const auto scene = std::make_shared<Edge>();
  const Trajectory path = sliding(2.0);
  const RenderedFrame seen = Shutter(scene, small_camera(), path, blurring(0.033)).expose(1).seen;
  const RenderedFrame exact = scene->render(small_camera(), path[1].world_from_camera);
  EXPECT_EQ(seen.depth_m, exact.depth_m);
  EXPECT_EQ(seen.classes, exact.classes);
  EXPECT_NE(seen.color, exact.color);
}

TEST(RollingShutter, SlantsAnUprightEdgeBySpeedTimesReadout) {
  SensorConfig config;
  config.rolling_shutter = {.enabled = true, .readout_ms = 30};
  config.motion_sampling.step_px = 0.25;
  config.motion_sampling.max_images = 301;
  const auto scene = std::make_shared<Edge>();
  for (const double speed : {-1.5, 0.8, 1.5}) {
    const Shutter shutter(scene, small_camera(), sliding(speed), config);
    const Grid2d<Rgb8> color = shutter.expose(2).seen.color;
    // The camera moves to the right, so static objects move to the left, row by row.
    const double expected = -130.0 * speed * 0.030 / kDepthM * 119.0 / 120.0;
    EXPECT_NEAR(edge_px(color, 119) - edge_px(color, 0), expected, 0.5) << speed;
    EXPECT_NEAR(edge_px(color, 60), 80.0, 0.6)
        << speed;  // the middle row is exposed at the timestamp
    for (int y = 0; y < 120; ++y) ASSERT_LT(squared_smear_px(color, y), 1.2);  // each row is sharp
  }
}

/// Two upright surfaces, white and black, of classes 1 and 2, that meet in one edge; a camera that
/// pans across it at 2 rad/s, and its images under rolling shutter and motion blur.
class PannedEdge : public testing::Test {
 protected:
  PannedEdge() {
    Scene scene = test::plain_scene();
    scene.materials.push_back(scene.materials.front());
    scene.materials.back().base_color = {0, 0, 0};
    test::add_quad(scene, {-4, -3, 2}, {4, 0, 0}, {0, 6, 0}, 1, 1, 0);
    test::add_quad(scene, {0, -3, 2}, {4, 0, 0}, {0, 6, 0}, 2, 2, 1);
    renderer_ = make_embree_renderer(scene);
    for (int i = 0; i < 5; ++i) {
      const Eigen::AngleAxisd turn(2.0 * (i - 2) / 30.0, Eigen::Vector3d::UnitY());
      path_.push_back({i * Stamp{33'333'333}, SE3(turn.toRotationMatrix(), {0, 0, 0})});
    }
    config_.rolling_shutter.enabled = true;
    config_.motion_blur = {.enabled = true, .exposure_ms = 10};
  }
  RenderedFrame seen(LabelMode labels) const {
    return Shutter(renderer_, Camera{}, path_, config_).expose(2, labels).seen;
  }
  /// By how many pixels the labels' border in a row is outside the two pixels around the color's
  /// edge; at the border, class and instance change from 1 to 2, exactly once.
  static double astray_px(const RenderedFrame& frame, int y) {
    const auto classes = frame.classes.row(y);
    const auto border = std::ranges::find(classes, 2) - classes.begin();
    for (int x = 0; x < frame.classes.width(); ++x) {
      EXPECT_EQ(frame.classes(x, y), x < border ? 1 : 2);
      EXPECT_EQ(frame.instances(x, y), frame.classes(x, y));
    }
    // edge_px counts from the outer side of the first pixel, and so does the border.
    return std::max(0.0, std::abs(edge_px(frame.color, y) - static_cast<double>(border)) - 0.5);
  }
  std::shared_ptr<const Renderer> renderer_;
  Trajectory path_;
  SensorConfig config_;
};

TEST_F(PannedEdge, ExactLabelsFollowTheColorRowByRow) {
  const RenderedFrame frame = seen(LabelMode::kExact);
  for (int y = 0; y < frame.color.height(); ++y) ASSERT_LE(astray_px(frame, y), 1.0) << y;
  // 2 rad/s for 26.1 ms at a focal length of 525 px: the labels' edge slants as much as the
  // color's.
  const auto border = [&](int y) {
    return std::ranges::find(frame.classes.row(y), 2) - frame.classes.row(y).begin();
  };
  EXPECT_NEAR(static_cast<double>(border(0) - border(479)), 2.0 * 0.0261 * 525, 2.0);
}

TEST_F(PannedEdge, AnnotatedLabelsAreThoseOfTheStamp) {
  const RenderedFrame frame = seen(LabelMode::kAnnotated);
  const RenderedFrame still = renderer_->render(Camera{}, path_[2].world_from_camera);
  EXPECT_EQ(frame.classes, still.classes);
  EXPECT_EQ(frame.instances, still.instances);
  EXPECT_GT(astray_px(frame, 0), 10.0);
  EXPECT_GT(astray_px(frame, 479), 10.0);
  EXPECT_LE(astray_px(frame, 240), 1.0);
}

TEST_F(PannedEdge, LabelsTouchNeitherColorNorDepth) {
  const RenderedFrame exact = seen(LabelMode::kExact), annotated = seen(LabelMode::kAnnotated);
  EXPECT_EQ(exact.color, annotated.color);
  EXPECT_EQ(exact.depth_m, annotated.depth_m);
  EXPECT_NE(exact.classes, annotated.classes);
}

TEST(RollingShutter, AloneCostsAboutOneImageMore) {
  const auto scene = std::make_shared<Edge>();
  SensorConfig config;
  config.rolling_shutter.enabled = true;
  config.motion_sampling.step_px = 0.5;
  const Shutter shutter(scene, small_camera(), sliding(2.0), config);
  shutter.expose(2);
  EXPECT_LE(scene->rows, 120 * 4);  // the exact image, and about two times each row of the others
  EXPECT_GE(scene->rows, 120 * 2);
}

TEST(RollingShutter, ARealRendererDrawsEveryStrip) {
  // The strips above and below the middle do not contain the principal point.
  Scene scene = test::plain_scene();
  test::add_box(scene, {-3, -3, -3}, {3, 3, 3}, true, 1, 1);
  const std::shared_ptr<const Renderer> renderer = make_embree_renderer(scene);
  SensorConfig config = blurring(0.02);
  config.rolling_shutter.enabled = true;
  config.motion_sampling.step_px = 1.5;
  const Shutter shutter(renderer, small_camera(), sliding(2.0), config);
  const RenderedFrame seen = shutter.expose(2).seen;
  for (const float depth_m : seen.depth_m) ASSERT_GT(depth_m, 0.0F);
}

TEST(Shutter, IsAPureFunctionOfTheFrame) {
  SensorConfig config = blurring(0.02);
  config.auto_exposure.enabled = true;
  const Shutter shutter(std::make_shared<Edge>(), small_camera(), sliding(1.0, 9), config);
  const auto first = shutter.expose(5);
  shutter.expose(1);
  const auto again = shutter.expose(5);
  EXPECT_EQ(first.seen.color, again.seen.color);
  EXPECT_EQ(first.gain, again.gain);
}

TEST(Shutter, PosesBetweenFramesLieOnAConstantTwist) {
  Trajectory path = sliding(1.0, 3);
  path[2].world_from_camera =
      path[1].world_from_camera *
      SE3(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()).toRotationMatrix(), {0.1, 0, 0});
  EXPECT_NEAR(pose_at(path, 1, 0.0).translation().x(), path[1].world_from_camera.translation().x(),
              1e-15);
  EXPECT_NEAR(pose_at(path, 0, 0.010).translation().x(), -0.066666666 + 0.010, 1e-9);
  EXPECT_NEAR(pose_at(path, 2, -0.0166666665).rotation()(0, 2), std::sin(0.2), 1e-6);
  EXPECT_NEAR(
      angle_between_rad(pose_at(path, 0, 0.0333333333 + 0.00833333), path[1].world_from_camera),
      0.1, 1e-5);
  // Before the start and after the end, the camera is at rest.
  EXPECT_EQ(pose_at(path, 0, -1.0).translation(), path[0].world_from_camera.translation());
  EXPECT_EQ(pose_at(path, 2, 1.0).translation(), path[2].world_from_camera.translation());
}

TEST(DepthOffset, DepthIsThatOfAnotherMomentAndColorIsNot) {
  Trajectory path = sliding(0.0, 5);
  for (std::size_t i = 0; i < path.size(); ++i)
    path[i].world_from_camera =
        SE3(Eigen::Matrix3d::Identity(), {0, 0.3 * static_cast<double>(i), 0});
  SensorConfig config;
  config.depth_offset = {.enabled = true, .offset_ms = 10};
  const RenderedFrame seen =
      Shutter(std::make_shared<Edge>(), small_camera(), path, config).expose(1).seen;
  EXPECT_NEAR(seen.depth_m(5, 5), kDepthM + 0.3 + 0.3 * 0.3, 1e-4);
  EXPECT_EQ(seen.color, Edge().render(small_camera(), path[1].world_from_camera).color);
}

/// Everything has the same gray, which is lighter once the camera is past x = 0.
class Lamp : public Renderer {
 public:
  RenderedFrame render(const Camera& camera, const SE3& world_from_camera) const override {
    const int w = camera.width_px, h = camera.height_px;
    const std::uint8_t gray = linear_to_srgb(world_from_camera.translation().x() < 0 ? 0.1F : 0.3F);
    return {{w, h, {gray, gray, gray}}, {w, h, 2.0F}, {w, h, 1}, {w, h, 1}};
  }
};

TEST(AutoExposure, TheGainNearsItsGoalExponentially) {
  SensorConfig config;
  config.auto_exposure.enabled = true;
  config.auto_exposure.target = 0.15;
  config.auto_exposure.time_constant_s = 0.2;
  const Trajectory path = sliding(1.0, 40);  // frame 2 is at x = 0, up to rounding
  const Shutter shutter(std::make_shared<Lamp>(), small_camera(), path, config);
  EXPECT_NEAR(shutter.expose(0).gain, 1.5, 0.02);
  EXPECT_NEAR(shutter.expose(39).gain, 0.5, 0.02);
  std::size_t first_bright = 0;
  while (path[first_bright].world_from_camera.translation().x() < 0) ++first_bright;
  for (const std::size_t later : {0U, 3U, 6U, 12U}) {
    const double elapsed_s = (static_cast<double>(later) + 1.0) / 30.0;
    const double expected = 0.5 * std::pow(3.0, std::exp(-elapsed_s / 0.2));
    EXPECT_NEAR(shutter.expose(first_bright + later).gain, expected, 0.02) << later;
  }
}

TEST(AutoExposure, StaysWithinItsLimits) {
  SensorConfig config;
  config.auto_exposure.enabled = true;
  config.auto_exposure.target = 0.9;
  config.auto_exposure.max_gain = 2.0;
  const Shutter shutter(std::make_shared<Lamp>(), small_camera(), sliding(0.0), config);
  EXPECT_NEAR(shutter.expose(0).gain, 2.0, 1e-9);
}

TEST(DroppedFrames, GoMissingAtTheirRateAndTheSameOnesEachTime) {
  const Trajectory path = sliding(0.0, 4000);
  SensorConfig config;
  EXPECT_EQ(arriving_frames(path, config, RandomStream(1)).size(), 4000U);
  config.dropped_frames = {.enabled = true, .share = 0.2};
  const Trajectory arrived = arriving_frames(path, config, RandomStream(1));
  EXPECT_NEAR(static_cast<double>(arrived.size()), 3200.0, 4.0 * std::sqrt(4000 * 0.16));
  for (std::size_t i = 1; i < arrived.size(); ++i)
    ASSERT_LT(arrived[i - 1].stamp_ns, arrived[i].stamp_ns);
  EXPECT_EQ(arriving_frames(path, config, RandomStream(1)).size(), arrived.size());
  config.dropped_frames = {.enabled = true, .share = 1.0};
  EXPECT_EQ(arriving_frames(path, config, RandomStream(1)).size(),
            1U);  // at least one frame arrives
}

}  // namespace
}  // namespace mh
