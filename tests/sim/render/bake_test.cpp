// SPDX-License-Identifier: Apache-2.0
#include "sim/render/bake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/render/color.hpp"
#include "sim/render/renderer.hpp"
#include "tests/sim/scene_builder.hpp"

namespace mh {
namespace {

using Eigen::Vector3f;
using test::add_box;
using test::add_quad;
using test::plain_scene;

constexpr float kPi = std::numbers::pi_v<float>;

/// A floor of 4 x 4 m around the origin, facing up, in cells of 10 cm.
Scene floor_scene() {
  Scene scene = plain_scene();
  add_quad(scene, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 2, 1, 0, 40);
  return scene;
}

Light sphere_lamp(const Vector3f& position_m, float intensity) {
  Light lamp;
  lamp.position_m = position_m;
  lamp.color = Vector3f(1.0F, 0.5F, 0.25F) * intensity;
  return lamp;
}

TEST(BakeLight, FloorUnderALampFollowsInverseSquareAndCosine) {
  Scene scene = floor_scene();
  scene.lights.push_back(sphere_lamp({0, 0, 1.5F}, 2.0F));
  bake_light(scene);
  ASSERT_EQ(scene.light.size(), scene.positions_m.size());
  for (std::size_t v = 0; v < scene.light.size(); ++v) {
    const float distance = (scene.positions_m[v] - Vector3f(0, 0, 1.5F)).norm();
    const float expected = 2.0F * (1.5F / distance) / (distance * distance) / kPi;
    // Tolerance: 2 % for averages over cells of 10 cm at a distance of 1.5 m and for a lamp of 5
    // cm; more at the border, where samples are up to half a cell to one side of the vertex.
    const bool border = scene.positions_m[v].head<2>().cwiseAbs().maxCoeff() > 1.95F;
    ASSERT_NEAR(scene.light[v].x(), expected, (border ? 0.06F : 0.02F) * expected);
    ASSERT_NEAR(scene.light[v].y(), 0.5F * scene.light[v].x(), 1e-6);
    ASSERT_NEAR(scene.light[v].z(), 0.25F * scene.light[v].x(), 1e-6);
  }
}

TEST(BakeLight, SunLightsWithTheCosineAndTablesCastShadows) {
  Scene scene = floor_scene();
  const std::size_t floor_vertices = scene.positions_m.size();
  add_quad(scene, {-0.5F, -0.5F, 1}, {1, 0, 0}, {0, 1, 0}, 7, 2, 0, 10);
  Light sun;
  sun.kind = Light::Kind::kSun;
  sun.direction = Vector3f(1, 0, -1).normalized();
  sun.color = {3, 3, 3};
  scene.lights.push_back(sun);
  bake_light(scene, {.bounces = 0});
  const float lit = 3.0F * std::sqrt(0.5F) / kPi;
  int shadowed = 0;
  for (std::size_t v = 0; v < floor_vertices; ++v) {
    // The shadow of a square over [-0.5, 0.5] at height 1 under a sun at 45 deg is at [0.5, 1.5] on
    // the floor.
    const float outside =
        std::max(std::abs(scene.positions_m[v].x() - 1.0F), std::abs(scene.positions_m[v].y())) -
        0.5F;
    const float light = scene.light[v].x();
    if (outside > 0.11F) {
      ASSERT_NEAR(light, lit, 1e-3F * lit);
    } else if (outside < -0.11F) {
      ++shadowed;
      ASSERT_EQ(light, 0.0F);
    } else {  // the edge is a ramp one cell wide
      ASSERT_GE(light, 0.0F);
      ASSERT_LE(light, 1.001F * lit);
    }
  }
  EXPECT_EQ(shadowed, 49);  // 7 x 7 vertices are at least 11 cm inside a square of 1 m
}

TEST(BakeLight, OpenSkyGivesItsRadiance) {
  Scene scene = floor_scene();
  scene.lights.push_back({.kind = Light::Kind::kSky, .color = {0.5F, 0.6F, 0.7F}});
  bake_light(scene);
  for (const Vector3f& light : scene.light)
    ASSERT_LT((light - Vector3f(0.5F, 0.6F, 0.7F)).norm(), 1e-5F);
}

TEST(BakeLight, ClosedBoxOfConstantGlowIsTheGeometricSeries) {
  // Inside a closed surface of albedo a that emits radiance e everywhere, each bounce adds a factor
  // a: after n bounces light = e (1 + a + ... + a^n) at every point.
  Scene scene = plain_scene({188, 188, 188});
  scene.materials[0].emission = {0.5F, 0.25F, 1.0F};
  add_box(scene, {0, 0, 0}, {3, 2, 2.5F}, true, 1, 1, 0, 8);
  const float albedo = srgb_to_linear(std::uint8_t{188});
  for (const int bounces : {0, 1, 4}) {
    bake_light(scene, {.bounces = bounces});
    float series = 0.0F;
    for (int k = 0; k <= bounces; ++k) series += std::pow(albedo, static_cast<float>(k));
    for (const Vector3f& light : scene.light)
      ASSERT_LT((light - series * scene.materials[0].emission).norm(), 1e-3F * series);
  }
}

TEST(BakeLight, AmbientLightReachesEverySurfaceAlike) {
  Scene scene = floor_scene();
  add_quad(scene, {-2, -2, 0.01F}, {4, 0, 0}, {0, 4, 0}, 2, 1, 0, 40);  // it lies on the floor
  scene.lights.push_back(sphere_lamp({0, 0, 1.5F}, 2.0F));
  Scene with = scene;
  with.lights.push_back({.kind = Light::Kind::kAmbient, .color = {0.5F, 0.25F, 0.125F}});
  bake_light(scene);
  bake_light(with);
  for (std::size_t v = 0; v < scene.light.size(); ++v)
    ASSERT_EQ(with.light[v], scene.light[v] + Vector3f(0.5F, 0.25F, 0.125F));
}

TEST(BakeLight, ColorOfATextureBleedsByItsMean) {
  Scene scene = plain_scene();
  Grid2d<Rgb8> half_red(2, 1);
  half_red(0, 0) = {255, 0, 0};
  scene.materials[0].texture = half_red;
  scene.materials[0].emission = {1, 1, 1};
  add_box(scene, {0, 0, 0}, {2, 2, 2}, true, 1, 1, 0, 4);
  bake_light(scene, {.bounces = 1});
  for (const Vector3f& light : scene.light)
    ASSERT_LT((light - Vector3f(1.5F, 1.0F, 1.0F)).norm(),
              1e-3F);  // half of the light meets red: 1 + 0.5
}

TEST(BakeLight, RoomsAreDarkWithoutLightEvenUnderABrightSky) {
  Scene scene = plain_scene();
  add_box(scene, {0, 0, 0}, {3, 3, 2.5F}, true, 1, 1, 0,
          10);  // single sheets: the sky is right behind them
  scene.lights.push_back({.kind = Light::Kind::kSky, .color = {9, 9, 9}});
  scene.lights.push_back(sphere_lamp({1.5F, 1.5F, 2.0F}, 1.0F));
  bake_light(scene);
  // The room is lit only by the lamp, so values are far below the sky's radiance.
  for (const Vector3f& light : scene.light) {
    ASSERT_GT(light.x(), 0.01F);
    ASSERT_LT(light.x(), 3.0F);
    ASSERT_LT(light.z(), 0.3F * light.x());  // the lamp's color, not the sky's
  }
}

TEST(BakeLight, BoxTurnedInsideOutIsLitLikeAProperOne) {
  const auto brightness_of_box = [](bool inwards) {
    Scene scene = floor_scene();
    const std::size_t first = scene.positions_m.size();
    add_box(scene, {-0.3F, -0.3F, 0.2F}, {0.3F, 0.3F, 0.8F}, inwards, 3, 2, 0, 6);
    scene.lights.push_back(sphere_lamp({0.5F, 0.7F, 2.0F}, 2.0F));
    bake_light(scene);
    double sum = 0.0;
    for (std::size_t v = first; v < scene.light.size(); ++v) sum += scene.light[v].x();
    return sum / static_cast<double>(scene.light.size() - first);
  };
  const double proper = brightness_of_box(false);
  EXPECT_GT(proper, 0.05);
  EXPECT_NEAR(brightness_of_box(true), proper, 0.1 * proper);
}

TEST(BakeLight, FloorInsideAStandingBoxTakesTheLightAroundIt) {
  Scene scene = floor_scene();
  const std::size_t floor_vertices = scene.positions_m.size();
  add_box(scene, {-0.33F, -0.33F, 0}, {0.33F, 0.33F, 0.1F}, false, 3, 2, 0, 4);
  scene.lights.push_back({.kind = Light::Kind::kSky, .color = {1, 1, 1}});
  bake_light(scene);
  for (std::size_t v = 0; v < floor_vertices; ++v) ASSERT_GT(scene.light[v].x(), 0.4F);
}

TEST(BakeLight, ThreadsChangeNoBitAndSeedsDo) {
  const auto baked = [](int threads, std::uint64_t seed) {
    Scene scene = floor_scene();
    add_box(scene, {0, 0, 0.3F}, {0.5F, 0.5F, 0.6F}, false, 3, 2, 0, 5);
    scene.lights.push_back({.kind = Light::Kind::kSky, .color = {1, 1, 1}});
    scene.lights.push_back(sphere_lamp({0.5F, 0.7F, 2.0F}, 2.0F));
    bake_light(scene, {.seed = seed, .threads = threads});
    return scene.light;
  };
  const auto one = baked(1, 3);
  EXPECT_EQ(one, baked(2, 3));
  EXPECT_NE(one, baked(1, 4));
}

TEST(BakeConfig, DigestTellsWhatChangesTheLightAndNothingElse) {
  const std::uint64_t usual = digest(BakeConfig{});
  EXPECT_EQ(digest({.threads = 7}), usual);
  EXPECT_NE(digest({.samples = 64}), usual);
  EXPECT_NE(digest({.bounces = 3}), usual);
  EXPECT_NE(digest({.sun_samples = 32}), usual);
  EXPECT_NE(digest({.smoothing = 0}), usual);
  EXPECT_NE(digest({.seed = 1}), usual);
  EXPECT_NE(digest({.portable = true}), usual);
}

TEST(SuggestExposure, BringsWhatIsSeenToTheStatedRadiance) {
  Scene scene = plain_scene({188, 188, 188});
  add_box(scene, {0, 0, 0}, {4, 3, 2.5F}, true, 1, 1);
  scene.light.assign(scene.positions_m.size(), Vector3f::Constant(0.1F));
  const float albedo = srgb_to_linear(std::uint8_t{188});
  EXPECT_NEAR(suggest_exposure(scene) * 0.1F * albedo, 0.2F, 1e-5);
  // Surfaces that cannot be seen from the rooms do not count: a large bright floor outside.
  scene.rooms.push_back({"room", {{0, 0}, {4, 0}, {4, 3}, {0, 3}}});
  add_quad(scene, {5, 0, 0}, {9, 0, 0}, {0, 9, 0}, 2, 1, 0, 4);
  scene.light.resize(scene.positions_m.size(), Vector3f::Constant(7.0F));
  EXPECT_NEAR(suggest_exposure(scene) * 0.1F * albedo, 0.2F, 1e-5);
  EXPECT_NEAR(suggest_exposure(scene, 0.1F), 0.5F * suggest_exposure(scene), 1e-5);
  EXPECT_EQ(suggest_exposure(Scene{}), 1.0F);
}

}  // namespace
}  // namespace mh
