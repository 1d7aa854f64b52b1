// SPDX-License-Identifier: Apache-2.0
// Closed forms that every renderer has to reproduce, and the agreement between the two renderers.
#include <gtest/gtest.h>

#include <numbers>

#include "scenes/vocabulary_rooms/vocabulary_rooms.hpp"
#include "sim/render/agreement.hpp"
#include "sim/render/color.hpp"
#include "sim/render/renderer.hpp"
#include "slam/io/error.hpp"
#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

using Eigen::Vector3f;
using test::add_quad;
using test::plain_scene;

/// The camera's axes are those of the world: x right, y down, z forward.
const SE3 kFromOrigin;

class BothRenderers : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    try {
      make(plain_scene());
    } catch (const MachineError& error) {
      GTEST_SKIP() << error.what();
    }
  }
  static std::unique_ptr<Renderer> make(const Scene& scene, const RenderConfig& config = {}) {
    return make_renderer(GetParam(), scene, config);
  }
};
INSTANTIATE_TEST_SUITE_P(Renderers, BothRenderers, testing::Values("embree", "osmesa"),
                         [](const auto& of) { return std::string(of.param); });

Scene plane_at_two_meters() {
  Scene scene = plain_scene({200, 100, 50});
  add_quad(scene, {-5, -5, 2}, {10, 0, 0}, {0, 10, 0}, 1, 1);
  return scene;
}

/// Colors that vary smoothly from texel to texel, so that every bilinear weight matters.
Grid2d<Rgb8> smooth_texture(int width, int height) {
  Grid2d<Rgb8> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) = {static_cast<std::uint8_t>(40 + (x * 37 + y * 11) % 180),
                     static_cast<std::uint8_t>(30 + (x * 17 + y * 53) % 200),
                     static_cast<std::uint8_t>(20 + (x * 71 + y * 29) % 220)};
  return image;
}

/// Bilinear interpolation in linear light of a repeating image, with texel centers at
/// half-integers.
Vector3f bilinear_truth(const Grid2d<Rgb8>& image, double u, double v) {
  const double x = u * image.width() - 0.5, y = v * image.height() - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto texel = [&](int i, int j) {
    const int w = image.width(), h = image.height();
    return srgb_to_linear(image(((i % w) + w) % w, ((j % h) + h) % h));
  };
  const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
  return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
         fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
}

TEST_P(BothRenderers, LooksThroughTheHolesOfACutOut) {
  Scene scene = plane_at_two_meters();
  Material fence;
  fence.name = "fence";
  fence.texture = Grid2d<Rgb8>(4, 2, {250, 250, 250});
  Grid2d<std::uint8_t> opacity(4, 2, 255);
  opacity(1, 0) = kOpaqueFrom - 1;
  opacity(2, 1) = 0;
  opacity(3, 1) = kOpaqueFrom;
  fence.opacity = opacity;
  scene.materials.push_back(fence);
  const std::size_t before = scene.triangles.size();
  add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 2, 2);
  for (std::size_t f = before; f < scene.triangles.size(); ++f) scene.material_of[f] = 1;
  const Camera camera;
  const RenderedFrame frame = make(scene)->render(camera, kFromOrigin);
  int holes = 0;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const double u = 4 * ((x - camera.cx_px) / camera.fx_px + 1) / 2;  // texels
      const double v = 2 * ((y - camera.cy_px) / camera.fy_px + 1) / 2;
      if (std::abs(u - std::round(u)) < 1e-3 || std::abs(v - std::round(v)) < 1e-3) continue;
      ASSERT_TRUE(u > 0 && u < 4 && v > 0 && v < 2);  // the fence fills the view
      const bool hole = fence.opacity(static_cast<int>(u), static_cast<int>(v)) < kOpaqueFrom;
      holes += hole ? 1 : 0;
      ASSERT_NEAR(frame.depth_m(x, y), hole ? 2.0F : 1.0F, 1e-5) << x << ", " << y;
      ASSERT_EQ(frame.classes(x, y), hole ? 1 : 2) << x << ", " << y;
      ASSERT_EQ(frame.instances(x, y), hole ? 1 : 2) << x << ", " << y;
    }
  EXPECT_GT(holes, 50000);
}

TEST_P(BothRenderers, SeesThroughPanesInTheirColors) {
  Scene scene = plane_at_two_meters();
  const auto pane = [&](const Vector3f& transmission, float left, float z, float width) {
    Material material;
    material.name = "pane " + std::to_string(scene.materials.size());
    material.transmission = transmission;
    scene.materials.push_back(material);
    const std::size_t before = scene.triangles.size();
    add_quad(scene, {left, -1, z}, {width, 0, 0}, {0, 2, 0}, 2, 2);
    for (std::size_t f = before; f < scene.triangles.size(); ++f)
      scene.material_of[f] = static_cast<std::uint16_t>(scene.materials.size() - 1);
  };
  const Vector3f green(0.5F, 0.9F, 0.6F), gray(0.25F, 0.25F, 0.25F);
  pane(green, -1, 1.0, 1.0);  // the left half
  pane(gray, -1, 1.2, 1.25);  // behind it and beyond its edge, x < 0.25
  pane(gray, -5, 2.5, 10);    // behind the wall: never visible
  const Camera camera;
  for (const Antialiasing antialiasing :
       {Antialiasing::kNone, Antialiasing::kEdges, Antialiasing::kSupersample}) {
    const RenderedFrame frame =
        make(scene, {.antialiasing = antialiasing})->render(camera, kFromOrigin);
    const Vector3f wall = srgb_to_linear(Rgb8{200, 100, 50});
    for (int y = 0; y < camera.height_px; ++y)
      for (int x = 0; x < camera.width_px; ++x) {
        const double a = (x - camera.cx_px) / camera.fx_px;
        ASSERT_EQ(frame.instances(x, y), 1) << x << ", " << y;
        ASSERT_NEAR(frame.depth_m(x, y), 2.0F, 1e-6) << x << ", " << y;
        if (std::abs(a) < 0.003 || std::abs(1.2 * a - 0.25) < 0.003) continue;  // edges of panes
        Vector3f light = wall;
        if (a < 0) light = light.cwiseProduct(green);
        if (1.2 * a < 0.25) light = light.cwiseProduct(gray);
        const Rgb8 seen = frame.color(x, y);
        for (const auto& [channel, k] : {std::pair{seen.r, 0}, {seen.g, 1}, {seen.b, 2}})
          ASSERT_NEAR(channel, linear_to_srgb(light[k]), 1) << x << ", " << y << ", " << k;
      }
  }
}

TEST_P(BothRenderers, WhatIsBrighterThanWhiteIsDimmedBeforeItIsCutOff) {
  Scene scene = plane_at_two_meters();
  scene.materials[0].emission = {4, 4, 4};
  Material shade;
  shade.name = "shade";
  shade.transmission = {0.1F, 0.1F, 0.1F};
  scene.materials.push_back(shade);
  add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 2, 2);
  scene.material_of[2] = scene.material_of[3] = 1;
  const Rgb8 seen = make(scene)->render(Camera{}, kFromOrigin).color(320, 240);
  EXPECT_NEAR(seen.g, linear_to_srgb(0.1F * (4 + srgb_to_linear(Rgb8{200, 100, 50}).y())), 1);
}

TEST_P(BothRenderers, PlaneAtTwoMetersReadsTwoMetersAtEveryPixel) {
  const auto renderer = make(plane_at_two_meters());
  const RenderedFrame frame = renderer->render(Camera{}, kFromOrigin);
  ASSERT_EQ(frame.depth_m.size(), 640U * 480U);
  // Embree computes in single precision: one part in 2^22.
  for (const float depth : frame.depth_m) ASSERT_NEAR(depth, 2.0F, 1e-6);
  for (const ClassId id : frame.classes) ASSERT_EQ(id, 1);
  for (const InstanceId id : frame.instances) ASSERT_EQ(id, 1);
  for (const Rgb8& color : frame.color) ASSERT_EQ(color, (Rgb8{200, 100, 50}));
}

TEST_P(BothRenderers, TiltedPlaneFollowsItsClosedForm) {
  Scene scene = plain_scene();
  // The plane z = 2 + 0.5 x, seen from (0.1, -0.2, 0.3): depth = (2 + 0.5 ox - oz) / (1 - 0.5 a).
  add_quad(scene, {-2, -9, 1}, {20, 0, 10}, {0, 18, 0}, 1, 1);
  const SE3 pose(Eigen::Matrix3d::Identity(), {0.1, -0.2, 0.3});
  const Camera camera;
  const RenderedFrame frame = make(scene)->render(camera, pose);
  for (int y = 0; y < camera.height_px; y += 7)
    for (int x = 0; x < camera.width_px; x += 7) {
      const double a = (x - camera.cx_px) / camera.fx_px;
      ASSERT_NEAR(frame.depth_m(x, y), (2.0 + 0.05 - 0.3) / (1.0 - 0.5 * a), 3e-6) << x << " " << y;
    }
}

TEST_P(BothRenderers, FinelyCutSphereHasTheDepthOfASphere) {
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

  // Off the axis, since otherwise whole rows of rays would run along edges, where single rays slip
  // through.
  const Eigen::Vector3d center(0.0123, -0.0211, distance);
  for (Vector3f& p : scene.positions_m) p += center.cast<float>();
  const Camera camera;
  const RenderedFrame frame = make(scene)->render(camera, kFromOrigin);
  int hits = 0;
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d d = camera.unproject(x, y, 1.0);
      // |t d - center| = radius, the smaller root; t is the depth since d.z = 1.
      const double b = d.dot(center) / d.squaredNorm();
      const double discriminant =
          b * b - (center.squaredNorm() - radius * radius) / d.squaredNorm();
      if (discriminant < -1e-4) {
        ASSERT_EQ(frame.depth_m(x, y), 0.0F);
        ASSERT_EQ(frame.classes(x, y), kVoid);
      } else if (discriminant > 1e-2) {  // angle of incidence below 79 deg
        ++hits;
        // Facets of 6 x 6 mm deviate from the sphere by up to 2e-5 m; the incidence multiplies that
        // by up to 5.
        ASSERT_NEAR(frame.depth_m(x, y), b - std::sqrt(discriminant), 1e-4) << x << " " << y;
      }
    }
  EXPECT_GT(hits, 40000);  // pi (525 * 0.5 / 2)^2 = 54,000
}

TEST_P(BothRenderers, PixelCentersLieAtIntegers) {
  // An edge at x = 0: with cx = 10 the ray of pixel 10 runs along it, pixel 9 is left of it, 11 is
  // right of it.
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
  const auto renderer = make(scene);
  EXPECT_EQ(renderer->render(camera, kFromOrigin).classes(10, 2),
            1);  // the edge is 1 mm = 0.1 px to the right of it
  EXPECT_EQ(renderer->render(camera, kFromOrigin).classes(11, 2), 2);
  camera.cx_px = 9.8;  // now pixel 10 looks 0.2 px to the right of the axis, beyond the edge
  EXPECT_EQ(renderer->render(camera, kFromOrigin).classes(10, 2), 2);
  EXPECT_EQ(renderer->render(camera, kFromOrigin).classes(9, 2), 1);
}

TEST_P(BothRenderers, PoseIsWorldFromCamera) {
  Scene scene = plain_scene();
  add_quad(scene, {3, -1, -1}, {0, 2, 0}, {0, 0, 2}, 7,
           1);               // a wall 2 m from (1, 0, 0) in the direction +x
  Eigen::Matrix3d rotation;  // columns: the camera's right, down and forward in the world
  rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const RenderedFrame frame = make(scene)->render(Camera{}, SE3(rotation, {1, 0, 0}));
  EXPECT_NEAR(frame.depth_m(320, 240), 2.0F, 1e-5);
  // The wall covers +-1 m at 2 m: +-262.5 px around the center, pixels 57 to 582; the last one is a
  // tie.
  EXPECT_EQ(frame.classes(319 - 262, 240), 7);
  EXPECT_EQ(frame.classes(319 - 263, 240), kVoid);
  EXPECT_EQ(frame.classes(319 + 262, 240), 7);
  EXPECT_EQ(frame.classes(319 + 264, 240), kVoid);
}

TEST_P(BothRenderers, MissShowsTheSkyAndNothingElse) {
  Scene scene = plain_scene();
  add_quad(scene, {5, 5, -5}, {1, 0, 0}, {0, 1, 0}, 3, 1);
  scene.lights.push_back({.kind = Light::Kind::kSky, .color = {0.5F, 0.25F, 0.1F}});
  const RenderedFrame frame = make(scene)->render(Camera{}, kFromOrigin);
  for (const float depth : frame.depth_m) ASSERT_EQ(depth, 0.0F);
  for (const ClassId id : frame.classes) ASSERT_EQ(id, kVoid);
  for (const InstanceId id : frame.instances) ASSERT_EQ(id, 0);
  const Rgb8 sky{linear_to_srgb(0.5F), linear_to_srgb(0.25F), linear_to_srgb(0.1F)};
  for (const Rgb8& color : frame.color) ASSERT_EQ(color, sky);
}

TEST_P(BothRenderers, LabelsAreThoseOfTheNearestFaceSeenFromEitherSide) {
  Scene scene = plain_scene();
  add_quad(scene, {-5, -5, 3}, {10, 0, 0}, {0, 10, 0}, 1, 1);
  add_quad(scene, {0, -5, 2}, {0, 10, 0}, {5, 0, 0}, 5, 2);  // its back faces the camera
  const Camera camera;
  const RenderedFrame frame = make(scene)->render(camera, kFromOrigin);
  for (int y = 0; y < camera.height_px; ++y)
    for (int x = 0; x < camera.width_px; ++x) {
      const bool near = x > camera.cx_px;
      ASSERT_EQ(frame.classes(x, y), near ? 5 : 1);
      ASSERT_EQ(frame.instances(x, y), near ? 2 : 1);
    }
}

TEST_P(BothRenderers, MagnifiedTextureIsBilinearInLinearLight) {
  Scene scene = plain_scene({200, 220, 240});
  scene.materials[0].texture = smooth_texture(7, 5);
  // u = x / 1.28 m + 0.5 and so on: 7 texels over 640 px at 2 m and f = 1000.
  add_quad(scene, {-0.64F, -0.48F, 2}, {1.28F, 0, 0}, {0, 0.96F, 0}, 1, 1);
  for (auto& uv : scene.uvs)
    uv = {uv.x() * 2.0F - 1.0F, uv.y() + 3.0F};  // repeats, with negative coordinates, too
  const Camera camera{.fx_px = 1000, .fy_px = 1000, .distortion = {}};
  const RenderedFrame frame = make(scene)->render(camera, kFromOrigin);
  for (int y = 3; y < 477; ++y)
    for (int x = 3; x < 637; ++x) {
      const double u = ((x - 319.5) * 0.002 + 0.64) / 1.28 * 2.0 - 1.0;
      const double v = ((y - 239.5) * 0.002 + 0.48) / 0.96 + 3.0;
      const Vector3f truth = bilinear_truth(scene.materials[0].texture, u, v)
                                 .cwiseProduct(srgb_to_linear(scene.materials[0].base_color));
      // The tolerance is one gray level: the gain is stored in half precision (one part in 2048),
      // and the output is rounded.
      ASSERT_NEAR(frame.color(x, y).r, linear_to_srgb(truth.x()), 1) << x << " " << y;
      ASSERT_NEAR(frame.color(x, y).g, linear_to_srgb(truth.y()), 1) << x << " " << y;
      ASSERT_NEAR(frame.color(x, y).b, linear_to_srgb(truth.z()), 1) << x << " " << y;
    }
}

TEST_P(BothRenderers, FarTextureShowsItsMeanInLinearLight) {
  Scene scene = plain_scene();
  Grid2d<Rgb8> texture(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) texture(x, y) = (x + y) % 2 ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0};
  scene.materials[0].texture = texture;
  add_quad(scene, {-50, -50, 10}, {100, 0, 0}, {0, 100, 0}, 1, 1);
  for (auto& uv : scene.uvs) uv *= 1000.0F;  // 10 cm per repeat: about 12 texels per pixel
  const RenderedFrame frame = make(scene)->render(Camera{}, kFromOrigin);
  const int half = linear_to_srgb(0.5F);  // 188: half the light, not half the code value
  for (const Rgb8& color : frame.color) ASSERT_NEAR(color.g, half, 1);
}

TEST_P(BothRenderers, OutputIsAlbedoTimesLightTimesExposurePlusEmission) {
  Scene scene = plain_scene({188, 188, 188});  // linear 0.503
  add_quad(scene, {-5, -5, 2}, {10, 0, 0}, {0, 10, 0}, 1, 1);
  scene.colors.assign(scene.positions_m.size(), Rgb8{188, 255, 0});
  scene.light.assign(scene.positions_m.size(), Vector3f(0.5F, 0.25F, 1.0F));
  scene.materials[0].emission = {0.0F, 0.1F, 0.05F};
  const RenderedFrame frame = make(scene, {.exposure = 1.5F})->render(Camera{}, kFromOrigin);
  const float gray = srgb_to_linear(std::uint8_t{188});
  const Rgb8 seen = frame.color(100, 100);
  EXPECT_NEAR(seen.r, linear_to_srgb(1.5F * gray * gray * 0.5F), 1);
  EXPECT_NEAR(seen.g, linear_to_srgb(1.5F * (gray * 0.25F + 0.1F)), 1);
  EXPECT_NEAR(seen.b, linear_to_srgb(1.5F * 0.05F), 1);
  EXPECT_EQ(frame.exposure, 1.5F);
  scene.light.clear();
  EXPECT_EQ(make(scene, {.exposure = 1.5F})->render(Camera{}, kFromOrigin).exposure, 0.0F);
}

TEST_P(BothRenderers, RefusesACameraWithoutSizeOrFocalLength) {
  const auto renderer = make(plane_at_two_meters());
  for (const auto& spoil : std::initializer_list<void (*)(Camera&)>{
           [](Camera& c) { c.fx_px = 0; }, [](Camera& c) { c.fy_px = 0; },
           [](Camera& c) { c.width_px = 0; }, [](Camera& c) { c.height_px = 0; }}) {
    Camera camera;
    spoil(camera);
    EXPECT_THROW(renderer->render(camera, kFromOrigin), InputError);
  }
}

TEST_P(BothRenderers, CheckerboardHasItsColorsCellByCell) {
  // 8 x 6 cells of 8 x 8 texels; 80 px per cell, so a pixel covers a tenth of a texel.
  Scene scene = plain_scene();
  Grid2d<Rgb8> texture(64, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      texture(x, y) = (x / 8 + y / 8) % 2 ? Rgb8{250, 240, 230} : Rgb8{20, 30, 40};
  scene.materials[0].texture = texture;
  add_quad(scene, {-0.64F, -0.48F, 2}, {1.28F, 0, 0}, {0, 0.96F, 0}, 1, 1);
  const Camera camera{.fx_px = 1000, .fy_px = 1000, .distortion = {}};
  const RenderedFrame frame = make(scene)->render(camera, kFromOrigin);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const int in_x = x % 80,
                in_y = y % 80;  // the filter reaches half a texel, 5 px, across a side
      if (in_x < 6 || in_x > 73 || in_y < 6 || in_y > 73) continue;
      const Rgb8 wanted = (x / 80 + y / 80) % 2 ? Rgb8{250, 240, 230} : Rgb8{20, 30, 40};
      ASSERT_EQ(frame.color(x, y), wanted) << x << " " << y;
    }
}

TEST_P(BothRenderers, TexelsPerPixelChooseTheMipLevel) {
  // Columns of one texel, black and white: level 0 shows them, levels 1 and above are medium gray,
  // and in between the contrast decreases with the share of level 1.
  const auto contrast = [&](double texels_per_pixel) {
    Scene scene = plain_scene();
    Grid2d<Rgb8> texture(64, 64);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) texture(x, y) = x % 2 ? Rgb8{255, 255, 255} : Rgb8{0, 0, 0};
    scene.materials[0].texture = texture;
    add_quad(scene, {-5, -5, 1}, {10, 0, 0}, {0, 10, 0}, 1, 1);
    const Camera camera{.fx_px = 500, .fy_px = 500, .distortion = {}};
    const double texels_per_m = texels_per_pixel * 500.0;
    for (auto& uv : scene.uvs) uv *= static_cast<float>(10.0 * texels_per_m / 64.0);
    const RenderedFrame frame = make(scene)->render(camera, kFromOrigin);
    float low = 1.0F, high = 0.0F;
    for (int x = 100; x < 500; ++x) {
      const float g = srgb_to_linear(frame.color(x, 240).g);
      low = std::min(low, g), high = std::max(high, g);
    }
    return high - low;
  };
  EXPECT_GT(contrast(0.97), 0.97);  // level 0; the logarithm is accurate to 0.05
  EXPECT_LT(contrast(2.1), 0.03);   // level 1
  // Halfway between them (sqrt 2 texels), half of level 0's contrast is left at the centers of the
  // columns.
  EXPECT_NEAR(contrast(std::numbers::sqrt2), 0.5, 0.06);
}

TEST(Renderers, NamesAreKnownAndOthersRefused) {
  EXPECT_NE(make_renderer("embree", plain_scene()), nullptr);
  EXPECT_THROW(make_renderer("povray", plain_scene()), InputError);
}

TEST(Renderers, AgreeOverAGeneratedRoom) {
  // render_agreement does this with 200 views of five scenes; these few views protect every build.
  Scene scene = make_training_room(7);
  scene.light.assign(scene.positions_m.size(), Vector3f(0.7F, 0.6F, 0.5F));
  std::unique_ptr<Renderer> osmesa;
  try {
    osmesa = make_osmesa_renderer(scene);
  } catch (const MachineError& error) {
    GTEST_SKIP() << error.what();
  }
  const auto embree = make_embree_renderer(scene, {.antialiasing = Antialiasing::kNone});
  Agreement agreement;
  for (const SE3& view : training_views(scene, 3, 4))
    agreement.add(embree->render(Camera{}, view), osmesa->render(Camera{}, view));
  EXPECT_GE(agreement.class_share(), 0.9999);
  EXPECT_GE(agreement.instance_share(), 0.9999);
  EXPECT_GE(agreement.color_share(), 0.995);
  EXPECT_LE(agreement.depth_rmse_m(), 1e-4);
  EXPECT_GT(agreement.smooth, agreement.pixels / 2);
}

TEST(Agreement, CountsWhatDiffers) {
  Scene scene = plain_scene({100, 100, 100});
  add_quad(scene, {-5, -5, 2}, {10, 0, 0}, {0, 10, 0}, 1, 1);
  const RenderedFrame a = make_embree_renderer(scene)->render(Camera{}, kFromOrigin);
  RenderedFrame b = a;
  b.classes(5, 5) = 9;
  b.color(6, 6).g = static_cast<std::uint8_t>(b.color(6, 6).g - 3);
  b.color(7, 7).g = static_cast<std::uint8_t>(b.color(7, 7).g - 2);  // still counts as equal
  for (float& depth : b.depth_m) depth += 0.001F;
  b.instances(8, 8) = b.instances(9, 9) = 77;
  b.depth_m(8, 8) = a.depth_m(8, 8);  // a tie, unlike (9, 9)
  Agreement agreement;
  agreement.add(a, b);
  EXPECT_EQ(agreement.pixels, 640 * 480);
  EXPECT_EQ(agreement.same_class, agreement.pixels - 1);
  EXPECT_EQ(agreement.same_instance, agreement.pixels - 2);
  EXPECT_EQ(agreement.ties, 1);
  EXPECT_EQ(agreement.same_color, agreement.pixels - 1);
  EXPECT_EQ(agreement.smooth, agreement.pixels - 14);  // two overlapping squares of 3 x 3
  EXPECT_NEAR(agreement.depth_rmse_m(), 0.001, 1e-6);
}

}  // namespace
}  // namespace mh
