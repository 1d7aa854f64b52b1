// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <limits>

#include <gtest/gtest.h>

#include "sim/render/color.hpp"
#include "sim/render/encode.hpp"
#include "sim/render/renderer.hpp"
#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

using Eigen::Vector3f;
using test::add_quad;
using test::plain_scene;

/// The camera's axes are those of the world: x right, y down, z forward.
const SE3 kIdentity;

/// Colors that vary smoothly from texel to texel, so that every bilinear weight matters.
Grid2d<Rgb8> smooth_image(int width, int height) {
  Grid2d<Rgb8> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) = {static_cast<std::uint8_t>(40 + (x * 37 + y * 11) % 180),
                     static_cast<std::uint8_t>(30 + (x * 17 + y * 53) % 200),
                     static_cast<std::uint8_t>(20 + (x * 71 + y * 29) % 220)};
  return image;
}

TEST(Encode, IsTheTableForEveryEntry) {
  const auto expect = [](float red, float green, float blue) {
    const __m256 two = _mm256_setr_ps(red, green, blue, 7.0F, blue, red, green, -7.0F);
    const __m256 light[] = {two, two, two, two};
    std::array<Rgb8, 8 + kSpareAfterEncode> encoded;
    encode(light, &encoded[0], &encoded[4]);
    const auto of = [](float linear) { return linear_to_srgb(linear); };
    for (std::size_t i = 0; i < 8; i += 2) {
      ASSERT_EQ(encoded[i], (Rgb8{of(red), of(green), of(blue)})) << red;
      ASSERT_EQ(encoded[i + 1], (Rgb8{of(blue), of(red), of(green)})) << red;
    }
  };
  for (int i = 0; i <= kSrgbTableMax; ++i) {
    const auto place = static_cast<float>(i), last = static_cast<float>(kSrgbTableMax);
    // The value of the entry itself, and both ends of the interval for which the entry is used.
    expect(place / last, (place - 0.49F) / last, (place + 0.49F) / last);
  }
  expect(-1.0F, 1.5F, 1e30F);
  expect(-0.0F, 1e-30F, std::numeric_limits<float>::infinity());
}

TEST(EmbreeRenderer, SmoothEdgesMixLightAndLeaveTheRestAlone) {
  Scene scene = plain_scene();
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].base_color = {0, 0, 0};
  add_quad(scene, {-5, -5, 2}, {5, 0, 0}, {0, 10, 0}, 1, 1, 0);  // white left of the axis
  add_quad(scene, {0, -5, 2}, {5, 0, 0}, {0, 10, 0}, 2, 2, 1);   // black right of it
  Camera camera;
  camera.cx_px = 319.8;  // pixel 320 sees the edge 0.2 px left of its center
  const RenderedFrame sharp =
      make_embree_renderer(scene, {.antialiasing = Antialiasing::kNone})->render(camera, kIdentity);
  const RenderedFrame smooth = make_embree_renderer(scene)->render(camera, kIdentity);
  EXPECT_EQ(sharp.depth_m, smooth.depth_m);
  EXPECT_EQ(sharp.classes, smooth.classes);
  EXPECT_EQ(sharp.instances, smooth.instances);
  // One of the pixel's three samples is white.
  EXPECT_NEAR(smooth.color(320, 240).g, linear_to_srgb(1.0F / 3.0F), 1);
  EXPECT_EQ(sharp.color(320, 240).g, 0);
  for (int x = 0; x < camera.width_px; ++x)
    if (x != 320) {
      EXPECT_EQ(smooth.color(x, 240), sharp.color(x, 240)) << x;
    }
}

TEST(EmbreeRenderer, AnImageOfAnySizeIsACutOfALargerOne) {
  Scene scene = plain_scene();
  scene.materials[0].texture = smooth_image(64, 64);
  add_quad(scene, {-1, -1, 2}, {4, 0, 1}, {0, 2, 0}, 3, 2, 0, 5);
  const auto renderer = make_embree_renderer(scene, {.antialiasing = Antialiasing::kNone});
  Camera camera;
  camera.cx_px = 0, camera.cy_px = 0;
  const RenderedFrame whole = renderer->render(camera, kIdentity);
  for (const int width : {1, 3, 31, 63, 64, 65, 96, 128, 600})
    for (const int height : {1, 4, 5, 30}) {
      camera.width_px = width, camera.height_px = height;
      const RenderedFrame cut = renderer->render(camera, kIdentity);
      ASSERT_EQ(cut.color.size(), static_cast<std::size_t>(width * height));
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          ASSERT_EQ(cut.color(x, y), whole.color(x, y)) << width << "x" << height;
          ASSERT_EQ(cut.depth_m(x, y), whole.depth_m(x, y)) << width << "x" << height;
          ASSERT_EQ(cut.classes(x, y), whole.classes(x, y)) << width << "x" << height;
          ASSERT_EQ(cut.instances(x, y), whole.instances(x, y)) << width << "x" << height;
        }
    }
}

TEST(EmbreeRenderer, ExtraOutputsAgreeWithOneAnotherAndWithTheClosedForm) {
  Scene scene = plain_scene();
  add_quad(scene, {-1, -1, 2}, {4, 0, 1}, {0, 2, 0}, 3, 2, 0, 5);
  const Camera camera;
  const SE3 pose(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).toRotationMatrix(),
                 {0.1, -0.2, 0.3});
  const RenderConfig all{
      .extra = {.depth16 = true, .faces = true, .barycentric = true, .points = true}};
  const RenderedFrame frame = make_embree_renderer(scene, all)->render(camera, pose);
  int hits = 0;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const float depth = frame.depth_m(x, y);
      if (depth == 0.0F) {
        ASSERT_EQ(frame.faces(x, y), kNoFace);
        ASSERT_EQ(frame.depth16(x, y), 0);
        ASSERT_EQ(frame.points_m(x, y), Vector3f::Zero().eval());
        continue;
      }
      ++hits;
      ASSERT_NEAR(frame.depth16(x, y), 5000.0F * depth, 0.51F);
      ASSERT_LT(frame.faces(x, y), scene.triangles.size());
      const auto& corners = scene.triangles[frame.faces(x, y)];
      const auto [u, v] = frame.barycentric(x, y);
      const Vector3f on_face = (1.0F - u - v) * scene.positions_m[corners[0]] +
                               u * scene.positions_m[corners[1]] +
                               v * scene.positions_m[corners[2]];
      const Eigen::Vector3d seen = pose * camera.unproject(x, y, depth);
      ASSERT_LT((frame.points_m(x, y).cast<double>() - seen).norm(), 3e-6);
      ASSERT_LT((on_face.cast<double>() - seen).norm(), 3e-6);
    }
  EXPECT_GT(hits, 100000);
  const RenderedFrame usual = make_embree_renderer(scene)->render(camera, pose);
  EXPECT_EQ(usual.color, frame.color);
  EXPECT_TRUE(usual.faces.empty() && usual.depth16.empty() && usual.points_m.empty());
}

TEST(EmbreeRenderer, Depth16BeyondItsRangeIsNoReturn) {
  Scene scene = plain_scene();
  add_quad(scene, {-50, -50, 13.2F}, {100, 0, 0}, {0, 100, 0}, 1, 1);
  const auto renderer = make_embree_renderer(scene, {.extra = {.depth16 = true}});
  EXPECT_EQ(renderer->render(Camera{}, kIdentity).depth16(5, 5), 0);
  const SE3 nearer(Eigen::Matrix3d::Identity(), {0, 0, 0.1});
  EXPECT_EQ(renderer->render(Camera{}, nearer).depth16(5, 5), 65500);
}

TEST(EmbreeRenderer, SupersamplingIsTheMeanOfFourFinerPixels) {
  Scene scene = plain_scene();
  scene.materials[0].texture = smooth_image(64, 64);
  add_quad(scene, {-1, -1, 2}, {2, 0, 0.5F}, {0, 2, 0}, 1, 1);
  add_quad(scene, {-0.3F, -0.3F, 1.5F}, {0.5F, 0.1F, 0}, {0, 0.4F, 0}, 2, 2);
  const Camera camera{.width_px = 100,
                      .height_px = 80,
                      .fx_px = 90,
                      .fy_px = 95,
                      .cx_px = 50,
                      .cy_px = 40,
                      .distortion = {}};
  Camera finer = camera;  // pixel (x, y) corresponds to its pixels (2x .. 2x + 1, 2y .. 2y + 1)
  finer.width_px *= 2, finer.height_px *= 2, finer.fx_px *= 2, finer.fy_px *= 2;
  finer.cx_px = 2 * camera.cx_px + 0.5, finer.cy_px = 2 * camera.cy_px + 0.5;
  const auto sharp = make_embree_renderer(scene, {.antialiasing = Antialiasing::kNone});
  const RenderedFrame mean =
      make_embree_renderer(scene, {.antialiasing = Antialiasing::kSupersample})
          ->render(camera, kIdentity);
  const RenderedFrame centers = sharp->render(camera, kIdentity);
  const RenderedFrame fine = sharp->render(finer, kIdentity);
  EXPECT_EQ(mean.depth_m, centers.depth_m);
  EXPECT_EQ(mean.instances, centers.instances);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      Vector3f sum = Vector3f::Zero();
      for (const int i : {0, 1})
        for (const int j : {0, 1}) sum += srgb_to_linear(fine.color(2 * x + i, 2 * y + j));
      // The tolerance allows for two roundings: to the levels of the fine pixels and to those of
      // the mean.
      ASSERT_NEAR(mean.color(x, y).g, linear_to_srgb(sum.y() / 4.0F), 2) << x << " " << y;
    }
  EXPECT_NE(mean.color, centers.color);
}

TEST(EmbreeRenderer, ThreadsAndImagesNotMultiplesOfATileChangeNoBit) {
  Scene scene = plain_scene();
  scene.materials[0].texture = smooth_image(33, 17);
  for (InstanceId i = 1; i <= 40; ++i)
    add_quad(scene, {-2.0F + 0.1F * i, -1, 1.0F + 0.05F * i}, {0.5F, 0.1F, 0.2F}, {0, 1.5F, 0.3F},
             static_cast<ClassId>(i), i);
  const Camera camera{.width_px = 333,
                      .height_px = 251,
                      .fx_px = 300,
                      .fy_px = 300,
                      .cx_px = 166,
                      .cy_px = 125,
                      .distortion = {}};
  const RenderedFrame one = make_embree_renderer(scene, {.threads = 1})->render(camera, kIdentity);
  const RenderedFrame two = make_embree_renderer(scene, {.threads = 2})->render(camera, kIdentity);
  EXPECT_EQ(one.color, two.color);
  EXPECT_EQ(one.depth_m, two.depth_m);
  EXPECT_EQ(one.classes, two.classes);
  EXPECT_EQ(one.instances, two.instances);
  EXPECT_NE(one.instances(166, 125), 0);

  // A wider image has the same rays in its left part, which must be equal to the bit.
  Camera wider = camera;
  wider.width_px = 400;
  const RenderedFrame wide = make_embree_renderer(scene)->render(wider, kIdentity);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) ASSERT_EQ(wide.depth_m(x, y), one.depth_m(x, y));
}

TEST(Color, SrgbRoundTripIsExact) {
  for (int i = 0; i < 256; ++i) {
    const auto value = static_cast<std::uint8_t>(i);
    EXPECT_EQ(linear_to_srgb(srgb_to_linear(value)), value);
  }
}

}  // namespace
}  // namespace mh
