// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "sim/render/colour.hpp"
#include "sim/render/renderer.hpp"
#include "slam/core/error.hpp"
#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

using Eigen::Vector3f;
using test::add_quad;
using test::plain_scene;

/// The camera's axes in a world of the same axes: x right, y down, z forward.
const SE3 kIdentity;

Scene plane_at_two_metres() {
  Scene scene = plain_scene({200, 100, 50});
  add_quad(scene, {-5, -5, 2}, {10, 0, 0}, {0, 10, 0}, 1, 1);
  return scene;
}

TEST(EmbreeRenderer, PlaneAtTwoMetresReadsTwoMetresAtEveryPixel) {
  const auto renderer = make_embree_renderer(plane_at_two_metres());
  const RenderedFrame frame = renderer->render(Camera{}, kIdentity);
  ASSERT_EQ(frame.depth_m.size(), 640U * 480U);
  // Embree computes in float: one part in 2^22.
  for (const float depth : frame.depth_m) ASSERT_NEAR(depth, 2.0F, 1e-6);
  for (const ClassId id : frame.classes) ASSERT_EQ(id, 1);
  for (const InstanceId id : frame.instances) ASSERT_EQ(id, 1);
  for (const Rgb8& colour : frame.colour) ASSERT_EQ(colour, (Rgb8{200, 100, 50}));
}

TEST(EmbreeRenderer, TiltedPlaneFollowsItsClosedForm) {
  Scene scene = plain_scene();
  // The plane z = 2 + 0.5 x, seen from (0.1, -0.2, 0.3): depth = (2 + 0.5 ox - oz) / (1 - 0.5 a).
  add_quad(scene, {-2, -9, 1}, {20, 0, 10}, {0, 18, 0}, 1, 1);
  const SE3 pose(Eigen::Matrix3d::Identity(), {0.1, -0.2, 0.3});
  const Camera camera;
  const RenderedFrame frame = make_embree_renderer(scene)->render(camera, pose);
  for (int y = 0; y < camera.height_px; y += 7)
    for (int x = 0; x < camera.width_px; x += 7) {
      const double a = (x - camera.cx_px) / camera.fx_px;
      ASSERT_NEAR(frame.depth_m(x, y), (2.0 + 0.05 - 0.3) / (1.0 - 0.5 * a), 3e-6) << x << " " << y;
    }
}

TEST(EmbreeRenderer, FinelyCutSphereHasTheDepthOfASphere) {
  Scene scene = plain_scene();
  const double radius = 0.5, distance = 2.0;
  const int n = 256;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i < 2 * n; ++i) {
      const double theta = std::numbers::pi * j / n, phi = std::numbers::pi * i / n;
      scene.positions_m.emplace_back(radius * std::sin(theta) * std::cos(phi),
                                     radius * std::sin(theta) * std::sin(phi),
                                     radius * std::cos(theta));
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < 2 * n; ++i) {
      const std::uint32_t k = (i + 1) % (2 * n), p = j * 2 * n, q = p + 2 * n;
      scene.triangles.push_back({p + i, q + i, q + k});
      scene.triangles.push_back({p + i, q + k, p + k});
    }
  scene.class_of.assign(scene.triangles.size(), 5);
  scene.instance_of.assign(scene.triangles.size(), 1);
  scene.material_of.assign(scene.triangles.size(), 0);
  scene.instances.push_back({1, 5, "sphere", {}, {}});

  // Beside the axis, lest whole rows of rays run along edges, where single ones slip through.
  const Eigen::Vector3d centre(0.0123, -0.0211, distance);
  for (Vector3f& p : scene.positions_m) p += centre.cast<float>();
  const Camera camera;
  const RenderedFrame frame = make_embree_renderer(scene)->render(camera, kIdentity);
  int hits = 0;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d d = camera.unproject(x, y, 1.0);
      // |t d - centre| = radius, the nearer root; t is the depth as d.z = 1.
      const double b = d.dot(centre) / d.squaredNorm();
      const double discriminant =
          b * b - (centre.squaredNorm() - radius * radius) / d.squaredNorm();
      if (discriminant < -1e-4) {
        ASSERT_EQ(frame.depth_m(x, y), 0.0F);
        ASSERT_EQ(frame.classes(x, y), kVoid);
      } else if (discriminant > 1e-2) {  // incidence below 79 deg
        ++hits;
        // Facets of 6 x 6 mm sag by up to 2e-5 m; the incidence multiplies that by up to 5.
        ASSERT_NEAR(frame.depth_m(x, y), b - std::sqrt(discriminant), 1e-4) << x << " " << y;
      }
    }
  EXPECT_GT(hits, 40000);  // pi (525 * 0.5 / 2)^2 = 54,000
}

TEST(EmbreeRenderer, PixelCentresLieAtIntegers) {
  // An edge at x = 0: with cx = 10 pixel 10's ray runs along it, pixel 9 is left, 11 is right.
  Scene scene = plain_scene();
  add_quad(scene, {-9, -9, 1}, {9.001F, 0, 0}, {0, 18, 0}, 1, 1);
  add_quad(scene, {0.001F, -9, 1}, {9, 0, 0}, {0, 18, 0}, 2, 2);
  Camera camera{.width_px = 21,
                .height_px = 5,
                .fx_px = 100,
                .fy_px = 100,
                .cx_px = 10,
                .cy_px = 2,
                .distortion = {}};
  const auto renderer = make_embree_renderer(scene);
  EXPECT_EQ(renderer->render(camera, kIdentity).classes(10, 2), 1);  // 1 mm = 0.1 px right of it
  EXPECT_EQ(renderer->render(camera, kIdentity).classes(11, 2), 2);
  camera.cx_px = 9.8;  // now pixel 10 looks 0.2 px to the right of the axis, beyond the edge
  EXPECT_EQ(renderer->render(camera, kIdentity).classes(10, 2), 2);
  EXPECT_EQ(renderer->render(camera, kIdentity).classes(9, 2), 1);
}

TEST(EmbreeRenderer, PoseIsWorldFromCamera) {
  Scene scene = plain_scene();
  add_quad(scene, {3, -1, -1}, {0, 2, 0}, {0, 0, 2}, 7,
           1);               // a wall 2 m ahead of (1, 0, 0) along +x
  Eigen::Matrix3d rotation;  // columns: the camera's right, down and forward in the world
  rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const RenderedFrame frame =
      make_embree_renderer(scene)->render(Camera{}, SE3(rotation, {1, 0, 0}));
  EXPECT_NEAR(frame.depth_m(320, 240), 2.0F, 1e-5);
  // The wall spans +-1 m at 2 m: +-262.5 px about the centre.
  EXPECT_EQ(frame.classes(319 - 262, 240), 7);
  EXPECT_EQ(frame.classes(319 - 263, 240), kVoid);
  EXPECT_EQ(frame.classes(319 + 263, 240), 7);
  EXPECT_EQ(frame.classes(319 + 264, 240), kVoid);
}

TEST(EmbreeRenderer, MissShowsTheSkyAndNothingElse) {
  Scene scene = plain_scene();
  add_quad(scene, {5, 5, -5}, {1, 0, 0}, {0, 1, 0}, 3, 1);
  scene.lights.push_back({.kind = Light::Kind::kSky, .colour = {0.5F, 0.25F, 0.1F}});
  const RenderedFrame frame = make_embree_renderer(scene)->render(Camera{}, kIdentity);
  for (const float depth : frame.depth_m) ASSERT_EQ(depth, 0.0F);
  for (const ClassId id : frame.classes) ASSERT_EQ(id, kVoid);
  for (const InstanceId id : frame.instances) ASSERT_EQ(id, 0);
  const Rgb8 sky{linear_to_srgb(0.5F), linear_to_srgb(0.25F), linear_to_srgb(0.1F)};
  for (const Rgb8& colour : frame.colour) ASSERT_EQ(colour, sky);
}

TEST(EmbreeRenderer, LabelsAreThoseOfTheNearestFaceSeenFromEitherSide) {
  Scene scene = plain_scene();
  add_quad(scene, {-5, -5, 3}, {10, 0, 0}, {0, 10, 0}, 1, 1);
  add_quad(scene, {0, -5, 2}, {0, 10, 0}, {5, 0, 0}, 5, 2);  // its back looks at the camera
  const Camera camera;
  const RenderedFrame frame = make_embree_renderer(scene)->render(camera, kIdentity);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const bool near = x > camera.cx_px;
      ASSERT_EQ(frame.classes(x, y), near ? 5 : 1);
      ASSERT_EQ(frame.instances(x, y), near ? 2 : 1);
    }
}

/// Colours that vary smoothly from texel to texel, so that every bilinear weight matters.
Grid2d<Rgb8> smooth_picture(int width, int height) {
  Grid2d<Rgb8> picture(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture(x, y) = {static_cast<std::uint8_t>(40 + (x * 37 + y * 11) % 180),
                       static_cast<std::uint8_t>(30 + (x * 17 + y * 53) % 200),
                       static_cast<std::uint8_t>(20 + (x * 71 + y * 29) % 220)};
  return picture;
}

/// Bilinear interpolation in linear light of a repeating picture, texel centres at half-integers.
Vector3f bilinear_truth(const Grid2d<Rgb8>& picture, double u, double v) {
  const double x = u * picture.width() - 0.5, y = v * picture.height() - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto texel = [&](int i, int j) {
    const int w = picture.width(), h = picture.height();
    return srgb_to_linear(picture(((i % w) + w) % w, ((j % h) + h) % h));
  };
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
         fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
}

TEST(EmbreeRenderer, MagnifiedTextureIsBilinearInLinearLight) {
  Scene scene = plain_scene({200, 220, 240});
  scene.materials[0].texture = smooth_picture(7, 5);
  // u = x / 1.28 m + 0.5 and so on: 7 texels over 640 px at 2 m and f = 1000.
  add_quad(scene, {-0.64F, -0.48F, 2}, {1.28F, 0, 0}, {0, 0.96F, 0}, 1, 1);
  for (auto& uv : scene.uvs) uv = {uv.x() * 2.0F - 1.0F, uv.y() + 3.0F};  // repeats, negative too
  const Camera camera{.fx_px = 1000, .fy_px = 1000, .distortion = {}};
  const RenderedFrame frame = make_embree_renderer(scene)->render(camera, kIdentity);
  for (int y = 3; y < 477; ++y)
    for (int x = 3; x < 637; ++x) {
      const double u = ((x - 319.5) * 0.002 + 0.64) / 1.28 * 2.0 - 1.0;
      const double v = ((y - 239.5) * 0.002 + 0.48) / 0.96 + 3.0;
      const Vector3f truth = bilinear_truth(scene.materials[0].texture, u, v)
                                 .cwiseProduct(srgb_to_linear(scene.materials[0].base_colour));
      // One grey level: the gain is kept as a half (one part in 2048), the output rounds.
      ASSERT_NEAR(frame.colour(x, y).r, linear_to_srgb(truth.x()), 1) << x << " " << y;
      ASSERT_NEAR(frame.colour(x, y).g, linear_to_srgb(truth.y()), 1) << x << " " << y;
      ASSERT_NEAR(frame.colour(x, y).b, linear_to_srgb(truth.z()), 1) << x << " " << y;
    }
}

TEST(EmbreeRenderer, FarTextureShowsItsMeanInLinearLight) {
  Scene scene = plain_scene();
  Grid2d<Rgb8>& texture = scene.materials[0].texture = Grid2d<Rgb8>(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) texture(x, y) = (x + y) % 2 ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0};
  add_quad(scene, {-50, -50, 10}, {100, 0, 0}, {0, 100, 0}, 1, 1);
  for (auto& uv : scene.uvs) uv *= 1000.0F;  // 10 cm per repeat: some 12 texels per pixel
  const RenderedFrame frame = make_embree_renderer(scene)->render(Camera{}, kIdentity);
  const int half = linear_to_srgb(0.5F);  // 188: half the light, not half the code value
  for (const Rgb8& colour : frame.colour) ASSERT_NEAR(colour.g, half, 1);
}

TEST(EmbreeRenderer, OutputIsAlbedoTimesLightTimesExposurePlusEmission) {
  Scene scene = plain_scene({188, 188, 188});  // linear 0.503
  add_quad(scene, {-5, -5, 2}, {10, 0, 0}, {0, 10, 0}, 1, 1);
  scene.colours.assign(scene.positions_m.size(), Rgb8{188, 255, 0});
  scene.light.assign(scene.positions_m.size(), Vector3f(0.5F, 0.25F, 1.0F));
  scene.materials[0].emission = {0.0F, 0.1F, 0.05F};
  const RenderedFrame frame =
      make_embree_renderer(scene, {.exposure = 1.5F})->render(Camera{}, kIdentity);
  const float grey = srgb_to_linear(std::uint8_t{188});
  const Rgb8 seen = frame.colour(100, 100);
  EXPECT_NEAR(seen.r, linear_to_srgb(1.5F * grey * grey * 0.5F), 1);
  EXPECT_NEAR(seen.g, linear_to_srgb(1.5F * (grey * 0.25F + 0.1F)), 1);
  EXPECT_NEAR(seen.b, linear_to_srgb(1.5F * 0.05F), 1);
}

TEST(EmbreeRenderer, SmoothEdgesMixLightAndLeaveTheRestAlone) {
  Scene scene = plain_scene();
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].base_colour = {0, 0, 0};
  add_quad(scene, {-5, -5, 2}, {5, 0, 0}, {0, 10, 0}, 1, 1, 0);  // white left of the axis
  add_quad(scene, {0, -5, 2}, {5, 0, 0}, {0, 10, 0}, 2, 2, 1);   // black right of it
  Camera camera;
  camera.cx_px = 319.8;  // pixel 320 sees the edge 0.2 px left of its centre
  const RenderedFrame sharp =
      make_embree_renderer(scene, {.antialiasing = Antialiasing::kNone})->render(camera, kIdentity);
  const RenderedFrame smooth = make_embree_renderer(scene)->render(camera, kIdentity);
  EXPECT_EQ(sharp.depth_m, smooth.depth_m);
  EXPECT_EQ(sharp.classes, smooth.classes);
  EXPECT_EQ(sharp.instances, smooth.instances);
  // One sample of three is white.
  EXPECT_NEAR(smooth.colour(320, 240).g, linear_to_srgb(1.0F / 3.0F), 1);
  EXPECT_EQ(sharp.colour(320, 240).g, 0);
  for (int x = 0; x < camera.width_px; ++x)
    if (x != 320) {
      EXPECT_EQ(smooth.colour(x, 240), sharp.colour(x, 240)) << x;
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
  EXPECT_EQ(usual.colour, frame.colour);
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
  scene.materials[0].texture = smooth_picture(64, 64);
  add_quad(scene, {-1, -1, 2}, {2, 0, 0.5F}, {0, 2, 0}, 1, 1);
  add_quad(scene, {-0.3F, -0.3F, 1.5F}, {0.5F, 0.1F, 0}, {0, 0.4F, 0}, 2, 2);
  const Camera camera{.width_px = 100,
                      .height_px = 80,
                      .fx_px = 90,
                      .fy_px = 95,
                      .cx_px = 50,
                      .cy_px = 40,
                      .distortion = {}};
  Camera finer = camera;  // pixel (x, y) is (2x .. 2x + 1, 2y .. 2y + 1) of it
  finer.width_px *= 2, finer.height_px *= 2, finer.fx_px *= 2, finer.fy_px *= 2;
  finer.cx_px = 2 * camera.cx_px + 0.5, finer.cy_px = 2 * camera.cy_px + 0.5;
  const auto sharp = make_embree_renderer(scene, {.antialiasing = Antialiasing::kNone});
  const RenderedFrame mean =
      make_embree_renderer(scene, {.antialiasing = Antialiasing::kSupersample})
          ->render(camera, kIdentity);
  const RenderedFrame centres = sharp->render(camera, kIdentity);
  const RenderedFrame fine = sharp->render(finer, kIdentity);
  EXPECT_EQ(mean.depth_m, centres.depth_m);
  EXPECT_EQ(mean.instances, centres.instances);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      Vector3f sum = Vector3f::Zero();
      for (const int i : {0, 1})
        for (const int j : {0, 1}) sum += srgb_to_linear(fine.colour(2 * x + i, 2 * y + j));
      // Two roundings, to the fine pixels' levels and to the mean's.
      ASSERT_NEAR(mean.colour(x, y).g, linear_to_srgb(sum.y() / 4.0F), 2) << x << " " << y;
    }
  EXPECT_NE(mean.colour, centres.colour);
}

TEST(EmbreeRenderer, RefusesACameraWithoutSizeOrFocalLength) {
  const auto renderer = make_embree_renderer(plane_at_two_metres());
  for (const auto& spoil : std::initializer_list<void (*)(Camera&)>{
           [](Camera& c) { c.fx_px = 0; }, [](Camera& c) { c.fy_px = 0; },
           [](Camera& c) { c.width_px = 0; }, [](Camera& c) { c.height_px = 0; }}) {
    Camera camera;
    spoil(camera);
    EXPECT_THROW(renderer->render(camera, kIdentity), InputError);
  }
}

TEST(EmbreeRenderer, ThreadsAndPicturesNotMultiplesOfATileChangeNoBit) {
  Scene scene = plain_scene();
  scene.materials[0].texture = smooth_picture(33, 17);
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
  EXPECT_EQ(one.colour, two.colour);
  EXPECT_EQ(one.depth_m, two.depth_m);
  EXPECT_EQ(one.classes, two.classes);
  EXPECT_EQ(one.instances, two.instances);
  EXPECT_NE(one.instances(166, 125), 0);

  // The same rays in a wider picture: the left part agrees bit for bit.
  Camera wider = camera;
  wider.width_px = 400;
  const RenderedFrame wide = make_embree_renderer(scene)->render(wider, kIdentity);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) ASSERT_EQ(wide.depth_m(x, y), one.depth_m(x, y));
}

TEST(Colour, SrgbRoundTripIsExact) {
  for (int i = 0; i < 256; ++i) {
    const auto value = static_cast<std::uint8_t>(i);
    EXPECT_EQ(linear_to_srgb(srgb_to_linear(value)), value);
  }
}

}  // namespace
}  // namespace mh
